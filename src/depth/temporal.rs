//! Disparities held steady over frames.

use crate::units::Disparity;

/// Where a filtered disparity comes from.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Provenance {
    /// There is none, neither now nor in the last frames.
    #[default]
    Nothing,
    /// This frame's own: the first one here, or far from what was there.
    New,
    /// This frame's and those of frames before, averaged.
    Averaged,
    /// This frame has none: it is of a frame before.
    Held,
}

/// How much a filter smooths, and how long it holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TemporalConfig {
    /// Answers that differ by at most this are of one surface, steps of 1/32 px.
    pub most_step: u16,
    /// A new answer counts `1 / 2^shift` of the average: 0 does not smooth. At most 4.
    pub shift: u8,
    /// For so many frames an answer is held where there is none: 0 holds none.
    pub most_held: u8,
}

impl Default for TemporalConfig {
    /// Within a pixel, a fourth, held for two frames.
    fn default() -> Self {
        Self { most_step: Disparity::ONE, shift: 2, most_held: 2 }
    }
}

/// An average over frames for every pixel, row by row as rows come out of the pipeline: `3 W H` bytes.
///
/// With `d` the new answer, `a` the average and `s` the shift: `a <- a + round((d - a) / 2^s)` where `|d -
/// a|` is at most [`TemporalConfig::most_step`], else `a <- d`. For answers with independent errors of
/// deviation `sigma` that comes to `sigma sqrt(1 / (2^(s + 1) - 1))`: with `s = 2` three eighths, but for the
/// steps of 1/32 px.
///
/// What is held is no answer of this frame, and [`Provenance::Held`] says so. A row that did not come is
/// passed as one without answers.
#[derive(Debug)]
pub struct TemporalFilter<const W: usize, const H: usize> {
    average: [[Disparity; W]; H],
    age: [[u8; W]; H],
    config: TemporalConfig,
}

impl<const W: usize, const H: usize> TemporalFilter<W, H> {
    /// A filter that has seen nothing.
    pub const fn new(config: TemporalConfig) -> Self {
        Self { average: [[Disparity::NONE; W]; H], age: [[0; W]; H], config }
    }

    /// Forgets all frames: after a cut, or when the cameras were moved.
    pub fn forget(&mut self) {
        self.average.as_flattened_mut().fill(Disparity::NONE);
    }

    /// Takes row `y` of a frame's answers and gives what is steady of it, as many columns as all of them
    /// have.
    pub fn row(
        &mut self,
        y: usize,
        answers: &[Disparity],
        out: &mut [Disparity],
        provenance: &mut [Provenance],
    ) {
        let (Some(average), Some(age)) = (self.average.get_mut(y), self.age.get_mut(y)) else { return };
        let state = average.iter_mut().zip(age);
        for (((average, age), &answer), (out, provenance)) in
            state.zip(answers).zip(out.iter_mut().zip(provenance))
        {
            *provenance = self.config.pixel(average, age, answer);
            *out = *average;
        }
    }
}

impl TemporalConfig {
    fn pixel(&self, average: &mut Disparity, age: &mut u8, answer: Disparity) -> Provenance {
        if answer.is_none() {
            *age = age.saturating_add(1);
            if average.is_none() || *age > self.most_held {
                *average = Disparity::NONE;
                return Provenance::Nothing;
            }
            return Provenance::Held;
        }
        *age = 0;
        match average.distance(answer) {
            Some(step) if step <= self.most_step => {
                let shift = self.shift.min(4);
                let (a, d) = (i32::from(average.raw()), i32::from(answer.raw()));
                // Half a step is rounded away from the average, so that it does not stop short of a steady
                // answer by more than it must.
                let change = d - a;
                let rounded = (change.abs() + (1 << shift >> 1)) >> shift;
                *average = Disparity::from_raw((a + rounded * change.signum()) as u16);
                Provenance::Averaged
            }
            _ => {
                *average = answer;
                Provenance::New
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_averaged_held_and_replaced() {
        let mut filter = TemporalFilter::<1, 1>::new(TemporalConfig::default());
        let mut next = |steps: u16| {
            let (mut out, mut provenance) = ([Disparity::NONE], [Provenance::Nothing]);
            filter.row(0, &[Disparity::from_raw(steps)], &mut out, &mut provenance);
            (out[0].raw(), provenance[0])
        };
        let none = u16::MAX;
        assert_eq!(next(none), (none, Provenance::Nothing));
        assert_eq!(next(320), (320, Provenance::New));
        assert_eq!(next(328), (322, Provenance::Averaged));
        assert_eq!(next(none), (322, Provenance::Held));
        assert_eq!(next(none), (322, Provenance::Held));
        assert_eq!(next(none), (none, Provenance::Nothing));
        assert_eq!((next(320), next(400)), ((320, Provenance::New), (400, Provenance::New)));
    }
}
