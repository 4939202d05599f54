//! The focus peak of a cell: a parabola fitted to the logarithms of its sharpness.

use super::logarithm::{FRACTION, OCTAVE, log2};
use core::ops::Range;

/// Frames that a cell keeps, the most that a peak is fitted to, and half of them.
pub(super) const FRAMES: usize = 11;
const WIDE: u32 = 5;
/// Noise that a fit may leave in the top of its parabola, 1/256 frame: a tenth of a frame.
const STEADY: u32 = 26;
/// Deviation of the slope at the top of the fits that reach 1, 2, 3, 4 and 5 frames to either side, in
/// 1/256 of the mean size of second differences, which is 1.95 deviations of a logarithm; and 2.5
/// deviations of the bend, in 1/16.
const FITS: [(u32, u32); WIDE as usize] = [(93, 50), (44, 11), (27, 5), (19, 3), (14, 2)];
/// Second differences to either side of a peak that are its own, and with how many frames others are enough.
const OWN: u32 = 2;
const ENOUGH: u32 = 10;
/// What a frame's brightness may shift a logarithm by, either way.
pub(super) const BIAS: u16 = 4 * OCTAVE;
/// Weights of the frames around a peak, for the choice of it.
const CHOICE: [(isize, u32); 5] = [(-2, 1), (-1, 2), (0, 3), (1, 2), (2, 1)];
/// Sum of the weights in [`CHOICE`].
const CHOICE_WEIGHT: u32 = 9;

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
    /// The deviation of the slope of the fit that gave the peak, of [`FITS`].
    slope: u16,
    /// Sum of the sizes of the second differences around the peak.
    near: u16,
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
    /// How far the peak stands out: `h / (h + 1)` in 1/255, where `h` is the base-2 logarithm of its
    /// sharpness over the geometric mean of all frames'.
    pub confidence: u8,
}

impl FocusPeak {
    /// The frame from 0, with its fraction.
    pub fn position(&self) -> f32 {
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
        slope: 0,
        near: 0,
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
            10 => self.consider(0..WIDE + 1, frames),
            _ => self.consider(last - WIDE..last - WIDE + 1, frames),
        }
    }

    /// After the last of all `frames` frames: the candidates that were still to see the frames after them.
    pub(super) fn finish(&mut self, frames: u32, shift: u16) {
        self.complete(frames, shift);
        let first = if frames < FRAMES as u32 { 0 } else { frames - WIDE };
        self.consider(first..frames, frames);
    }

    fn at(&self, frame: u32) -> u32 {
        self.recent.get(frame as usize % FRAMES).copied().unwrap_or(0).into()
    }

    /// Takes the best of `candidates` as the peak if it and its neighbours are sharper than those of the
    /// peak so far.
    fn consider(&mut self, candidates: Range<u32>, frames: u32) {
        let last = frames.saturating_sub(1);
        let mut chosen = None;
        for candidate in candidates {
            let near = |by: isize| candidate.saturating_add_signed(by as i32).min(last);
            let choice = CHOICE.iter().fold(0, |sum, &(by, weight)| sum + weight * self.at(near(by)));
            if choice > self.choice || candidate == 0 {
                self.choice = choice;
                chosen = Some(candidate);
            }
        }
        if let Some(candidate) = chosen {
            self.locate(candidate, frames);
        }
    }

    /// Fits a parabola to the fewest frames around `candidate` from which noise leaves its top within
    /// [`STEADY`], or to those that leave it the least noise: a sharp peak is no parabola for long, and a
    /// fit of many frames is drawn to the side on which it falls more slowly. The bend counts less 2.5
    /// deviations, for a candidate was chosen as a maximum; without one that is surely more, the widest fit
    /// counts.
    fn locate(&mut self, candidate: u32, frames: u32) {
        let last = frames.saturating_sub(1);
        self.peak = self.at(candidate) as u16;
        let own = candidate.saturating_sub(OWN).max(1)..last.min(candidate + OWN + 1);
        let bends = own.map(|frame| (self.at(frame - 1) + self.at(frame + 1)).abs_diff(2 * self.at(frame)));
        self.near = bends.sum::<u32>().min(u16::MAX.into()) as u16;
        let rough = self.rough_mean(frames);
        let mut least = u32::MAX;
        for (half, &(slope, unsure)) in (1..).zip(&FITS).take(last as usize / 2) {
            let (position, bend) = self.fit(candidate.min(last - half).max(half), half);
            let sure = u32::from(bend).saturating_sub(rough * unsure / 16);
            let noise = (rough * slope).checked_div(sure).unwrap_or(u32::MAX);
            if noise <= least {
                least = noise;
                (self.position, self.bend, self.slope) = (position, bend, slope as u16);
            }
            if noise < STEADY {
                break;
            }
        }
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
        let mean = self.sum / frames;
        let height = u32::from(self.peak).saturating_sub(mean);
        // Of the five frames by which it was chosen: with noise alone in all frames their mean has half a
        // deviation, and what is asked is 3.2.
        let above = (self.choice / CHOICE_WEIGHT).saturating_sub(mean);
        let is_noise = 8 * above < 13 * self.rough_mean(frames);
        if height < Self::SURE && is_noise || height < Self::LEAST {
            return Err(NoFocus::Untextured);
        }
        let confidence = (height * 255 / (height + u32::from(OCTAVE))) as u8;
        // What else is in a window, nearer and farther, moves a peak by the more, the wider it is: by a
        // twelfth of the distance at which it has fallen by half an octave, on rendered slopes and waves.
        let bend = u32::from(self.bend).max(1);
        let noise = self.rough_mean(frames) * u32::from(self.slope) / bend;
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

    /// The mean size of second differences, without the peak's own where there are others.
    fn rough_mean(&self, frames: u32) -> u32 {
        let (sum, count) = match frames {
            ENOUGH.. => (self.rough.saturating_sub(self.near.into()), frames - 2 - (2 * OWN + 1)),
            _ => (self.rough, frames.saturating_sub(2)),
        };
        sum.checked_div(count).unwrap_or(0)
    }

    /// A peak so high is no noise: twice the mean.
    const SURE: u32 = 1 << FRACTION;
    /// A peak so low is rounding: 4 percent over the mean.
    const LEAST: u32 = 116;
}
