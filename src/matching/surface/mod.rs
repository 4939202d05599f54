//! Answers of one surface along the row: how many there are, and their average.
//!
//! Two neighbours are of one surface when both are answers within [`Checks::surface_step`] of each other. The
//! error of a sub-pixel answer changes from pixel to pixel faster than a surface does, so an answer becomes
//! the average of those around it: as many to the left as to the right, so that a slanted surface keeps its
//! own value, and none beyond the surface's ends, so that depth edges stay where they are.
//!
//! * `runs`: pixel by pixel, from the sums up to each.
//! * `lanes`: pixels side by side, for the kernels in vectors; in assembly in `kernels/helium` and
//!   `kernels/bytes`.
//!
//! All give the same. The work is the same for every row.

#[cfg(target_pointer_width = "64")]
mod lanes;
#[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
mod runs;

use super::config::Checks;
use super::kernels::Kernel;
#[cfg(stereopsis_dsp)]
use super::kernels::bytes as assembly;
#[cfg(stereopsis_vectors)]
use super::kernels::helium as assembly;
use crate::units::Disparity;

/// Makes every answer of a row the average of up to [`Checks::smoothing_radius`] pairs around it, and gives
/// for each how many its surface has along the row; in assembly these are bytes. `room` has [`ROOM`] numbers
/// more than there are answers.
pub(super) fn average(
    kernel: Kernel,
    answers: &mut [Disparity],
    lengths: &mut [u16],
    room: &mut [u16],
    checks: &Checks,
) {
    #[cfg(target_pointer_width = "64")]
    if kernel.has_vectors() && answers.len() >= lanes::LANES {
        return kernel.in_vectors(
            #[inline(always)]
            || lanes::average(answers, lengths, room, checks),
        );
    }
    let _ = kernel;
    #[cfg(any(stereopsis_vectors, stereopsis_dsp))]
    assembly::average(answers, lengths, room, checks.surface_step, checks.smoothing_radius);
    #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
    {
        runs::count(answers, lengths, room, checks.surface_step);
        runs::average(answers, lengths, room, checks.smoothing_radius);
    }
}

/// Numbers that are wanted beside one for each answer: by the lanes, the runs want one.
pub(super) const ROOM: usize = 2 * Checks::MOST_SMOOTHING as usize;

/// Whether two answers are of one surface; `NONE`s are, and are far from every answer (Config::check).
#[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
#[inline(always)]
pub(super) fn of_one(a: u16, b: u16, step: Disparity) -> bool {
    if cfg!(target_pointer_width = "64") {
        // Half-words stay half-words.
        a.abs_diff(b) <= step.raw()
    } else {
        let step = u32::from(step.raw());
        u32::from(a).wrapping_sub(u32::from(b)).wrapping_add(step) <= 2 * step
    }
}

/// `2^16 / (2 reach + 1)`, rounded.
pub(super) const RECIPROCALS: [i32; 16] = {
    let mut table = [0; 16];
    let mut reach = 0;
    while reach <= Checks::MOST_SMOOTHING as usize {
        let count = 2 * reach as i32 + 1;
        table[reach] = ((1 << 16) + count / 2) / count;
        reach += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    fn averages(row: &[u16]) -> (Vec9<u16>, Vec9<u16>) {
        let mut answers = [Disparity::NONE; 9];
        let (mut lengths, mut room) = ([0; 9], [0; 9 + ROOM]);
        for (answer, &raw) in answers.iter_mut().zip(row) {
            *answer = Disparity::from_raw(raw);
        }
        average(
            Kernel::FIRST,
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
