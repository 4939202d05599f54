//! The focus peak of a cell: a parabola through its logarithms, as wide as noise asks (Lepski 1991).

use super::logarithm::{FRACTION, OCTAVE, exp2, log2};

/// Frames that the widest fit takes, and half of them.
pub(super) const FRAMES: usize = 11;
const WIDE: u32 = 5;
/// The fits, the narrowest first: half of their frames; how far noise of deviation s moves the top of one of
/// bend b, `s / b` times so many 256ths of a frame; and what it moves a top by, 1/256 frame, below which no
/// wider one is asked.
const FITS: [(u32, u32, u32); 4] = [(1, 181, 8), (2, 85, 26), (3, 53, 26), (WIDE, 28, 0)];
/// What a frame's brightness may shift a logarithm by, either way.
pub(super) const BIAS: u16 = 4 * OCTAVE;
/// Weights of the frames around a peak, for the choice of it, and their sum.
const CHOICE: [(isize, u32); 5] = [(-2, 1), (-1, 2), (0, 3), (1, 2), (2, 1)];
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
    /// What noise moves a top by in the fit that was taken, as [`FITS`] have it.
    gain: u16,
    /// The weighted sum by which the peak was chosen.
    choice: u32,
    /// Where the peak is, in 1/256 frame from 0.
    position: u32,
    /// Sum of all logarithms.
    sum: u32,
    /// Sum of the logarithms of the sizes of their third differences.
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
    /// The peak is so broad that noise moves it by more than four frames and more than a fifth of all frames.
    Broad,
    /// Fewer than a third of the cells around it have an answer like it ([`plane_row`](super::plane_row)).
    Alone,
}

error_text!(NoFocus {
    Self::TooFewFrames { needed } => "at least {needed} frames are needed",
    Self::Untextured => "the sharpness changes no more than noise does",
    Self::Broad => "the peak is so broad that noise hides where it is",
    Self::Alone => "the cells around it do not agree",
});

impl FocusCell {
    /// Before the first frame.
    pub const EMPTY: Self = Self {
        recent: [0; FRAMES],
        largest: 0,
        peak: 0,
        bend: 0,
        gain: 0,
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
        if last >= 3 {
            let [a, b, c] = [3, 2, 1].map(|before| self.at(last - before));
            let size = (log + 3 * b).abs_diff(3 * c + a);
            self.rough = self.rough.saturating_add(log2(size).into());
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
        let noise_of_logs = self.noise_of_logs(frames);
        let mut before: Option<(u32, u32)> = None;
        for (most, gain, enough) in FITS {
            let half = (last / 2).min(most);
            // Three frames have to stand around the sharpest one; more of them say by their choice where.
            let near = candidate.saturating_sub(1)..=(candidate + 1).min(last);
            let sharpest = near.max_by_key(|&frame| self.at(frame)).unwrap_or(candidate);
            let middle = if half == 1 { sharpest } else { candidate };
            let (position, bend) = self.fit(middle.min(last - half).max(half), half);
            // What a narrow fit rules out is another surface, or a flank that is none of a parabola.
            if before.is_some_and(|(narrow, noise)| narrow.abs_diff(position) > 4 * noise) {
                break;
            }
            let noise = noise_of_logs * gain / u32::from(bend).max(1);
            (self.position, self.bend, self.gain) = (position.min(last << 8), bend, gain as u16);
            if noise < enough {
                break;
            }
            before = Some((position, noise));
        }
    }

    /// The deviation of a logarithm by noise, from third differences, whose deviation is 4.47 times that. A
    /// geometric mean: the few that a sharp peak or a second surface make large hardly count. It is less than
    /// the deviation by a factor of 1.89.
    fn noise_of_logs(&self, frames: u32) -> u32 {
        let factor = 2550; // log2(4.47 / 1.89)
        let mean = self.rough.checked_div(frames.saturating_sub(3));
        mean.map_or(Self::UNKNOWN, |mean| exp2(mean.saturating_sub(factor)))
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
        // Of nothing but noise the largest of many sums of five is 1.1 of its deviations over the mean.
        let smooth = (self.choice / CHOICE_WEIGHT).saturating_sub(self.sum / frames);
        let noise_of_logs = self.noise_of_logs(frames);
        if height < Self::SURE && 5 * smooth < 7 * noise_of_logs || height < Self::LEAST {
            return Err(NoFocus::Untextured);
        }
        let confidence = (height * 255 / (height + u32::from(OCTAVE))) as u8;
        // What else is in a window, nearer and farther, moves a peak by the more, the wider it is: by a
        // twelfth of the distance at which it has fallen by half an octave, on rendered slopes and waves.
        let bend = u32::from(self.bend).max(1);
        let noise = noise_of_logs * u32::from(self.gain) / bend;
        if noise > (frames * 48).max(1024) {
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

    /// The deviation of a logarithm that is taken where too few frames say it: a quarter of an octave.
    const UNKNOWN: u32 = OCTAVE as u32 / 4;
    /// A peak so high is no noise: twice the mean.
    const SURE: u32 = 1 << FRACTION;
    /// A peak so low is rounding: 4 percent over the mean.
    const LEAST: u32 = 116;
}
