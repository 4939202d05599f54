//! Photometric balance: the right camera's grey levels mapped to the left one's by gain and offset.

use super::histogram::Histogram;
use crate::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource};

/// Map from the right camera's grey levels to the left one's: `grey <- (gain grey + offset) / 256`, rounded
/// and clamped to 0..=255.
///
/// Semi-global matching compares brightness and gradients, which differ with exposure. Both cameras see about
/// the same scene, so that corresponding 16-quantiles of their histograms correspond, where both are 8 to
/// 248. The gain is the ratio of their mean deviations, 1/2 to 2, and the offset matches their means. Where
/// the quantiles differ by less than [`Balance::LEAST`] in the mean (12 at most on 15 real pairs as taken),
/// nothing is balanced. A saturated pixel becomes as dark as the gain makes it: 128 at a gain of a half. Its
/// saturation no longer shows, and has to be looked for before.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Balance {
    /// Gain in 256ths.
    pub gain_256ths: u16,
    /// Offset in 256ths of a grey level.
    pub offset_256ths: i32,
}

/// Steps of a level: 16ths of a grey level.
const GREY: u32 = 16;
/// The width of a histogram's bin.
const BIN: u32 = 16 * GREY;
/// Levels that are far enough from black and white.
const INSIDE: core::ops::RangeInclusive<u32> = 8 * GREY..=248 * GREY;

impl Balance {
    /// The identity, for cameras with equal exposure.
    pub const NONE: Self = Self { gain_256ths: 256, offset_256ths: 0 };

    /// Least mean difference that is balanced, grey levels.
    pub const LEAST: u8 = 16;

    /// Estimates the balance from the histograms of a frame.
    pub fn between(left: &Histogram, right: &Histogram) -> Self {
        // How many levels count, their sums, and how far they are apart.
        let (mut count, mut sums, mut apart) = (0, [0; 2], 0);
        for [left, right] in inside(left, right) {
            count += 1;
            sums = [sums[0] + left, sums[1] + right];
            apart += left.abs_diff(right);
        }
        if count < 3 || apart < count * u32::from(Self::LEAST) * GREY {
            return Self::NONE;
        }
        let mut spreads = [0; 2];
        for levels in inside(left, right) {
            for ((spread, level), sum) in spreads.iter_mut().zip(levels).zip(sums) {
                *spread += (count * level).abs_diff(sum);
            }
        }
        // With hardly any contrast their ratio would say nothing.
        let has_contrast = spreads.iter().all(|spread| *spread >= 3 * GREY * count * count);
        let gain = (256 * spreads[0] + spreads[1] / 2).checked_div(spreads[1]).filter(|_| has_contrast);
        let gain = gain.map_or(256, |gain| gain.clamp(128, 512));
        let difference = 256 * sums[0] as i32 - gain as i32 * sums[1] as i32;
        // Not 0; said so because a division by what might be 0 brings a panic.
        let offset = difference.checked_div_euclid((GREY * count) as i32).unwrap_or(0);
        Self { gain_256ths: gain as u16, offset_256ths: offset }
    }

    /// Balances a line of the right camera.
    pub fn line(self, line: &mut [u8]) {
        if self == Self::NONE {
            return;
        }
        let (gain, offset) = (i32::from(self.gain_256ths), self.offset_256ths.saturating_add(128));
        for grey in line {
            *grey = ((gain * i32::from(*grey)).saturating_add(offset) >> 8).clamp(0, 255) as u8;
        }
    }
}

/// Corresponding quantiles of both cameras within [`INSIDE`], 16ths of a grey level.
fn inside(left: &Histogram, right: &Histogram) -> impl Iterator<Item = [u32; 2]> {
    let levels = (1..16).map(|k| [level(left, k), level(right, k)]);
    levels.filter(|levels| levels.iter().all(|level| INSIDE.contains(level)))
}

/// The `k`-th 16-quantile, interpolated within its bin; 0 without pixels.
fn level(histogram: &Histogram, k: u32) -> u32 {
    let mut wanted = u64::from(histogram.count()) * u64::from(k);
    for (bin, &count) in (0..).zip(histogram.bins()) {
        let count = 16 * u64::from(count);
        if wanted <= count {
            let within = (wanted * u64::from(BIN)).div_ceil(count.max(1));
            return bin * BIN + within as u32;
        }
        wanted -= count;
    }
    0
}

/// A stereo source whose right lines are [balanced](Balance) by the histograms of the frame before; the first
/// frame is unchanged. Only 8-bit grey lines are balanced.
///
/// ```
/// use stereopsis::imaging::BalancedPair;
/// // Beside the source.
/// assert!(size_of::<BalancedPair<()>>() <= 300);
/// ```
#[derive(Clone, Debug)]
pub struct BalancedPair<S> {
    source: S,
    histograms: [Histogram; 2],
    balance: Balance,
    lines: usize,
}

impl<S: StereoSource> BalancedPair<S> {
    /// Wraps a source.
    pub const fn new(source: S) -> Self {
        Self { source, histograms: [Histogram::new(); 2], balance: Balance::NONE, lines: 0 }
    }

    /// Returns the balance of the frame that was started last.
    pub const fn balance(&self) -> Balance {
        self.balance
    }

    /// Releases the source.
    pub fn release(self) -> S {
        self.source
    }
}

impl<S: StereoSource> ErrorType for BalancedPair<S> {
    type Error = S::Error;
}

impl<S: StereoSource> StereoSource for BalancedPair<S> {
    fn format(&self) -> LineFormat {
        self.source.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.source.max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<S::Error>> {
        let start = self.source.start_frame()?;
        if self.lines > 0 {
            let [left, right] = &mut self.histograms;
            self.balance = Balance::between(left, right);
            left.begin();
            right.begin();
            self.lines = 0;
        }
        Ok(start)
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        let start = self.source.next_lines(left, right)?;
        let format = self.source.format();
        let bytes = if format.pixel == PixelFormat::Grey8 { format.line_bytes() } else { 0 };
        let right = right.get_mut(..bytes).unwrap_or_default();
        let [of_left, of_right] = &mut self.histograms;
        of_left.line(self.lines, left.get(..bytes).unwrap_or_default());
        of_right.line(self.lines, right);
        self.balance.line(right);
        self.lines += 1;
        Ok(start)
    }

    fn mask(&self, row: u16, masks: [&mut [u8]; 2]) -> bool {
        self.source.mask(row, masks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_lie_evenly_in_a_bin() {
        let mut histogram = Histogram::new();
        // Two pixels of 0 to 15, and two of 32 to 47: half of them are under 16, and three quarters under 40.
        (0..8).for_each(|row| histogram.line(row, &[0, 0, 40, 40]));
        assert_eq!([4, 8, 12, 16].map(|k| level(&histogram, k)), [8, 16, 40, 48].map(|grey| grey * GREY));
    }

    #[test]
    fn a_ramp_with_half_the_light_is_doubled() {
        let (mut left, mut right) = (Histogram::new(), Histogram::new());
        let ramp: [u8; 256] = core::array::from_fn(|x| x as u8);
        (0..8).for_each(|row| left.line(row, &ramp));
        (0..8).for_each(|row| right.line(row, &ramp.map(|grey| grey / 2)));
        let balance = Balance::between(&left, &right);
        assert_eq!(balance, Balance { gain_256ths: 512, offset_256ths: 0 });
        let mut line = [0, 1, 100, 127, 128, 255];
        balance.line(&mut line);
        assert_eq!(line, [0, 2, 200, 254, 255, 255]);
        assert_eq!(Balance::between(&left, &left), Balance::NONE);
    }

    /// A histogram of so many pixels of each of some grey levels.
    fn of(levels: &[(u8, usize)]) -> Histogram {
        let mut histogram = Histogram::new();
        for &(grey, count) in levels {
            (0..count).for_each(|_| histogram.line(0, &[grey]));
        }
        histogram
    }

    /// Pixels spread evenly over bins from one on.
    fn bins(first: u8, count: u8) -> Histogram {
        let mut histogram = Histogram::new();
        (first..first + count).for_each(|bin| histogram.line(0, &[16 * bin]));
        histogram
    }

    #[test]
    fn a_difference_of_sixteen_levels_is_balanced() {
        // Alike but for a bin, which is 16 levels, or for half of one.
        let balance = Balance::between(&bins(4, 4), &bins(3, 4));
        assert_eq!(balance, Balance { gain_256ths: 256, offset_256ths: 16 * 256 });
        let balance = Balance::between(&bins(3, 4), &bins(4, 4));
        assert_eq!(balance, Balance { gain_256ths: 256, offset_256ths: -16 * 256 });
        assert_eq!(Balance::between(&bins(3, 5), &bins(3, 4)), Balance::NONE);
    }

    #[test]
    fn the_gain_is_that_of_the_spreads() {
        // Twelve bins beside six: twice the spread, from 32 to 224 and from 80 to 176.
        let (wide, narrow) = (bins(2, 12), bins(5, 6));
        let balance = Balance::between(&wide, &narrow);
        assert_eq!(balance.gain_256ths, 512);
        let near = |offset_256ths: i32, level: i32| (offset_256ths - 256 * level).abs() <= 256;
        assert!(near(balance.offset_256ths, 128 - 2 * 128), "{balance:?}");
        let balance = Balance::between(&narrow, &wide);
        assert_eq!(balance.gain_256ths, 128);
        assert!(near(balance.offset_256ths, 128 - 64), "{balance:?}");
        // 204.8 256ths are 205.
        assert_eq!(Balance::between(&bins(2, 4), &bins(3, 5)).gain_256ths, 205);
        // No more than twice, nor less than half.
        assert_eq!(Balance::between(&bins(2, 12), &bins(3, 4)).gain_256ths, 512);
        assert_eq!(Balance::between(&bins(3, 4), &bins(2, 12)).gain_256ths, 128);
    }

    #[test]
    fn with_hardly_any_contrast_the_means_count_alone() {
        // Within one bin quantiles are 3.7 levels from their mean: half the spread of two bins.
        assert_eq!(Balance::between(&bins(9, 2), &bins(5, 1)).gain_256ths, 512);
        // Those from 8 to 16 are 2 levels from theirs, which is less than 3.
        let (wide, dark) = (bins(2, 12), bins(0, 1));
        for (left, right) in [(&wide, &dark), (&dark, &wide)] {
            let balance = Balance::between(left, right);
            assert!(balance.gain_256ths == 256 && balance.offset_256ths.abs() > 256 * 100, "{balance:?}");
        }
    }

    #[test]
    fn levels_near_black_and_white_do_not_count() {
        let levels = |histogram: &Histogram| inside(histogram, histogram).count();
        // Quantiles are one level apart in a bin, and those from 8 to 248 are inside.
        assert_eq!([0, 100, 250].map(|grey| levels(&of(&[(grey, 16)]))), [8, 15, 8]);
        // Both cameras' have to be, and three are needed.
        let white = of(&[(250, 32)]);
        for (dark, count) in [(0, 1), (4, 2), (8, 3)] {
            let black = of(&[(0, 32 - dark), (20, dark)]);
            assert_eq!(inside(&black, &white).count(), count);
            assert_eq!(Balance::between(&black, &white) == Balance::NONE, count < 3, "{count}");
        }
        assert_eq!(Balance::between(&of(&[]), &white), Balance::NONE);
    }
}
