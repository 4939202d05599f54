//! Scores of FAST-9 and smoothing for four pixels at a time, in Arm's instructions on four bytes of a word
//! and on its halves (Cortex-M4, M7, M55, and M33 that have them).

use super::circle::CIRCLE;
use crate::dsp::{add_even_bytes, add_odd_bytes, max, max_min, min, saturating_subtract, select};

/// Pixels at a time.
pub(super) const PIXELS: usize = 4;
/// Columns that their circles lie in.
pub(super) const COLUMNS: usize = PIXELS + 6;

/// Which of four pixels, whose circles lie in these rows from the first column on, may have nine neighbours
/// in a row that are brighter by more than `least`: the bytes that are not 0. And which ones may have nine
/// that are darker: 255, the others 0.
#[inline(always)]
pub(super) fn brighter_and_darker(rows: &[&[u8; COLUMNS]; 7], least: u32) -> [u32; 2] {
    let centre = four(rows, (3, 3));
    // Nine of sixteen in a row hold one of every two that lie opposite to each other.
    let [(a, e), (b, f), (c, g), (d, h)] =
        [0, 4, 2, 6].map(|i| max_min([i, i + 8].map(|i| on_circle(rows, i))));
    let (brightest, darkest) = (min(min(a, b), min(c, d)), max(max(e, f), max(g, h)));
    let brighter = saturating_subtract(saturating_subtract(brightest, centre), least);
    [brighter, select(least, saturating_subtract(centre, darkest), 0, u32::MAX)]
}

/// The scores of four pixels, by how much their neighbours are brighter, or darker where all is `inverted`.
///
/// What is asked of all sixteen differences to the pixel is asked of the circle itself, and the pixel is
/// subtracted afterwards: the weakest of nine brighter ones is the least of nine.
#[inline(always)]
pub(super) fn scores_of_four(rows: &[&[u8; COLUMNS]; 7], least: u32, inverted: u32) -> u32 {
    let nine = least_of_best_nine(|i| on_circle(rows, i) ^ inverted);
    let more = saturating_subtract(nine, four(rows, (3, 3)) ^ inverted);
    select(least, more, 0, more)
}

/// The neighbours of four pixels at one place of the circle.
#[inline(always)]
fn on_circle(rows: &[&[u8; COLUMNS]; 7], i: usize) -> u32 {
    four(rows, CIRCLE[i & 15])
}

/// Four pixels from a row and a column on.
#[inline(always)]
fn four<const N: usize>(rows: &[&[u8; N]], (row, column): (usize, usize)) -> u32 {
    let bytes = rows.get(row).and_then(|row| row.get(column..)).and_then(|row| row.first_chunk());
    bytes.map_or(0, |bytes| u32::from_le_bytes(*bytes))
}

/// The greatest of all minima of nine in a row, around the circle.
///
/// Of the eight nines that begin at `i` to `i + 7`, the first four hold the four neighbours before `i + 7`,
/// the others the four after `i + 8`, and all hold these two.
#[inline(always)]
fn least_of_best_nine(value: impl Fn(usize) -> u32) -> u32 {
    let twos: [u32; 8] = core::array::from_fn(|i| min(value(2 * i + 1), value(2 * i + 2)));
    let two = |i: usize| twos[(i / 2) & 7];
    // Of four nines that begin at `i` to `i + 3`, what not all of them hold.
    let four = |i: usize| {
        let first = min(two(i + 1), max(value(i), value(i + 9)));
        max(first, min(two(i + 9), max(value(i + 2), value(i + 11))))
    };
    let eight = |i: usize| {
        let first = min(four(i), min(two(i + 3), two(i + 5)));
        let second = min(four(i + 4), min(two(i + 9), two(i + 11)));
        min(max(first, second), two(i + 7))
    };
    max(eight(0), eight(8))
}

/// Which of four scores are local maxima, for [`super::maxima`].
#[inline(always)]
pub(super) fn maxima_of_four(rows: [&[u8; PIXELS + 2]; 3]) -> u32 {
    let four = |row: usize, column: usize| four(&rows, (row, column));
    let here = four(1, 1);
    let before = max(max(four(0, 0), four(0, 1)), max(four(0, 2), four(1, 0)));
    let after = max(max(four(2, 0), four(2, 1)), max(four(2, 2), four(1, 2)));
    select(here, after, saturating_subtract(here, before), 0)
}

/// Sums of four columns of five rows by the weights of [`super::binomial`]: those of the first and the third
/// in the halves of a word, and those of the other two.
#[inline(always)]
pub(super) fn column_sums(rows: [&[u8; PIXELS]; 5]) -> [u32; 2] {
    let [a, b, c, d, e] = rows.map(|row| u32::from_le_bytes(*row));
    let sums = |plus: fn(u32, u32) -> u32| sum(plus(plus(0, a), e), plus(plus(0, b), d), plus(0, c));
    [sums(add_even_bytes), sums(add_odd_bytes)]
}

/// Four smoothed pixels, from the sums of their columns and of the two on either side.
#[inline(always)]
pub(super) fn smooth_four([[a, b], [c, d]]: [[u32; 2]; 2]) -> [u8; PIXELS] {
    // Columns 2 and 4, 3 and 5: those in `a` are 0 and 2, in `b` 1 and 3, in `c` 4 and 6, in `d` 5 and 7.
    let (even, odd) = (a >> 16 | c << 16, b >> 16 | d << 16);
    let (first, second) = (weighted([a, b, even, odd, c]), weighted([b, even, odd, c, d]));
    let [first, second] = [first, second].map(|sums| sums.wrapping_add(0x0080_0080));
    (first >> 8 & 0x00ff_00ff | second & 0xff00_ff00).to_le_bytes()
}

/// The weighted sums in the halves of words, at most 65280.
#[inline(always)]
fn weighted([a, b, c, d, e]: [u32; 5]) -> u32 {
    sum(a.wrapping_add(e), b.wrapping_add(d), c)
}

/// The weighted sums of the outer two, the inner two and the middle one.
#[inline(always)]
fn sum(outer: u32, inner: u32, middle: u32) -> u32 {
    outer.wrapping_add(inner.wrapping_add(middle) << 2).wrapping_add(middle << 1)
}
