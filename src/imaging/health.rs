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
    /// All pixels are in one of the 16 bins of 16 levels, as from a stuck port.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A texture that does not repeat, of a seed.
    fn texture(seed: u32) -> [u8; 100] {
        let mut x = seed.wrapping_mul(2_654_435_761) | 1;
        core::array::from_fn(|_| {
            x ^= x << 13;
            x ^= x >> 17;
            x ^= x << 5;
            (x >> 24) as u8 / 2 + 40
        })
    }

    /// The health of a camera with such lines.
    fn health<const N: usize>(lines: impl IntoIterator<Item = [u8; N]>) -> CameraHealth {
        let mut monitor = PairMonitor::new(8);
        lines.into_iter().for_each(|line| monitor.lines(&line, &[]));
        monitor.health()[0]
    }

    /// The health by eight lines of 1000 pixels in all that count, so many of them of one grey level and the
    /// others of another.
    fn shares(one: u8, count: usize, other: u8) -> CameraHealth {
        // A row counts every eighth pixel from its own number on.
        let line = |row: usize| {
            core::array::from_fn::<_, 1000, _>(|x| {
                let counted = row * 125 + x / 8;
                // What is not counted makes lines different.
                if x % 8 != row {
                    (x * row) as u8
                } else if counted < count {
                    one
                } else {
                    other
                }
            })
        };
        health((0..8).map(line))
    }

    #[test]
    fn shares_of_pixels_tell_black_and_saturated() {
        assert_eq!([989, 990].map(|n| shares(2, n, 90)), [CameraHealth::Good, CameraHealth::Black]);
        assert_eq!(shares(3, 990, 90), CameraHealth::Good);
        assert_eq!([499, 500].map(|n| shares(253, n, 90)), [CameraHealth::Good, CameraHealth::Saturated]);
        assert_eq!(shares(252, 900, 90), CameraHealth::Good);
        assert_eq!([999, 1000].map(|n| shares(95, n, 96)), [CameraHealth::Good, CameraHealth::Flat]);
        assert_eq!(health::<8>([]), CameraHealth::Good, "nothing has been seen");
    }

    #[test]
    fn half_of_the_lines_like_the_one_above_are_repeating() {
        let lines = |seeds: &[u32]| health(seeds.iter().map(|&seed| texture(seed)));
        assert_eq!(lines(&[1, 1, 2, 2]), CameraHealth::Repeating);
        assert_eq!(lines(&[1, 1, 2, 2, 3]), CameraHealth::Good);
        assert_eq!(lines(&[1, 2, 1, 2, 1, 2]), CameraHealth::Good, "not the one above");
        assert_eq!([lines(&[1]), lines(&[1, 1])], [CameraHealth::Good, CameraHealth::Repeating]);
        // The first line is like none, also where it is empty.
        assert_eq!(health([[]; 1]), CameraHealth::Good);
    }

    #[test]
    fn lines_with_one_of_two_sums_alike_differ() {
        // The same pixels in another order have the same sum.
        let line = texture(1);
        let mut other = line;
        other.reverse();
        assert_eq!(health([line, other, line, other]), CameraHealth::Good);
        // Eight more in all, of columns that count 40, 30 and 70 times in the sum of sums, which is the same.
        let sums = |line: &[u8; 100]| {
            line.iter().fold((0_u32, 0_u32), |(a, b), &x| (a + u32::from(x), b + a + u32::from(x)))
        };
        other = line;
        (other[60], other[70], other[30]) = (line[60] + 8, line[70] + 8, line[30] - 8);
        // The bit by which the first sums differ is one that the second ones have.
        let [(a, b), (more, same)] = [sums(&line), sums(&other)];
        assert!(more == a + 8 && a & 8 == 0 && same == b && (b >> 16) & 8 == 8, "{a} {b}");
        assert_eq!(health([line, other, line, other]), CameraHealth::Good);
    }

    /// A monitor of lines of which every eighth is looked at: so many with a texture that the right camera
    /// sees farther left, then so many the other way round, and its brightness as a share.
    fn votes(right_way: usize, wrong_way: usize, (numerator, denominator): (u16, u16)) -> PairMonitor {
        let mut monitor = PairMonitor::new(12);
        for row in 0..8 * (right_way + wrong_way) {
            let texture = texture(row as u32 + 1);
            // Seven columns farther left.
            let near = |x: usize| texture.get(x + 7).copied().unwrap_or(90);
            let moved: [u8; 100] = core::array::from_fn(near);
            let (left, right) = if row < 8 * right_way { (texture, moved) } else { (moved, texture) };
            monitor.lines(&left, &right.map(|grey| (u16::from(grey) * numerator / denominator) as u8));
        }
        monitor
    }

    #[test]
    fn four_votes_three_times_as_many_as_the_others_say_that_cameras_are_swapped() {
        let swapped = |right_way, wrong_way| votes(right_way, wrong_way, (1, 1)).are_swapped();
        assert_eq!([swapped(0, 3), swapped(0, 4), swapped(4, 0)], [false, true, false]);
        assert_eq!([swapped(1, 4), swapped(2, 6), swapped(2, 7)], [true, false, true]);
        // How bright the cameras are does not matter.
        for share in [(1, 2), (1, 4), (3, 2)] {
            assert!(votes(1, 4, share).are_swapped() && !votes(4, 1, share).are_swapped(), "{share:?}");
        }
        // No row but each eighth is looked at.
        let monitor = votes(3, 2, (1, 1));
        assert_eq!((monitor.right_way, monitor.wrong_way, monitor.row), (3, 2, 40));
    }

    #[test]
    fn the_fit_of_two_lines_is_their_least_mean_difference() {
        let monitor = PairMonitor::new(12);
        let a: [u8; 60] = core::array::from_fn(|x| texture(3)[x]);
        let b: [u8; 60] = core::array::from_fn(|x| texture(3)[x + 5] - (x % 3) as u8);
        let fit = |d: usize, gains: [u32; 2]| {
            let differences =
                (d..60).map(|x| (u32::from(a[x]) * gains[0]).abs_diff(u32::from(b[x - d]) * gains[1]));
            differences.sum::<u32>() / (60 - d) as u32
        };
        for gains in [[256, 256], [256, 300], [1000, 256]] {
            let expected = (1..=12).map(|d| fit(d, gains)).min().expect("twelve");
            assert_eq!(monitor.least(&a, &b, gains), expected);
        }
        assert_eq!(monitor.least(&a, &b, [256, 256]), fit(5, [256, 256]));
        // With 33 columns one disparity leaves 32 that both have; fewer say nothing.
        let sum: u32 = (1..33).map(|x| 256 * u32::from(a[x].abs_diff(b[x - 1]))).sum();
        assert_eq!(monitor.least(&a[..33], &b, [256, 256]), sum / 32);
        assert_eq!(monitor.least(&a[..32], &b, [256, 256]), u32::MAX);
        assert_eq!(PairMonitor::new(0).least(&a, &b, [256, 256]), u32::MAX);
    }

    #[test]
    fn a_dark_line_is_made_sixteen_times_as_bright_at_most() {
        // The right camera sees a fortieth: with sixteen times of that no way fits.
        let monitor = votes(0, 4, (1, 40));
        assert_eq!((monitor.right_way, monitor.wrong_way), (0, 0));
        assert_eq!(votes(0, 4, (1, 12)).wrong_way, 4);
    }

    #[test]
    fn the_ratio_is_of_the_means() {
        let ratio = |left: u8, right: u8| {
            let mut monitor = PairMonitor::new(8);
            (0..8).for_each(|_| monitor.lines(&[left; 64], &[right; 64]));
            monitor.gain_ratio_256ths()
        };
        // Rounded: 256 * 125 / 100, 256 * 100 / 60 is 426.7, and 256 * 70 / 60 is 298.7.
        assert_eq!([ratio(100, 125), ratio(60, 100), ratio(60, 70)], [320, 427, 299]);
        assert_eq!([ratio(60, 50), ratio(100, 100)], [213, 256]);
        // Black and saturated pictures say nothing.
        assert_eq!([ratio(1, 100), ratio(100, 2), ratio(254, 100), ratio(100, 253)], [256; 4]);
    }
}
