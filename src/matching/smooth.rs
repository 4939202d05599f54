//! Answers averaged along the line.
//!
//! The error of a sub-pixel answer changes from pixel to pixel faster than a surface does. Neighbours are taken in
//! pairs, as far to the left as to the right, so that the average of a slanted surface is its own value; a pair counts
//! only when both lie within 1 px of the answer, so that depth edges stay where they are.

use crate::units::Disparity;

/// Pixels averaged at a time, as lanes.
const LANES: usize = 16;

/// Averages each answer of `row` with up to `radius` pairs of neighbours, into `out`. Pixels without an answer stay so.
pub(super) fn smooth(row: &[Disparity], radius: usize, out: &mut [Disparity]) {
    for (group, out) in out.chunks_mut(LANES).enumerate() {
        let x = group * LANES;
        // All neighbours of the whole group are inside the line, or each pixel looks for its own.
        let around = x.checked_sub(radius).and_then(|s| row.get(s..)).and_then(|r| r.get(..LANES + 2 * radius));
        match (around, out.as_chunks_mut::<LANES>().0) {
            (Some(around), [out]) => *out = averages(around, radius),
            _ => {
                for (x, out) in (x..).zip(out) {
                    *out = average(row, x, radius);
                }
            }
        }
    }
}

/// The averages of `LANES` pixels, `radius` pixels into `around`, whose ends all pairs reach.
fn averages(around: &[Disparity], radius: usize) -> [Disparity; LANES] {
    let lanes = |from: usize| {
        let chunk = around.get(from..).and_then(|r| r.first_chunk::<LANES>());
        chunk.map_or([u16::MAX; LANES], |chunk| chunk.map(Disparity::raw))
    };
    let centre = lanes(radius);
    let mut sums = [0; LANES];
    let mut counts = [1; LANES];
    for k in 1..=radius {
        let (left, right) = (lanes(radius - k), lanes(radius + k));
        for i in 0..LANES {
            let (sum, count) = pair(left[i], centre[i], right[i]);
            sums[i] += sum;
            counts[i] += count;
        }
    }
    let reciprocals = counts.map(reciprocal);
    core::array::from_fn(|i| moved(centre[i], sums[i], counts[i], reciprocals[i]))
}

/// The average of the pixel at column `x`.
fn average(row: &[Disparity], x: usize, radius: usize) -> Disparity {
    let at = |x: usize| row.get(x).copied().unwrap_or_default().raw();
    let centre = at(x);
    let (mut sum, mut count) = (0, 1);
    for k in 1..=radius {
        let (change, pixels) = pair(at(x.wrapping_sub(k)), centre, at(x + k));
        sum += change;
        count += pixels;
    }
    moved(centre, sum, count, reciprocal(count))
}

/// What a pair of neighbours adds to the sum of differences and to the count of pixels: nothing unless both are answers
/// within 1 px of the centre.
#[inline(always)]
fn pair(left: u16, centre: u16, right: u16) -> (i16, i16) {
    let is_near = |d: u16| (d != Disparity::NONE.raw()) & (d.abs_diff(centre) <= Disparity::ONE);
    // All ones where the pair counts: a choice without a branch.
    let near = 0 - i16::from(is_near(left) & is_near(right));
    let change = left.wrapping_sub(centre).wrapping_add(right.wrapping_sub(centre)) as i16;
    (change & near, 2 & near)
}

/// The centre moved by `sum / count`, rounded half away from zero so that no side is preferred. No answer stays none.
#[inline(always)]
fn moved(centre: u16, sum: i16, count: i16, reciprocal: u16) -> Disparity {
    // floor((2 |sum| + count) / (2 count)) by a multiplication. |sum| is at most 8 pairs of 2 x 32 steps and count at
    // most 17, and for such numbers the product with the rounded-up reciprocal has the same floor.
    let doubled = 2 * sum.unsigned_abs() + count.unsigned_abs();
    let steps = ((u32::from(doubled) * u32::from(reciprocal)) >> 16) as u16;
    let negative = (sum >> 15) as u16;
    // The average lies between the answers that it is made of: no overflow either way.
    let average = centre.wrapping_add((steps ^ negative).wrapping_sub(negative));
    let none = 0u16.wrapping_sub(u16::from(centre == Disparity::NONE.raw()));
    Disparity::from_raw(average | none)
}

/// `2^16 / (2 count)`, rounded up, for the odd counts 1 to 17.
#[inline(always)]
fn reciprocal(count: i16) -> u16 {
    RECIPROCALS[usize::from(count as u16 / 2) % RECIPROCALS.len()]
}

const RECIPROCALS: [u16; 16] = {
    let mut table = [0; 16];
    let mut i = 0;
    while i < 9 {
        table[i] = ((1 << 16) / (2 * (2 * i as u32 + 1)) + 1) as u16;
        i += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_keeps_its_values_and_a_step_its_place() {
        let slope = [320, 322, 324, 326, 328].map(Disparity::from_raw);
        let step = [320, 320, 320, 640, 640].map(Disparity::from_raw);
        for row in [slope, step] {
            let mut out = [Disparity::NONE; 5];
            smooth(&row, 4, &mut out);
            assert_eq!(out, row);
        }
    }

    #[test]
    fn a_bump_is_flattened() {
        let row = [320, 329, 320].map(Disparity::from_raw);
        let mut out = [Disparity::NONE; 3];
        smooth(&row, 4, &mut out);
        assert_eq!(out.map(Disparity::raw), [320, 323, 320]);
    }

    #[test]
    fn the_multiplication_divides() {
        for count in (1..=17i32).step_by(2) {
            for sum in -64 * 8..=64 * 8i32 {
                let exact = (2 * sum.abs() + count) / (2 * count) * sum.signum();
                assert_eq!(
                    moved(1000, sum as i16, count as i16, reciprocal(count as i16)).raw(),
                    (1000 + exact) as u16
                );
            }
        }
    }
}
