//! Noise estimation from image lines by a difference mask (Immerkær 1996).

/// Noise level of the lines, which selects how much they are smoothed before matching
/// ([`Config::noise`](crate::matching::Config::noise)).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Noise {
    /// Little noise: pixels are compared as they are.
    #[default]
    None,
    /// Standard deviation of about 2 grey levels: lines are smoothed by [`smooth()`](super::smooth()).
    Low,
    /// Standard deviation from about 3 grey levels on: lines are smoothed, and gradients count half as much
    /// as with [`Noise::Low`].
    High,
}

impl Noise {
    /// All levels, from the least noise to the most.
    pub const ALL: [Self; 3] = [Self::None, Self::Low, Self::High];

    /// Returns the name that the programs use.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Low => "low",
            Self::High => "high",
        }
    }
}

/// Estimator of a frame's noise from the lines of one camera or both.
///
/// The mask `(1, -4, 6, -4, 1)` along the line removes constants, slopes and curvature, as Immerkær's `(1,
/// -2, 1)` along and across does ("Fast noise variance estimation", 1996). It leaves noise where the picture
/// is smooth, and texture elsewhere. Sums `S = sum |mask|` over 16 columns are counted, and the noise is
/// taken from the 1/128 quantile of these sums: `sigma = S / 45.5` for Gaussian noise, measured on a slope.
/// Columns near a pixel of 0 or 255 are left out, as noise is clipped there. Without any smooth area the
/// estimate is too large: at most 2.8 grey levels on 15 real pairs without added noise, under 1.9 on all but
/// one of them; with 2 grey levels added at least 2.2 (printed by `tests/real/dense.rs` of the host package).
///
/// The time per line is constant; a meter takes 256 bytes and a word.
///
/// ```
/// use stereopsis::imaging::{Noise, NoiseMeter};
/// let mut meter = NoiseMeter::new();
/// assert_eq!(meter.sigma_16ths(), None);
/// meter.line(&[100; 64]);
/// assert!(meter.sigma_16ths().is_some_and(|sigma| sigma < 4));
/// assert_eq!(meter.level(), Noise::None);
/// ```
#[derive(Clone, Debug)]
// As the interface for C has it.
#[repr(C)]
pub struct NoiseMeter {
    /// Histogram of the sums in bins of `BIN`; the last bin counts all beyond it.
    counts: [u32; 64],
    sums: u32,
}

/// Number of columns in a sum.
const RUN: usize = 16;
/// Number of columns that a sum reads.
const AROUND: usize = RUN + 4;
/// Width of a bin.
const BIN: u32 = 16;
/// Reciprocal of the quantile that is taken for noise.
const QUIETEST: u32 = 128;
/// Twice the sum of noise with a standard deviation of one grey level at that quantile.
const TWICE_PER_GREY: u32 = 91;

impl NoiseMeter {
    /// Least standard deviation of [`Noise::Low`], 16ths of a grey level: most textures are taken for less.
    pub const LOW_16THS: u16 = 30;
    /// Least standard deviation of [`Noise::High`], 16ths of a grey level.
    pub const HIGH_16THS: u16 = 48;
    /// Largest ratio of the lower quartile to the noise at which the estimate counts as noise. With noise of
    /// 2 grey levels the ratio is up to 2.6 on 15 real pairs, and 2.9 on all but one of them when downsampled
    /// to 96 to 320 columns; without noise it is 3.1 to 4.5 on all but one of those that look noisy at 160
    /// columns.
    pub const TEXTURE: u16 = 3;

    /// Creates a meter without lines.
    pub const fn new() -> Self {
        Self { counts: [0; 64], sums: 0 }
    }

    /// Forgets all lines.
    pub fn clear(&mut self) {
        *self = Self::new();
    }

    /// Takes a line of 8-bit grey, in whole runs of 16 columns with two on either side.
    pub fn line(&mut self, line: &[u8]) {
        for run in 0..line.len().saturating_sub(AROUND - RUN) / RUN {
            let Some(pixels) = line.get(run * RUN..).and_then(|line| line.first_chunk::<AROUND>()) else {
                return;
            };
            let mut sum = 0;
            let mut is_cut_off = false;
            for i in 0..RUN {
                let [a, b, c, d, e] = core::array::from_fn(|k| i32::from(pixels[i + k]));
                sum += (a + e - 4 * (b + d) + 6 * c).unsigned_abs();
            }
            for &pixel in pixels {
                is_cut_off |= pixel == 0 || pixel == u8::MAX;
            }
            let bin = ((sum / BIN) as usize).min(self.counts.len() - 1);
            if let Some(count) = self.counts.get_mut(bin).filter(|_| !is_cut_off) {
                *count = count.saturating_add(1);
                self.sums = self.sums.saturating_add(1);
            }
        }
    }

    /// Returns the standard deviation of the noise, 16ths of a grey level, up to 359; `None` before the first
    /// run of columns. More runs make it more precise: a frame of 96 x 64 pixels has 320.
    pub fn sigma_16ths(&self) -> Option<u16> {
        self.deviation(QUIETEST)
    }

    /// Returns the level for the next frame; [`Noise::None`] before the first run of columns, and where the
    /// lower quartile of the sums exceeds [`Self::TEXTURE`] times the noise, as in textured, downsampled
    /// pictures.
    pub fn level(&self) -> Noise {
        let (Some(sigma), Some(quarter)) = (self.sigma_16ths(), self.deviation(4)) else {
            return Noise::None;
        };
        match sigma {
            _ if quarter > Self::TEXTURE * sigma => Noise::None,
            Self::HIGH_16THS.. => Noise::High,
            Self::LOW_16THS.. => Noise::Low,
            _ => Noise::None,
        }
    }

    /// The `1 / share` quantile of the sums as a standard deviation, 16ths of a grey level.
    fn deviation(&self, share: u32) -> Option<u16> {
        let mut before = self.sums.checked_sub(1)? / share;
        for (bin, &count) in (0..).zip(&self.counts) {
            if before < count {
                // Within its range the sums are taken to lie evenly.
                let place = (u64::from(before) * 2 + 1) * u64::from(BIN) / u64::from(count);
                let twice_sum = 2 * bin * u64::from(BIN) + place;
                return Some((twice_sum * 16 / u64::from(TWICE_PER_GREY)) as u16);
            }
            before -= count;
        }
        None
    }
}

impl Default for NoiseMeter {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A meter with so many sums in some bins.
    fn of(bins: &[(usize, u32)]) -> NoiseMeter {
        let mut meter = NoiseMeter::new();
        for &(bin, count) in bins {
            meter.counts[bin] += count;
            meter.sums += count;
        }
        meter
    }

    #[test]
    fn a_quantile_lies_evenly_in_its_bin() {
        // Of four sums of 80 to 96 the first is taken for 82, the last one for 94: twice that, over 91.
        let meter = of(&[(5, 4)]);
        assert_eq!([4, 2, 1].map(|share| meter.deviation(share)), [164, 172, 188].map(|s| Some(s * 16 / 91)));
        // Of two sums of 80 to 96 and two of 112 to 128 the fourth is the second one there.
        let meter = of(&[(5, 2), (7, 2)]);
        assert_eq!([4, 2, 1].map(|share| meter.deviation(share)), [168, 184, 248].map(|s| Some(s * 16 / 91)));
        assert_eq!(of(&[(63, 9)]).sigma_16ths(), Some((2 * 63 * 16 + 1) * 16 / 91));
        // The 1/128 quantile: of 129 sums the second, of 128 the first.
        assert_eq!([128, 129].map(|n| of(&[(1, 1), (9, n - 1)]).sigma_16ths()), [Some(8), Some(50)]);
        assert_eq!(NoiseMeter::new().sigma_16ths(), None);
    }

    #[test]
    fn levels_begin_at_their_deviations() {
        // Below 30, from there on, below 48 and from there on.
        for (bins, sigma, level) in [
            (&[(5, 3)][..], 29, Noise::None),
            (&[(5, 1)], 30, Noise::Low),
            (&[(8, 16), (9, 900)], 47, Noise::Low),
            (&[(8, 16), (9, 1010)], 48, Noise::High),
        ] {
            let meter = of(bins);
            assert_eq!((meter.sigma_16ths(), meter.level()), (Some(sigma), level));
        }
        // Where the lower quartile is more than three times as large, it is texture.
        for (bins, quarter, level) in [
            (&[(5, 1), (15, 127)][..], 85, Noise::Low),
            (&[(5, 1), (10, 30), (16, 97)], 90, Noise::Low),
            (&[(5, 1), (16, 127)], 91, Noise::None),
        ] {
            let meter = of(bins);
            assert_eq!((meter.sigma_16ths(), meter.deviation(4)), (Some(30), Some(quarter)));
            assert_eq!(meter.level(), level, "{quarter}");
        }
        assert_eq!(NoiseMeter::new().level(), Noise::None);
        assert_eq!(Noise::ALL.map(Noise::name), ["none", "low", "high"]);
    }

    #[test]
    fn a_sum_is_of_sixteen_masked_columns() {
        // By turns 100 and 101: the mask gives 200 - 808 + 600 or 202 - 800 + 606, eight of either sign.
        let line: [u8; 52] = core::array::from_fn(|x| 100 + (x % 2) as u8);
        let count = |width: usize| {
            let mut meter = NoiseMeter::new();
            meter.line(&line[..width]);
            (meter.sums, meter.counts[8])
        };
        let widths = [0, 4, 19, 20, 35, 36, 51, 52].map(count);
        assert_eq!(widths, [0, 0, 0, 1, 1, 2, 2, 3].map(|runs| (runs, runs)));
        // A black or a white pixel takes the runs that it is read by.
        for (place, left) in [(0, 2), (15, 2), (16, 1), (19, 1), (20, 2), (32, 1), (36, 2), (51, 2)] {
            for grey in [0, 255] {
                let (mut meter, mut line) = (NoiseMeter::new(), line);
                line[place] = grey;
                meter.line(&line);
                assert_eq!((meter.sums, meter.counts[8]), (left, left), "{place}");
            }
        }
        // What is beyond the last bin counts in it.
        let mut meter = NoiseMeter::new();
        meter.line(&core::array::from_fn::<_, 20, _>(|x| if x % 2 == 0 { 1 } else { 254 }));
        assert_eq!((meter.sums, meter.counts[63]), (1, 1));
        meter.clear();
        assert_eq!((meter.sums, meter.counts), (0, [0; 64]));
    }
}
