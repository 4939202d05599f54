//! Camera health: black, saturated, flat or repeating pictures, swapped cameras, unequal gain.

use super::histogram::Histogram;

/// Condition of a camera, judged by its frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum CameraHealth {
    /// No fault shows.
    Good,
    /// At least 99 % of the pixels are black: dark, covered or dead.
    Black,
    /// At least half of the pixels are saturated.
    Saturated,
    /// All pixels are within 16 levels, as from a stuck port.
    Flat,
    /// At least half of the lines equal the one above bit for bit: a hanging line or a test pattern.
    Repeating,
}

/// Monitor of two cameras' health, frame by frame, in 240 bytes.
///
/// No row is flagged by it: a picture may be dark because it is night, and then has few answers. Swapped
/// cameras give wrong answers. To detect them, every 8th line is compared with the other camera's, shifted
/// left and shifted right by up to `most_disparity` columns: in a rectified pair the right direction fits
/// better. The votes of a frame are counted.
#[derive(Clone, Copy, Debug)]
pub struct PairMonitor {
    sides: [Side; 2],
    most_disparity: u16,
    row: usize,
    right_way: u32,
    wrong_way: u32,
}

/// Largest gain by which lines are made equally bright, in 256ths.
const MOST_GAIN: u64 = 16 * 256;

#[derive(Clone, Copy, Debug)]
struct Side {
    histogram: Histogram,
    repeated: u32,
    lines: u32,
    /// Checksum of the line above.
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
    /// Least number of votes for a decision.
    const FEWEST_VOTES: u32 = 4;

    /// Creates a monitor that tries disparities up to `most_disparity`, at `most_disparity / 4` differences
    /// per pixel of a frame.
    pub const fn new(most_disparity: u16) -> Self {
        Self { sides: [Side::NEW; 2], most_disparity, row: 0, right_way: 0, wrong_way: 0 }
    }

    /// Begins a frame.
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
        // The two cameras expose on their own: the right line counts as if it were as bright as the left one.
        let sum = |line: &[u8]| line.iter().map(|&grey| u32::from(grey)).sum::<u32>();
        let gain = u64::from(sum(left)) * 256;
        let gain = gain.checked_div(sum(right).into()).unwrap_or(256).min(MOST_GAIN) as u32;
        let right_way = self.least(left, right, [256, gain]);
        let wrong_way = self.least(right, left, [gain, 256]);
        // Nearly equal fits say nothing: a line without texture, or a scene far away.
        if right_way.saturating_mul(5) < wrong_way.saturating_mul(4) {
            self.right_way += 1;
        } else if wrong_way.saturating_mul(5) < right_way.saturating_mul(4) {
            self.wrong_way += 1;
        }
    }

    /// Least mean absolute difference of `a` and `b` shifted right, each times its gain in 256ths, over
    /// disparities from 1 on; in 256ths.
    fn least(&self, a: &[u8], b: &[u8], gains: [u32; 2]) -> u32 {
        let tried = 1..=usize::from(self.most_disparity);
        let fit = |d: usize| {
            let pairs = a.iter().skip(d).zip(b);
            let (sum, count) = pairs.fold((0_u32, 0_u32), |(sum, count), (a, b)| {
                let [a, b] = [u32::from(*a) * gains[0], u32::from(*b) * gains[1]];
                (sum.saturating_add(a.abs_diff(b)), count + 1)
            });
            // A few columns fit by chance.
            if count < 32 { u32::MAX } else { sum / count }
        };
        tried.map(fit).min().unwrap_or(u32::MAX)
    }

    /// Returns the health of the left and the right camera.
    pub fn health(&self) -> [CameraHealth; 2] {
        self.sides.map(|side| side.health())
    }

    /// Returns whether the two cameras are swapped.
    pub fn are_swapped(&self) -> bool {
        self.wrong_way >= Self::FEWEST_VOTES && self.wrong_way > 3 * self.right_way
    }

    /// Returns the histograms, left and right, for [`AutoExposure`](super::AutoExposure).
    pub fn histograms(&self) -> [&Histogram; 2] {
        let [left, right] = &self.sides;
        [&left.histogram, &right.histogram]
    }

    /// Returns the ratio of mean brightness, right to left, in 256ths; 256 where a picture is black or
    /// saturated.
    pub fn gain_ratio_256ths(&self) -> u16 {
        let [left, right] = self.histograms().map(|h| u32::from(h.mean_16ths()));
        if self.health().iter().any(|health| matches!(health, CameraHealth::Black | CameraHealth::Saturated))
        {
            return 256;
        }
        (right * 256 + left / 2).checked_div(left).unwrap_or(256).min(u32::from(u16::MAX)) as u16
    }
}
