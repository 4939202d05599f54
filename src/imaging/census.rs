//! Census transform: each pixel as the signs of its differences to its neighbours (Zabih & Woodfill 1994).
//!
//! A bit is 1 where the neighbour is darker than the centre. Codes are invariant to brightness and contrast
//! of the neighbourhood; the Hamming distance of two codes counts the neighbours that disagree.
//!
//! ```text
//!      plus4          ring8              wide8
//!    . . 0 . .      0 . 1 . 2      0 . . . 1 . . . 2
//!    . . . . .      . . . . .      . . . . . . . . .
//!    1 . x . 2      3 . x . 4      . . 3 . x . 4 . .
//!    . . . . .      . . . . .      . . . . . . . . .
//!    . . 3 . .      5 . 6 . 7      5 . . . 6 . . . 7
//! ```
//!
//! The numbers are the bits of the code. Columns outside the line repeat the nearest one inside it; the
//! caller repeats rows outside the image, as [`LineWindow`](super::LineWindow) does.

/// Row and column of a neighbour in a window of 5 rows and 5 or 9 columns.
type Neighbour = (usize, usize);

const PLUS4: [Neighbour; 4] = [(0, 2), (2, 0), (2, 4), (4, 2)];

const RING8: [Neighbour; 8] = [(0, 0), (0, 2), (0, 4), (2, 0), (2, 4), (4, 0), (4, 2), (4, 4)];

const WIDE8: [Neighbour; 8] = [(0, 0), (0, 4), (0, 8), (2, 2), (2, 6), (4, 0), (4, 4), (4, 8)];

/// Computes census codes of 4 bits: up, left, right and down at distance 2.
///
/// `rows` are the five rows around the centre row. A code is written for every column of `out` that all of
/// them have.
#[cfg_attr(stereopsis_simd, inline(always))]
pub fn census_plus4(rows: &[&[u8]; 5], out: &mut [u8]) {
    census::<4, NARROW>(rows, &PLUS4, out);
}

/// Computes census codes of 8 bits from the corners and edge centres of 5x5 pixels, as [`census_plus4`] does.
#[cfg_attr(stereopsis_simd, inline(always))]
pub fn census_ring8(rows: &[&[u8]; 5], out: &mut [u8]) {
    census::<8, NARROW>(rows, &RING8, out);
}

/// Computes census codes of 8 bits from six border pixels of 9x5 and two along the line at distance 2, as
/// [`census_plus4`] does.
// Where there are vectors it is compiled with the kernel's instructions.
#[cfg_attr(stereopsis_simd, inline(always))]
pub fn census_wide8(rows: &[&[u8]; 5], out: &mut [u8]) {
    census::<8, WIDE>(rows, &WIDE8, out);
}

/// Number of columns computed at a time, as vector lanes or in an unrolled loop.
const LANES: usize = if cfg!(stereopsis_simd) {
    64
} else if cfg!(stereopsis_vectors) {
    16
} else {
    4
};
/// Number of columns that a group of codes reads.
const NARROW: usize = LANES + 2 * 2;
const WIDE: usize = LANES + 2 * 4;

#[inline(always)]
fn census<const BITS: usize, const AROUND: usize>(
    rows: &[&[u8]; 5],
    neighbours: &[Neighbour; BITS],
    out: &mut [u8],
) {
    // Columns to each side that a code looks at.
    let reach = (AROUND - LANES) / 2;
    let width = rows.iter().fold(usize::MAX, |w, row| w.min(row.len()));
    let count = out.len().min(width);
    let Some(out) = out.get_mut(..count) else { return };
    // All of one length, which is asked about once.
    let [Some(a), Some(b), Some(c), Some(d), Some(e)] = rows.map(|row| row.get(..width)) else { return };
    let rows = [a, b, c, d, e];
    let inner = count.min(width.saturating_sub(reach)).saturating_sub(reach);
    // The inner columns in groups, all bits of a group at once: comparisons without a branch, on whole
    // registers. The last group is moved back to end with the line.
    let begins = (0..inner / LANES).map(|group| group * LANES).chain(inner.checked_sub(LANES));
    for begin in begins {
        let around =
            rows.map(|row| row.get(begin..).and_then(|row| row.first_chunk()).unwrap_or(&[0; AROUND]));
        let group = |row: usize, column: usize| {
            let pixels =
                around.get(row).and_then(|row| row.get(column..)).and_then(|row| row.first_chunk::<LANES>());
            pixels.copied().unwrap_or([0; LANES])
        };
        let centre = group(2, reach);
        let mut codes = [0; LANES];
        for (bit, &(row, column)) in (0u32..).zip(neighbours) {
            let beside = group(row, column);
            for i in 0..LANES {
                codes[i] |= u8::from(beside[i] < centre[i]) << bit;
            }
        }
        if let Some(out) = out.get_mut(begin + reach..).and_then(|out| out.first_chunk_mut::<LANES>()) {
            *out = codes;
        }
    }
    // The columns at each side pixel by pixel, and all of a line that is shorter than a group.
    let grouped = if inner < LANES { reach..reach } else { reach..reach + inner };
    for x in (0..grouped.start.min(count)).chain(grouped.end.min(count)..count) {
        let pixel = |row: usize, column: usize| {
            let x = (x + column).saturating_sub(reach).min(width - 1);
            rows.get(row).and_then(|r| r.get(x)).copied().unwrap_or(0)
        };
        let mut code = 0;
        for (bit, &(row, column)) in (0u32..).zip(neighbours) {
            code |= u8::from(pixel(row, column) < pixel(2, reach)) << bit;
        }
        if let Some(out) = out.get_mut(x) {
            *out = code;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bright_point_is_brighter_than_all_and_all_are_darker() {
        let (dark, bright) = ([10; 5], [10, 10, 90, 10, 10]);
        let rows = [&dark[..], &dark, &bright, &dark, &dark];
        let (mut plus, mut ring, mut wide) = ([0; 5], [0; 5], [0; 5]);
        census_plus4(&rows, &mut plus);
        census_ring8(&rows, &mut ring);
        census_wide8(&rows, &mut wide);
        assert_eq!(plus, [0, 0, 0b1111, 0, 0]);
        assert_eq!(ring, [0, 0, 0xff, 0, 0]);
        assert_eq!(wide, [0, 0, 0xff, 0, 0]);
    }

    #[test]
    fn a_ramp_sets_the_left_bits_and_its_ends_repeat() {
        let ramp = [1, 2, 3, 4, 5, 6];
        let mut codes = [0; 6];
        census_plus4(&[&ramp; 5], &mut codes);
        // Bit 1 is the left neighbour; at column 0 it is the pixel itself, which is not darker.
        assert_eq!(codes, [0, 0b10, 0b10, 0b10, 0b10, 0b10]);
    }
}
