//! How noisy a sensor is: measured on the lines of a frame, said in levels for the next one.

/// How much noise the lines are taken to have, and so how much they are smoothed before they are compared
/// ([`Config::noise`](crate::matching::Config::noise)).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Noise {
    /// Little: pixels are compared as they are.
    #[default]
    None,
    /// A deviation of about 2 grey levels: lines are smoothed ([`smooth()`](super::smooth())).
    Low,
    /// A deviation from about 3 grey levels on: lines are smoothed, and gradients count half as much as with
    /// [`Noise::Low`].
    High,
}

impl Noise {
    /// All of them, from the least noise to the most.
    pub const ALL: [Self; 3] = [Self::None, Self::Low, Self::High];

    /// The name, as the programs spell it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Low => "low",
            Self::High => "high",
        }
    }
}

/// Estimates the noise of a frame from its lines, those of one camera or of both, as they come.
///
/// A mask that neither a constant, nor a slope, nor a bend gets through is laid over a line, `(1, -4, 6, -4,
/// 1)`, as Immerkær does with `(1, -2, 1)` along and across ("Fast noise variance estimation", 1996); along
/// the line alone it needs no other line. What it leaves is noise where the picture is smooth, and texture
/// elsewhere. So 16 columns at a time are summed up, `S = sum |mask|`, and the noise is that of the quietest
/// places: of the first 128th of all sums in ascending order, `sigma = S / 45.5` for Gaussian noise, measured
/// on a slope. Places with a pixel of 0 or 255 are left out: there noise is cut off. Where nothing is smooth,
/// it says too much: 2.8 grey levels at most on 15 real pairs without added noise, under 1.9 on all but one
/// of them; with 2 grey levels added 2.2 at least (`tests/real/dense.rs` of the host package prints them).
///
/// Each line costs the same whatever it shows; a meter takes 256 bytes and a word.
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
    /// How many sums there are from `BIN` times the index on; the last one counts all beyond it.
    counts: [u32; 64],
    sums: u32,
}

/// Columns whose masks are summed up.
const RUN: usize = 16;
/// Columns that they look at.
const AROUND: usize = RUN + 4;
/// The width of a counter's range.
const BIN: u32 = 16;
/// The share of the sums that is quieter than what is taken for noise: one in so many.
const QUIETEST: u32 = 128;
/// Twice the sum that a deviation of one grey level has there.
const TWICE_PER_GREY: u32 = 91;

impl NoiseMeter {
    /// From this deviation on noise is [`Noise::Low`], in 16ths of a grey level: most textures are taken for
    /// less.
    pub const LOW_16THS: u16 = 30;
    /// And from this on [`Noise::High`].
    pub const HIGH_16THS: u16 = 48;
    /// How many times as loud as the noise a quarter of a picture may be at least: with noise of 2 grey
    /// levels it is up to 2.6 on 15 real pairs, 2.9 where they are made 96 to 320 pixels wide but for
    /// one, and without 3.1 to 4.5 on those of them that seem noisy at 160 pixels but for one.
    pub const TEXTURE: u16 = 3;

    /// A meter that has seen no line.
    pub const fn new() -> Self {
        Self { counts: [0; 64], sums: 0 }
    }

    /// Forgets all lines.
    pub fn clear(&mut self) {
        *self = Self::new();
    }

    /// Takes a line of 8-bit grey: as many whole runs of 16 columns as it has, with the two beside them.
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

    /// The deviation of the noise in 16ths of a grey level, up to 359; `None` before the first run of
    /// columns. It is as sure as there are many of them: a frame of 96 x 64 pixels has 320.
    pub fn sigma_16ths(&self) -> Option<u16> {
        self.deviation(QUIETEST)
    }

    /// The level for the next frame; [`Noise::None`] before the first run of columns, and where noise matters
    /// little beside the picture: where less than a quarter of all places is within [`Self::TEXTURE`]
    /// times the noise. That is texture without a quiet place as a rule, as of pictures that were made
    /// small.
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

    /// The sum that one in `share` is less than, as a deviation in 16ths of a grey level.
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
