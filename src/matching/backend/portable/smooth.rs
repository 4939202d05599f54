//! Answers averaged within their surface, pixel by pixel: one pass to the right that counts and adds up, one
//! back that averages.

use crate::matching::backend::loops::{KEEPS_LOOPS, keep_loop};
use crate::matching::backend::work::SmoothWork;
use crate::matching::config::Checks;
use crate::units::Disparity;

/// [`Isa::smooth`](crate::matching::backend::Isa::smooth) in two passes.
#[inline(always)]
pub(in crate::matching::backend) fn smooth(work: SmoothWork<'_>) {
    let SmoothWork { answers, lengths, workspace, step, radius } = work;
    average_row(answers, lengths.half_words(), workspace, step, radius);
}

/// Makes every answer of a row the average of up to `radius` pairs around it, and gives for each how many its
/// surface has along the row. The workspace has a number more than there are answers.
#[inline(always)]
fn average_row(
    answers: &mut [Disparity],
    lengths: &mut [u16],
    workspace: &mut [u16],
    step: Disparity,
    radius: u8,
) {
    count(answers, lengths, workspace, step);
    average(answers, lengths, workspace, radius);
}

/// Numbers of the workspace that are wanted beside one for each answer; [`smooth`] wants one.
pub(in crate::matching) const MARGIN: usize = 2 * Checks::MOST_SMOOTHING as usize;

/// Whether two answers are of one surface; `NONE`s are, and are far from every answer (Config::check).
#[inline(always)]
pub(in crate::matching::backend) fn of_one(a: u16, b: u16, step: Disparity) -> bool {
    if KEEPS_LOOPS {
        let step = u32::from(step.raw());
        u32::from(a).wrapping_sub(u32::from(b)).wrapping_add(step) <= 2 * step
    } else {
        // Half-words stay half-words.
        a.abs_diff(b) <= step.raw()
    }
}

/// `2^16 / (2 reach + 1)`, rounded.
pub(in crate::matching::backend) const RECIPROCALS: [i32; 16] = {
    let mut table = [0; 16];
    let mut reach = 0;
    while reach <= Checks::MOST_SMOOTHING as usize {
        let count = 2 * reach as i32 + 1;
        table[reach] = ((1 << 16) + count / 2) / count;
        reach += 1;
    }
    table
};

/// The pass to the right: for every answer how many of its surface there are up to it, and the sum of all raw
/// disparities left of it, modulo 2^16.
#[inline(never)]
fn count(answers: &[Disparity], lengths: &mut [u16], sums: &mut [u16], step: Disparity) {
    let step = u32::from(step.raw());
    // No answer is near what stands before the row.
    let (mut before, mut length, mut sum) = (u32::MAX / 2, 0u16, 0u16);
    let Some((none, sums)) = sums.split_first_mut() else { return };
    *none = sum;
    for (answer, (length_here, sum_here)) in answers.iter().zip(lengths.iter_mut().zip(sums)) {
        keep_loop();
        let here = u32::from(answer.raw());
        // No branch: pictures decide nothing about the work. `NONE` is far from every answer (Config::check).
        let joined = here.wrapping_sub(before).wrapping_add(step) <= 2 * step;
        length = (length & 0u16.wrapping_sub(u16::from(joined))) + 1;
        sum = sum.wrapping_add(answer.raw());
        before = here;
        (*length_here, *sum_here) = (length, sum);
    }
}

/// The pass back: makes every answer the average, and every length that of the whole surface.
#[inline(never)]
fn average(answers: &mut [Disparity], lengths: &mut [u16], sums: &[u16], radius: u8) {
    // The first of the next surface has the length 1.
    let (mut whole, mut next) = (0, 1);
    // Never more than there are reciprocals, which here costs nothing to say.
    let radius = u32::from(radius) % RECIPROCALS.len() as u32;
    for ((x, answer), length) in answers.iter_mut().enumerate().zip(lengths).rev() {
        let here = u32::from(*length);
        whole = if next > 1 { whole } else { here };
        next = here;
        let reach = (here - 1).min(whole.wrapping_sub(here)).min(radius) as usize;
        let to = |x: usize| sums.get(x).copied().unwrap_or(0);
        let sum = to(x + reach + 1).wrapping_sub(to(x.wrapping_sub(reach)));
        *answer = averaged(*answer, sum, reach);
        *length = whole as u16;
    }
}

/// The average of `2 reach + 1` answers whose raw sum is `sum` modulo 2^16, of which `centre` is the middle
/// one.
#[inline(always)]
fn averaged(centre: Disparity, sum: u16, reach: usize) -> Disparity {
    let count = 2 * reach as u16 + 1;
    // What the others differ by in all: at most 2 x (1 + .. + 8) px, far inside 16 bits.
    let difference = sum.wrapping_sub(count.wrapping_mul(centre.raw())) as i16;
    // Rounded to the nearest; there is no tie, for the count is odd.
    let steps = (i32::from(difference) * RECIPROCALS[reach % RECIPROCALS.len()] + (1 << 15)) >> 16;
    Disparity::from_raw(centre.raw().wrapping_add(steps as u16))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn averages(row: &[u16]) -> (Vec9<u16>, Vec9<u16>) {
        let mut answers = [Disparity::NONE; 9];
        let (mut lengths, mut room) = ([0; 9], [0; 9 + MARGIN]);
        for (answer, &raw) in answers.iter_mut().zip(row) {
            *answer = Disparity::from_raw(raw);
        }
        let (row, lengths_of_row) = (&mut answers[..row.len()], &mut lengths[..row.len()]);
        average_row(
            row,
            lengths_of_row,
            &mut room,
            Checks::DEFAULT.surface_step,
            Checks::DEFAULT.smoothing_radius,
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

    #[test]
    fn the_multiplication_divides() {
        for reach in 0..=8i32 {
            let count = 2 * reach + 1;
            let most = 32 * reach * (reach + 1);
            for difference in -most..=most {
                let exact = (2 * difference + count).div_euclid(2 * count);
                let sum = (1000 * count + difference) as u16;
                assert_eq!(
                    averaged(Disparity::from_raw(1000), sum, reach as usize).raw(),
                    (1000 + exact) as u16
                );
            }
        }
    }
}
