//! Answers of one surface along the row: how many there are, and their average.
//!
//! Two neighbours are of one surface when both are answers within [`Checks::surface_step`] of each other. The error of a
//! sub-pixel answer changes from pixel to pixel faster than a surface does, so an answer becomes the average of those
//! around it: as many to the left as to the right, so that a slanted surface keeps its own value, and none beyond the
//! surface's ends, so that depth edges stay where they are.
//!
//! The work is the same for every row: one pass to the right that counts and adds up, one back that averages.

use super::config::Checks;
use crate::units::Disparity;

/// Makes every answer of a row the average of up to [`Checks::smoothing_radius`] pairs around it, and gives for each how
/// many its surface has along the row. `sums` is room for one number more than there are answers.
pub(super) fn average(answers: &mut [Disparity], lengths: &mut [u16], sums: &mut [u16], checks: &Checks) {
    count(answers, lengths, sums, checks.surface_step);
    average_counted(answers, lengths, sums, checks.smoothing_radius);
}

/// The pass to the right: for every answer how many of its surface there are up to it, and the sum of all raw disparities
/// left of it, modulo 2^16.
#[inline(never)]
fn count(answers: &[Disparity], lengths: &mut [u16], sums: &mut [u16], step: Disparity) {
    let step = u32::from(step.raw());
    // No answer is near what stands before the row.
    let (mut before, mut length, mut sum) = (u32::MAX / 2, 0u16, 0u16);
    let Some((none, sums)) = sums.split_first_mut() else { return };
    *none = sum;
    for (answer, (length_here, sum_here)) in answers.iter().zip(lengths.iter_mut().zip(sums)) {
        let here = u32::from(answer.raw());
        // No branch: pictures decide nothing about the work. `NONE` is far from every answer (Config::check).
        let joined = here.wrapping_sub(before).wrapping_add(step) <= 2 * step;
        length = (length & 0u16.wrapping_sub(u16::from(joined))) + 1;
        sum = sum.wrapping_add(answer.raw());
        before = here;
        (*length_here, *sum_here) = (length, sum);
    }
}

/// The pass back.
#[inline(never)]
fn average_counted(answers: &mut [Disparity], lengths: &mut [u16], sums: &[u16], radius: u8) {
    // The first of the next surface has the length 1.
    let (mut whole, mut next) = (0, 1);
    for ((x, answer), length) in answers.iter_mut().enumerate().zip(lengths).rev() {
        let here = u32::from(*length);
        whole = if next > 1 { whole } else { here };
        next = here;
        let reach = (here - 1).min(whole.wrapping_sub(here)).min(u32::from(radius)) as usize;
        let to = |x: usize| sums.get(x).copied().unwrap_or(0);
        let sum = to(x + reach + 1).wrapping_sub(to(x.wrapping_sub(reach)));
        *answer = averaged(*answer, sum, reach);
        *length = whole as u16;
    }
}

/// The average of `2 reach + 1` answers whose raw sum is `sum` modulo 2^16, of which `centre` is the middle one.
#[inline(always)]
fn averaged(centre: Disparity, sum: u16, reach: usize) -> Disparity {
    let count = 2 * reach as u16 + 1;
    // What the others differ by in all: at most 2 x (1 + .. + 8) px, far inside 16 bits.
    let difference = sum.wrapping_sub(count.wrapping_mul(centre.raw())) as i16;
    // Rounded to the nearest; there is no tie, for the count is odd.
    let steps = (i32::from(difference) * RECIPROCALS[reach % RECIPROCALS.len()] + (1 << 15)) >> 16;
    Disparity::from_raw(centre.raw().wrapping_add(steps as u16))
}

/// `2^16 / (2 reach + 1)`, rounded.
const RECIPROCALS: [i32; 16] = {
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
        let (mut lengths, mut sums) = ([0; 9], [0; 10]);
        for (answer, &raw) in answers.iter_mut().zip(row) {
            *answer = Disparity::from_raw(raw);
        }
        average(&mut answers[..row.len()], &mut lengths[..row.len()], &mut sums, &Checks::DEFAULT);
        (answers.map(Disparity::raw), lengths)
    }

    type Vec9<T> = [T; 9];

    #[test]
    fn a_slope_keeps_its_values_and_a_step_its_place() {
        let slope = [320, 322, 324, 326, 328];
        assert_eq!(averages(&slope), ([320, 322, 324, 326, 328, NONE, NONE, NONE, NONE], [5, 5, 5, 5, 5, 0, 0, 0, 0]));
        let step = [320, 320, 320, 640, 640];
        assert_eq!(averages(&step), ([320, 320, 320, 640, 640, NONE, NONE, NONE, NONE], [3, 3, 3, 2, 2, 0, 0, 0, 0]));
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
                assert_eq!(averaged(Disparity::from_raw(1000), sum, reach as usize).raw(), (1000 + exact) as u16);
            }
        }
    }
}
