//! Sobel gradients, truncated as the cost of Birchfield and Tomasi wants them in semi-global matching.

/// Computes Sobel gradients of a row, `along` and `across` the line, in eighths of a grey level per pixel,
/// clamped to `-most..=most` (at most 127) and offset by `most`.
///
/// `rows` are the row above, the row itself and the row below. Gradients are written for every column that
/// all slices have; columns outside the line repeat the nearest one inside.
// Where there are vectors it is compiled with the kernel's instructions.
#[cfg_attr(stereopsis_simd, inline(always))]
pub fn gradients(rows: &[&[u8]; 3], most: u8, along: &mut [u8], across: &mut [u8]) {
    let most = i16::from(most.min(127));
    let width = rows.iter().fold(usize::MAX, |w, row| w.min(row.len()));
    let count = along.len().min(across.len()).min(width);
    let (Some(along), Some(across)) = (along.get_mut(..count), across.get_mut(..count)) else { return };
    let last = width.saturating_sub(1);
    let inner = count.min(last).saturating_sub(1);
    // The inner columns in groups; the last group is moved back to end with the line.
    let begins = (0..inner / LANES).map(|group| group * LANES).chain(inner.checked_sub(LANES));
    for begin in begins {
        let around =
            rows.map(|row| row.get(begin..).and_then(|row| row.first_chunk()).unwrap_or(&[0; AROUND]));
        let (to_along, to_across) = (along.get_mut(begin + 1..), across.get_mut(begin + 1..));
        let to_along = to_along.and_then(|to| to.first_chunk_mut::<LANES>());
        if let (Some(to_along), Some(to_across)) =
            (to_along, to_across.and_then(|to| to.first_chunk_mut::<LANES>()))
        {
            (*to_along, *to_across) = group::<LANES, AROUND>(around, most);
        }
    }
    // The columns at the ends one by one, and all of a line that is shorter than a group.
    let grouped = if inner < LANES { 1 } else { 1 + inner };
    for x in (0..count.min(1)).chain(grouped.min(count)..count) {
        let three = |row: &[u8]| {
            [x.saturating_sub(1), x, (x + 1).min(last)].map(|x| row.get(x).copied().unwrap_or(0))
        };
        let around = rows.map(three);
        if let Some((along, across)) = along.get_mut(x).zip(across.get_mut(x)) {
            let ([one], [other]) = group::<1, 3>(around.each_ref(), most);
            (*along, *across) = (one, other);
        }
    }
}

/// Number of columns computed at a time, as vector lanes or in an unrolled loop.
const LANES: usize = if cfg!(stereopsis_simd) {
    32
} else if cfg!(stereopsis_vectors) {
    16
} else {
    4
};
/// Number of columns that a group of gradients reads.
const AROUND: usize = LANES + 2;

/// Gradients of `N` columns from `M` = `N + 2` pixels.
#[inline(always)]
fn group<const N: usize, const M: usize>(around: [&[u8; M]; 3], most: i16) -> ([u8; N], [u8; N]) {
    const { assert!(M == N + 2) };
    let (mut along, mut across) = ([0; N], [0; N]);
    let cut = |gradient: i16| (gradient.max(-most).min(most) + most) as u8;
    // Each from the pixels: sums kept for the next column would be vectors in memory, read across two of
    // them.
    let at = |row: usize, off: usize| {
        let pixels = around.get(row).and_then(|row| row.get(off..)).and_then(|row| row.first_chunk::<N>());
        pixels.copied().unwrap_or([0; N])
    };
    let (above, above_1, above_2) = (at(0, 0), at(0, 1), at(0, 2));
    let (here, here_2) = (at(1, 0), at(1, 2));
    let (below, below_1, below_2) = (at(2, 0), at(2, 1), at(2, 2));
    let difference = |a: u8, b: u8| i16::from(a) - i16::from(b);
    for i in 0..N {
        let sides = [
            difference(above_2[i], above[i]),
            difference(here_2[i], here[i]),
            difference(below_2[i], below[i]),
        ];
        along[i] = cut(sides[0] + 2 * sides[1] + sides[2]);
        let down = [
            difference(below[i], above[i]),
            difference(below_1[i], above_1[i]),
            difference(below_2[i], above_2[i]),
        ];
        across[i] = cut(down[0] + 2 * down[1] + down[2]);
    }
    (along, across)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_has_one_gradient_but_at_its_ends() {
        let ramp = [10, 11, 12, 13, 14];
        let (mut along, mut across) = ([0; 5], [0; 5]);
        gradients(&[&ramp; 3], 20, &mut along, &mut across);
        assert_eq!((along, across), ([24, 28, 28, 28, 24], [20; 5]));
        gradients(&[&[9; 5], &[10; 5], &[11; 5]], 5, &mut along, &mut across);
        assert_eq!((along, across), ([5; 5], [10; 5]));
    }

    #[test]
    fn only_what_has_a_place_is_written() {
        let (mut along, mut across) = ([99; 4], [99; 2]);
        gradients(&[&[1, 2, 4], &[1, 2, 4], &[1, 2, 4]], 100, &mut along, &mut across);
        assert_eq!((along, across), ([104, 112, 99, 99], [100, 100]));
        gradients(&[&[], &[1], &[1]], 100, &mut along, &mut across);
        assert_eq!((along[0], across[0]), (104, 100));
    }
}
