//! What a pair's pictures tell of its cameras.

use super::histogram::Histogram;

/// What is wrong with a camera, by what its frame looks like.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CameraHealth {
    /// Nothing that can be told.
    Good,
    /// No light: 99 of 100 pixels are black. Dark, covered, or dead.
    Black,
    /// Too much light: half of the pixels are saturated.
    Saturated,
    /// All pixels counted are within 16 levels: no picture, as of a port that is stuck.
    Flat,
    /// Line after line is the same, to the last bit: the sensor's noise is missing. A line that hangs, or a
    /// test pattern.
    Repeating,
}

/// Watches the lines of two cameras, a frame at a time.
///
/// What is told here is no fault of single lines, and no row is flagged for it: a picture may be dark because
/// it is night. A frame whose cameras are not [`CameraHealth::Good`] has few answers or none, and those that
/// it has are as sure as others. Stuck columns and swapped cameras give wrong answers: [`Self::are_swapped`]
/// tells these, from the lines themselves.
///
/// To find swapped cameras, each 8th line is compared with the other camera's, moved left and moved right by
/// up to `most` columns: of a rectified pair the one that is moved the right way fits better. Votes are
/// counted over a frame. 240 bytes.
#[derive(Clone, Copy, Debug)]
pub struct PairMonitor {
    sides: [Side; 2],
    most_disparity: u16,
    row: usize,
    right_way: u32,
    wrong_way: u32,
}

#[derive(Clone, Copy, Debug)]
struct Side {
    histogram: Histogram,
    repeated: u32,
    lines: u32,
    /// A sum over the line above that tells whether the next is the same.
    before: u32,
}

impl Side {
    const NEW: Self = Self { histogram: Histogram::new(), repeated: 0, lines: 0, before: 0 };

    fn line(&mut self, row: usize, line: &[u8]) {
        self.histogram.line(row, line);
        // Fletcher's sum: the order of the pixels counts.
        let (a, b) = line.iter().fold((1_u32, 0_u32), |(a, b), &grey| {
            let a = a.wrapping_add(u32::from(grey));
            (a, b.wrapping_add(a))
        });
        let sum = a ^ b.rotate_left(16);
        self.repeated += u32::from(self.lines > 0 && sum == self.before);
        (self.before, self.lines) = (sum, self.lines.saturating_add(1));
    }

    fn health(&self) -> CameraHealth {
        let h = &self.histogram;
        let fullest = h.bins().iter().copied().max().unwrap_or(0);
        if h.black_per_mille() >= 990 {
            CameraHealth::Black
        } else if h.saturated_per_mille() >= 500 {
            CameraHealth::Saturated
        } else if h.count() > 0 && fullest == h.count() {
            CameraHealth::Flat
        } else if self.lines > 1 && self.repeated.saturating_mul(2) >= self.lines {
            CameraHealth::Repeating
        } else {
            CameraHealth::Good
        }
    }
}

impl PairMonitor {
    /// Fewer votes say nothing.
    const FEWEST_VOTES: u32 = 4;

    /// For disparities up to `most_disparity`. Trying them costs, for each pixel of a frame, `most_disparity
    /// / 4` differences.
    pub const fn new(most_disparity: u16) -> Self {
        Self { sides: [Side::NEW; 2], most_disparity, row: 0, right_way: 0, wrong_way: 0 }
    }

    /// Forgets the frame before.
    pub fn begin(&mut self) {
        *self = Self::new(self.most_disparity);
    }

    /// Takes the next line of both cameras.
    pub fn lines(&mut self, left: &[u8], right: &[u8]) {
        let row = self.row;
        for (side, line) in self.sides.iter_mut().zip([left, right]) {
            side.line(row, line);
        }
        self.row += 1;
        if row % 8 != 4 {
            return;
        }
        // A point at u in the left picture is at u - d in the right one.
        let (right_way, wrong_way) = (self.least(left, right), self.least(right, left));
        // Nearly equal fits say nothing: a line without texture, or a scene far away.
        if right_way.saturating_mul(5) < wrong_way.saturating_mul(4) {
            self.right_way += 1;
        } else if wrong_way.saturating_mul(5) < right_way.saturating_mul(4) {
            self.wrong_way += 1;
        }
    }

    /// The least mean of differences between `a` and `b` moved right, in 256ths, over disparities from 1 on.
    fn least(&self, a: &[u8], b: &[u8]) -> u32 {
        let tried = 1..=usize::from(self.most_disparity);
        let fit = |d: usize| {
            let pairs = a.iter().skip(d).zip(b);
            let (sum, count) = pairs.fold((0_u32, 0_u32), |(sum, count), (a, b)| {
                (sum.saturating_add(u32::from(a.abs_diff(*b))), count + 1)
            });
            // A few columns fit by chance.
            if count < 32 { u32::MAX } else { (u64::from(sum) * 256 / u64::from(count)) as u32 }
        };
        tried.map(fit).min().unwrap_or(u32::MAX)
    }

    /// What the two cameras' pictures tell, left and right.
    pub fn health(&self) -> [CameraHealth; 2] {
        self.sides.map(|side| side.health())
    }

    /// Whether the left camera's lines come as the right one's, and the other way round.
    pub fn are_swapped(&self) -> bool {
        self.wrong_way >= Self::FEWEST_VOTES && self.wrong_way > 3 * self.right_way
    }

    /// The histograms, left and right: of them the exposure is made ([`AutoExposure`](super::AutoExposure)).
    pub fn histograms(&self) -> [&Histogram; 2] {
        let [left, right] = &self.sides;
        [&left.histogram, &right.histogram]
    }

    /// How much brighter the right camera sees than the left one, in 256ths: 256 is equally. Of pictures that
    /// are not black or saturated it is the ratio of their gains; 256 where one is.
    pub fn gain_ratio_256ths(&self) -> u16 {
        let [left, right] = self.histograms().map(|h| u32::from(h.mean_16ths()));
        if self.health().iter().any(|health| matches!(health, CameraHealth::Black | CameraHealth::Saturated))
        {
            return 256;
        }
        (right * 256 + left / 2).checked_div(left).unwrap_or(256).min(u32::from(u16::MAX)) as u16
    }
}
