//! Answers of one surface along the row: how many there are, and their average.
//!
//! Two neighbours are of one surface when both are answers within [`Checks::surface_step`] of each other. The
//! error of a sub-pixel answer changes from pixel to pixel faster than a surface does, so an answer becomes
//! the average of those around it: as many to the left as to the right, so that a slanted surface keeps its
//! own value, and none beyond the surface's ends, so that depth edges stay where they are.
//!
//! The work is the same for every row.

use crate::matching::backend::{Backend, Isa};
use crate::matching::config::Checks;
use crate::units::Disparity;

/// Makes every answer of a row the average of up to [`Checks::smoothing_radius`] pairs around it, and gives
/// for each how many its surface has along the row, in the form that the speckle filter of the same target
/// takes. The workspace has [`SMOOTH_MARGIN`](crate::matching::backend::SMOOTH_MARGIN) numbers more than
/// there are answers.
pub(super) fn smooth(
    backend: Backend,
    answers: &mut [Disparity],
    lengths: &mut [u16],
    workspace: &mut [u16],
    checks: &Checks,
) {
    backend.smooth(answers, lengths, workspace, checks.surface_step, checks.smoothing_radius);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::backend::SMOOTH_MARGIN;

    fn averages(row: &[u16]) -> (Vec9<u16>, Vec9<u16>) {
        let mut answers = [Disparity::NONE; 9];
        let (mut lengths, mut room) = ([0; 9], [0; 9 + SMOOTH_MARGIN]);
        for (answer, &raw) in answers.iter_mut().zip(row) {
            *answer = Disparity::from_raw(raw);
        }
        smooth(
            Backend::FIRST,
            &mut answers[..row.len()],
            &mut lengths[..row.len()],
            &mut room,
            &Checks::DEFAULT,
        );
        (answers.map(Disparity::raw), lengths)
    }

    type Vec9<T> = [T; 9];

    #[test]
    fn a_slope_keeps_its_values_and_a_step_its_place() {
        let slope = [320, 322, 324, 326, 328];
        assert_eq!(
            averages(&slope),
            ([320, 322, 324, 326, 328, NONE, NONE, NONE, NONE], [5, 5, 5, 5, 5, 0, 0, 0, 0])
        );
        let step = [320, 320, 320, 640, 640];
        assert_eq!(
            averages(&step),
            ([320, 320, 320, 640, 640, NONE, NONE, NONE, NONE], [3, 3, 3, 2, 2, 0, 0, 0, 0])
        );
    }

    const NONE: u16 = u16::MAX;

    #[test]
    fn a_bump_is_flattened_and_no_answer_stays_none() {
        let row = [320, 329, 320, NONE, NONE, NONE, 65_488, 65_488, 65_456];
        let smooth = [320, 323, 320, NONE, NONE, NONE, 65_488, 65_477, 65_456];
        assert_eq!(averages(&row), (smooth, [3, 3, 3, 3, 3, 3, 3, 3, 3]));
    }
}
