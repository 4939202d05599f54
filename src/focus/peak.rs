//! The focus peak of a cell: a parabola fitted to the logarithms of its sharpness.

use super::logarithm::{FRACTION, OCTAVE, log2};

/// Frames that a broad peak is fitted to, and half of them; half of those of a narrow one.
pub(super) const FRAMES: usize = 11;
const WIDE: u32 = 5;
const NARROW: u32 = 3;
/// What a frame's brightness may shift a logarithm by, either way.
pub(super) const BIAS: u16 = 4 * OCTAVE;
/// Weights of the frames around a peak, for the choice of it.
const CHOICE: [(isize, u32); 5] = [(-2, 1), (-1, 2), (0, 3), (1, 2), (2, 1)];

/// Bends of the wide fit, below the first of which it counts alone and from the second on not at all: where
/// its frames lie around the peak, and where the stack ends within them and they see one flank more than the
/// other.
const BROAD: [[u32; 2]; 2] = [[40, 80], [15, 30]];

/// The state of a cell, 48 bytes: its last sharpnesses and its peak so far.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FocusCell {
    /// Logarithms of the sharpness of the last frames, that of frame n in place n mod 11.
    recent: [u16; FRAMES],
    /// The largest of them, for the picture that is sharp all over.
    largest: u16,
    /// Sharpness in the peak's frame.
    peak: u16,
    /// How strongly the parabola bends at the peak, per frame and frame.
    bend: u16,
    /// What share of the peak is that of the wide fit, in 1/256.
    wide: u16,
    /// The weighted sum by which the peak was chosen.
    choice: u32,
    /// Where the peak is, in 1/256 frame from 0.
    position: u32,
    /// Sum of all logarithms.
    sum: u32,
    /// Sum of the sizes of their second differences.
    rough: u32,
}

const _: () = assert!(size_of::<FocusCell>() == 48, "what the documentation says");

/// Where a cell is in focus, and how sure that is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FocusPeak {
    /// The frame, counted from 0, in 1/256.
    pub position_q8: u32,
    /// Standard deviation of a correct peak, in 1/256 frame.
    pub sigma_q8: u32,
    /// What noise has part in it, in 1/256 frame: what an average over neighbours makes smaller.
    pub noise_q8: u32,
    /// How far the peak stands out: `h / (h + 1)` in 1/255, where `h` is how many times its sharpness is
    /// twice the geometric mean of all frames'.
    pub confidence: u8,
}

impl FocusPeak {
    /// The frame from 0, with its fraction.
    pub fn position(&self) -> f32 {
        // Exact: 24 bits are 65 536 frames.
        self.position_q8 as f32 / 256.0
    }

    /// Returns the standard deviation in frames.
    pub fn sigma(&self) -> f32 {
        self.sigma_q8 as f32 / 256.0
    }
}

/// Why a cell is nowhere in focus.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum NoFocus {
    /// Fewer frames came than a peak has sides and a top.
    TooFewFrames {
        /// How many would have been enough.
        needed: u32,
    },
    /// The sharpness changes no more than noise does.
    Untextured,
    /// The peak is so broad that noise moves it by more than a frame and more than a 21st of all frames.
    Broad,
}

error_text!(NoFocus {
    Self::TooFewFrames { needed } => "at least {needed} frames are needed",
    Self::Untextured => "the sharpness changes no more than noise does",
    Self::Broad => "the peak is so broad that noise hides where it is",
});

impl FocusCell {
    /// Before the first frame.
    pub const EMPTY: Self = Self {
        recent: [0; FRAMES],
        largest: 0,
        peak: 0,
        bend: 0,
        wide: 0,
        choice: 0,
        position: 0,
        sum: 0,
        rough: 0,
    };
    /// Frames that a peak needs.
    pub const FEWEST_FRAMES: u32 = 3;

    /// Takes the sharpness in `frame` and, first, completes the frame before: `shift` is what its brightness
    /// adds to logarithms. True if no frame before was as sharp, with its own brightness taken to be that
    /// of the frame before.
    #[inline]
    pub(super) fn push(&mut self, frame: u32, sharpness: u32, shift: u16) -> bool {
        if frame == 0 {
            *self = Self::EMPTY;
        }
        self.complete(frame, shift);
        let log = log2(sharpness);
        if let Some(place) = self.recent.get_mut(frame as usize % FRAMES) {
            *place = log;
        }
        let shifted = log.saturating_add(shift);
        let is_sharper = frame == 0 || shifted > self.largest;
        self.largest = if is_sharper { shifted } else { self.largest };
        is_sharper
    }

    /// Completes the last of `frames` frames and looks at the candidate that is then due.
    fn complete(&mut self, frames: u32, shift: u16) {
        let Some(last) = frames.checked_sub(1) else { return };
        let log = match self.recent.get_mut(last as usize % FRAMES) {
            Some(place) => {
                *place = place.saturating_add(shift);
                u32::from(*place)
            }
            None => return,
        };
        self.sum = self.sum.saturating_add(log);
        if last >= 2 {
            let bend = (log + self.at(last - 2)).abs_diff(2 * self.at(last - 1));
            self.rough = self.rough.saturating_add(bend);
        }
        match last {
            0..10 => {}
            10 => (0..=WIDE).for_each(|candidate| self.consider(candidate, frames)),
            _ => self.consider(last - WIDE, frames),
        }
    }

    /// After the last of all `frames` frames: the candidates that were still to see the frames after them.
    pub(super) fn finish(&mut self, frames: u32, shift: u16) {
        self.complete(frames, shift);
        let first = if frames < FRAMES as u32 { 0 } else { frames - WIDE };
        (first..frames).for_each(|candidate| self.consider(candidate, frames));
    }

    fn at(&self, frame: u32) -> u32 {
        self.recent.get(frame as usize % FRAMES).copied().unwrap_or(0).into()
    }

    /// Takes `candidate` as the peak if it and its neighbours are sharper than those of the peak so far.
    fn consider(&mut self, candidate: u32, frames: u32) {
        let last = frames.saturating_sub(1);
        let near = |by: isize| candidate.saturating_add_signed(by as i32).min(last);
        let choice = CHOICE.iter().fold(0, |sum, &(by, weight)| sum + weight * self.at(near(by)));
        if choice <= self.choice && candidate > 0 {
            return;
        }
        self.choice = choice;
        self.peak = self.at(candidate) as u16;
        let fit = |most: u32| {
            let half = (last / 2).min(most);
            let centre = candidate.min(last - half).max(half);
            (self.fit(centre, half), centre == candidate)
        };
        let ((narrow, narrow_bend), _) = fit(NARROW);
        let ((wide, wide_bend), is_inside) = fit(WIDE);
        let [few, many] = BROAD[usize::from(!is_inside)];
        let share =
            (many.saturating_sub(wide_bend.into()) * 256).checked_div(many - few).unwrap_or(0).min(256);
        let mix = |wide: u32, narrow: u32| {
            // A position has 24 bits, and both are within a window of each other.
            let apart = (wide as i32).wrapping_sub(narrow as i32);
            narrow.saturating_add_signed(apart.wrapping_mul(share as i32).wrapping_add(128) >> 8)
        };
        self.position = mix(wide, narrow);
        self.bend = mix(wide_bend.into(), narrow_bend.into()) as u16;
        self.wide = share as u16;
    }

    /// The top of the parabola through the logarithms of the frames around `centre`, by weighted least
    /// squares: with `half` of 3 the weights are 1, 2, 3, 3, 3, 2, 1, with 2 1, 2, 2, 2, 1. In 1/256
    /// frame, with its bend. A parabola that opens upwards has its top at the end that is higher.
    // Once in a program: in line, and unrolled for each width, it takes 16 KB of flash.
    #[inline(never)]
    fn fit(&self, centre: u32, half: u32) -> (u32, u16) {
        // The normal equations solved for the top: `num / den * y1 / (a y0 - b y2)`, and the bend as `(a y0 -
        // b y2) / c`, where yk is the sum of weight, distance^k and logarithm.
        let (weights, num, den, a, b, c): (&[i64], _, _, _, _, _) = match half {
            5 => (&[4, 4, 4, 3, 2, 1], 193, 26, 13, 2, 1544),
            4 => (&[4, 4, 3, 2, 1], 157, 10, 25, 6, 1570),
            3 => (&[3, 3, 2, 1], 47, 10, 8, 3, 188),
            2 => (&[2, 2, 1], 3, 2, 3, 2, 18),
            1 => (&[1, 1], 1, 2, 2, 3, 1),
            _ => return (centre << 8, 0),
        };
        let (mut y0, mut y1, mut y2) = (0, 0, 0);
        for (distance, &weight) in (0_u32..).zip(weights) {
            let [before, after] =
                [centre.saturating_sub(distance), centre + distance].map(|f| i64::from(self.at(f)));
            let (d, both) = (i64::from(distance), if distance == 0 { after } else { before + after });
            y0 += weight * both;
            y1 += weight * d * (after - before);
            y2 += weight * d * d * both;
        }
        // Without the mean of the logarithms, which changes nothing: with these weights `a y0 - b y2` of a
        // constant is 0 only for a and b of the normal equations, as here.
        let bend = a * y0 - b * y2;
        let most = i64::from(half) << 8;
        let off = if bend > 0 {
            (y1 * num * 512 + den * bend).checked_div_euclid(2 * den * bend).unwrap_or(0).clamp(-most, most)
        } else {
            y1.signum() * most
        };
        let position = (i64::from(centre) << 8) + off;
        (position.max(0) as u32, (bend / c).clamp(0, u16::MAX.into()) as u16)
    }

    /// The peak, after the last of `frames` frames.
    pub(super) fn peak(&self, frames: u32) -> Result<FocusPeak, NoFocus> {
        if frames < Self::FEWEST_FRAMES {
            return Err(NoFocus::TooFewFrames { needed: Self::FEWEST_FRAMES });
        }
        let height = u32::from(self.peak).saturating_sub(self.sum / frames);
        if height < Self::SURE && 4 * height < 7 * self.rough_mean(frames) || height < Self::LEAST {
            return Err(NoFocus::Untextured);
        }
        let confidence = (height * 255 / (height + u32::from(OCTAVE))) as u8;
        // Noise of deviation s changes the slope at the top by 0.21 s, with the wide fit by 0.11 s, and
        // second differences by 1.95 s in the mean of their sizes. What else is in a window, nearer
        // and farther, moves a peak by the more, the wider it is: by a twelfth of the distance at
        // which it has fallen by half an octave, on rendered slopes and waves.
        let (bend, wide) = (u32::from(self.bend).max(1), u32::from(self.wide));
        let noise =
            (self.rough_mean(frames) * (27 * (256 - wide) + 14 * wide)).checked_div(bend << 8).unwrap_or(0);
        if noise > (frames * 12).max(256) {
            return Err(NoFocus::Broad);
        }
        let width = ((u32::from(OCTAVE) << 16) / bend).isqrt();
        let most = frames << 8;
        Ok(FocusPeak {
            position_q8: self.position,
            sigma_q8: (noise + width / 12).min(most).max(16),
            noise_q8: noise.min(most),
            confidence,
        })
    }

    /// The mean size of second differences.
    fn rough_mean(&self, frames: u32) -> u32 {
        self.rough.checked_div(frames.saturating_sub(2)).unwrap_or(0)
    }

    /// A peak so high is no noise: twice the mean.
    const SURE: u32 = 1 << FRACTION;
    /// A peak so low is rounding: 4 percent over the mean.
    const LEAST: u32 = 116;
}
