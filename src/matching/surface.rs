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

/// The pass to the right.
pub(super) struct Runs {
    step: u32,
    before: i32,
    length: u16,
    sum: u16,
}

impl Runs {
    /// Before the first answer of a row.
    pub(super) fn new(step: Disparity) -> Self {
        // No answer is near what stands before the row.
        Self { step: u32::from(step.raw()), before: i32::MIN / 2, length: 0, sum: 0 }
    }

    /// Takes the next answer: the length of its surface up to it, and the sum of all raw disparities up to it, modulo
    /// 2^16.
    #[inline(always)]
    pub(super) fn next(&mut self, answer: Disparity) -> (u16, u16) {
        let here = i32::from(answer.raw());
        // No branch: pictures decide nothing about the work. `NONE` is far from every answer (Config::check).
        let joined = ((here - self.before) as u32).wrapping_add(self.step) <= 2 * self.step;
        self.length = (self.length & 0u16.wrapping_sub(u16::from(joined))) + 1;
        self.sum = self.sum.wrapping_add(answer.raw());
        self.before = here;
        (self.length, self.sum)
    }
}

/// The pass back: makes every answer of a row the average of up to `radius` pairs around it, and every length that of the
/// whole surface along the row. `sums[x]` is the sum of all answers left of `x`, `lengths` and `sums` are of [`Runs`].
#[inline(never)]
pub(super) fn average(answers: &mut [Disparity], lengths: &mut [u16], sums: &[u16], radius: u8) {
    let (mut whole, mut goes_on) = (0, false);
    for ((x, answer), length) in answers.iter_mut().enumerate().zip(lengths).rev() {
        let here = u32::from(*length);
        whole = if goes_on { whole } else { here };
        goes_on = here > 1;
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
        let mut runs = Runs::new(Disparity::ONE_PIXEL);
        for (x, &raw) in row.iter().enumerate() {
            answers[x] = Disparity::from_raw(raw);
            (lengths[x], sums[x + 1]) = runs.next(answers[x]);
        }
        average(&mut answers[..row.len()], &mut lengths[..row.len()], &sums, 4);
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
