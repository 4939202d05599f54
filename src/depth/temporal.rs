//! Temporal filter: a running average of disparities per pixel, which holds answers over short gaps.

use crate::units::Disparity;

/// Origin of a filtered disparity.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
pub enum Provenance {
    /// There is no answer, neither now nor in the last frames.
    #[default]
    Nothing,
    /// The answer is this frame's alone: the first here, or far from the average.
    New,
    /// The answer is the average of this frame's and earlier ones.
    Averaged,
    /// The answer is of an earlier frame, as this one has none.
    Held,
}

/// Smoothing and holding of a [`TemporalFilter`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TemporalConfig {
    /// Largest difference of answers of one surface, steps of 1/32 px.
    pub most_step: u16,
    /// Weight `1 / 2^shift` of a new answer in the average: 0 does not smooth, at most 4.
    pub shift: u8,
    /// Number of frames for which an answer is held where there is none.
    pub most_held: u8,
}

impl Default for TemporalConfig {
    /// Averages within one pixel with weight 1/4, and holds for two frames.
    fn default() -> Self {
        Self { most_step: Disparity::ONE, shift: 2, most_held: 2 }
    }
}

/// Running average over frames for every pixel, row by row as rows leave the pipeline: `3 W H` bytes.
///
/// With `d` the new answer, `a` the average and `s` the shift, `a <- a + round((d - a) / 2^s)` where `|d -
/// a|` is at most [`TemporalConfig::most_step`], else `a <- d`. Independent errors of standard deviation
/// `sigma` shrink to `sigma sqrt(1 / (2^(s + 1) - 1))`: 3/8 of it with `s = 2`, apart from rounding to 1/32
/// px. By that the average of a steady answer may stay up to `2^(s - 1) - 1` steps of 1/32 px from it, 1 with
/// `s = 2` and 7 with 4, and noise of a few steps shrinks less.
///
/// A missing row is passed as one without answers.
#[derive(Debug)]
pub struct TemporalFilter<const W: usize, const H: usize> {
    average: [[Disparity; W]; H],
    age: [[u8; W]; H],
    config: TemporalConfig,
}

/// A borrowed [`TemporalFilter`] of any size.
#[derive(Debug)]
pub struct TemporalFilterView<'a> {
    average: &'a mut [Disparity],
    age: &'a mut [u8],
    width: usize,
    config: TemporalConfig,
}

/// The memory of a filter has parts of different lengths.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TemporalMemoryError {
    /// The length that both parts would have to have.
    pub needed: usize,
}

error_text!(TemporalMemoryError {
    Self { needed } => "both parts of the memory must hold {needed} pixels",
});

impl<const W: usize, const H: usize> TemporalFilter<W, H> {
    /// Creates a filter without history.
    pub const fn new(config: TemporalConfig) -> Self {
        Self { average: [[Disparity::NONE; W]; H], age: [[0; W]; H], config }
    }

    /// The filter without its capacities.
    pub fn as_mut_view(&mut self) -> TemporalFilterView<'_> {
        let (average, age) = (self.average.as_flattened_mut(), self.age.as_flattened_mut());
        TemporalFilterView { average, age, width: W, config: self.config }
    }

    /// Forgets all frames, see [`TemporalFilterView::forget`].
    pub fn forget(&mut self) {
        self.as_mut_view().forget();
    }

    /// Filters row `y` of a frame, see [`TemporalFilterView::row`].
    pub fn row(
        &mut self,
        y: usize,
        answers: &[Disparity],
        out: &mut [Disparity],
        provenance: &mut [Provenance],
    ) {
        self.as_mut_view().row(y, answers, out, provenance);
    }
}

impl<'a> TemporalFilterView<'a> {
    /// A filter in the caller's memory, an average and an age for each pixel of rows `width` wide. A new
    /// filter has averages of [`Disparity::NONE`]; one that goes on has what the last one left.
    pub fn new(
        config: TemporalConfig,
        width: usize,
        average: &'a mut [Disparity],
        age: &'a mut [u8],
    ) -> Result<Self, TemporalMemoryError> {
        let needed = average.len().max(age.len()).next_multiple_of(width.max(1));
        if average.len() != needed || age.len() != needed {
            return Err(TemporalMemoryError { needed });
        }
        Ok(Self { average, age, width, config })
    }

    /// Forgets all frames, after a cut or when the cameras were moved.
    pub fn forget(&mut self) {
        self.average.fill(Disparity::NONE);
    }

    /// Filters row `y` of a frame, for as many columns as all slices have. A row that the filter has no
    /// memory for is without answers.
    pub fn row(
        &mut self,
        y: usize,
        answers: &[Disparity],
        out: &mut [Disparity],
        provenance: &mut [Provenance],
    ) {
        let width = self.width.max(1);
        if y >= self.average.len() / width {
            let filtered = out.iter_mut().zip(provenance).zip(answers).take(self.width);
            filtered.for_each(|((out, from), _)| (*out, *from) = (Disparity::NONE, Provenance::Nothing));
            return;
        }
        let average = self.average.chunks_exact_mut(width).nth(y).unwrap_or_default();
        let age = self.age.chunks_exact_mut(width).nth(y).unwrap_or_default();
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
            let is_over = *age >= self.most_held;
            *age = age.saturating_add(1);
            if average.is_none() || is_over {
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
    fn rows_beyond_the_last_have_no_answers() {
        let mut filter = TemporalFilter::<2, 1>::new(TemporalConfig::default());
        let seven = [Disparity::from_raw(7); 2];
        for y in [1, 2, usize::MAX] {
            let (mut out, mut provenance) = (seven, [Provenance::Averaged; 2]);
            filter.row(y, &seven, &mut out, &mut provenance);
            assert_eq!((out, provenance), ([Disparity::NONE; 2], [Provenance::Nothing; 2]), "row {y}");
        }
    }

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
