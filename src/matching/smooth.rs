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
    let mut sums = [0i16; LANES];
    let mut counts = [1i16; LANES];
    for k in 1..=radius {
        let (left, right) = (lanes(radius - k), lanes(radius + k));
        for i in 0..LANES {
            // All ones where the pair counts: a choice without a branch.
            let near = 0 - i16::from(is_near(left[i], centre[i]) & is_near(right[i], centre[i]));
            let off = left[i].wrapping_sub(centre[i]).wrapping_add(right[i].wrapping_sub(centre[i])) as i16;
            sums[i] += off & near;
            counts[i] += 2 & near;
        }
    }
    core::array::from_fn(|i| moved(centre[i], sums[i], counts[i]))
}

/// The average of the pixel at column `x`.
fn average(row: &[Disparity], x: usize, radius: usize) -> Disparity {
    let at = |x: usize| row.get(x).copied().unwrap_or_default().raw();
    let centre = at(x);
    let (mut sum, mut count) = (0, 1);
    for k in 1..=radius {
        let (left, right) = (at(x.wrapping_sub(k)), at(x + k));
        if is_near(left, centre) && is_near(right, centre) {
            sum += left.wrapping_sub(centre).wrapping_add(right.wrapping_sub(centre)) as i16;
            count += 2;
        }
    }
    moved(centre, sum, count)
}

/// Whether a neighbour is an answer within 1 px of the centre.
#[inline(always)]
fn is_near(neighbour: u16, centre: u16) -> bool {
    (neighbour != Disparity::NONE.raw()) & (neighbour.abs_diff(centre) <= Disparity::ONE)
}

/// The centre moved by `sum / count`, rounded half away from zero so that no side is preferred. No answer stays none.
#[inline(always)]
fn moved(centre: u16, sum: i16, count: i16) -> Disparity {
    // floor((2 |sum| + count) / (2 count)) by a multiplication. |sum| is at most 8 pairs of 2 x 32 steps and count at
    // most 17, and for such numbers the product with the rounded-up reciprocal has the same floor.
    let reciprocal = RECIPROCALS.get(usize::from(count.unsigned_abs() / 2)).copied().unwrap_or(0);
    let steps = ((2 * u32::from(sum.unsigned_abs()) + u32::from(count.unsigned_abs())) * reciprocal) >> 16;
    let change = if sum < 0 { -(steps as i32) } else { steps as i32 };
    if centre == Disparity::NONE.raw() {
        return Disparity::NONE;
    }
    Disparity::from_raw((i32::from(centre) + change).clamp(0, i32::from(Disparity::MAX.raw())) as u16)
}

/// `2^16 / (2 count)`, rounded up, at `count / 2` for the odd counts 1 to 17.
const RECIPROCALS: [u32; 9] = {
    let mut table = [0; 9];
    let mut i = 0;
    while i < 9 {
        table[i] = (1 << 16) / (2 * (2 * i as u32 + 1)) + 1;
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
                assert_eq!(moved(1000, sum as i16, count as i16).raw(), (1000 + exact) as u16);
            }
        }
    }
}
