//! Edges of a line, four pixels at a time: a gradient looks at the sums down the columns on both sides, of
//! which two are in a word.

use crate::matching::backend::loops::keep_scalar_loop;
use crate::matching::backend::work::FatteningWork;

/// Moves the columns' bits one row on and puts in those of the middle one of three lines, where Sobel's
/// gradient along the line is `least` or more. Beside a line its last pixel stands.
#[inline(never)]
pub(in crate::matching::backend) fn push(edges: &mut [u8], lines: [&[u8]; 3], least: u16) {
    let last = edges.len().saturating_sub(1);
    let [above, line, below] = lines;
    let fours = above.as_chunks().0.iter().zip(line.as_chunks().0).zip(below.as_chunks().0);
    let mut fours = fours.map(|((&above, &line), &below)| sums_of_four([above, line, below]));
    let (inner, _) = edges.get_mut(1..).unwrap_or_default().as_chunks_mut();
    let mut done = 1;
    if let Some(mut sums) = fours.next() {
        for (edges, next) in inner.iter_mut().zip(fours) {
            keep_scalar_loop();
            let moved = u32::from_le_bytes(*edges) << 1 & splat(!(FatteningWork::REFUSED | 1));
            *edges = (moved | are_edges(sums, next, least)).to_le_bytes();
            (sums, done) = (next, done + 4);
        }
    }
    let mut x = 0;
    while x <= last {
        keep_scalar_loop();
        push_at(edges, lines, x, least);
        x = done.max(x + 1);
    }
}

/// Moves the bits of column `x` one row on.
#[inline(always)]
pub(in crate::matching::backend) fn push_at(edges: &mut [u8], lines: [&[u8]; 3], x: usize, least: u16) {
    let last = edges.len().saturating_sub(1);
    if let Some(edges) = edges.get_mut(x) {
        let is_edge = sum(&lines, last.min(x + 1)).abs_diff(sum(&lines, x.saturating_sub(1))) >= least;
        *edges = (*edges << 1 & !FatteningWork::REFUSED) | u8::from(is_edge);
    }
}

/// The sum down a column, the middle line's twice.
#[inline(never)]
fn sum(lines: &[&[u8]; 3], column: usize) -> u16 {
    let [above, line, below] = lines.map(|line| u16::from(line.get(column).copied().unwrap_or(0)));
    above + 2 * line + below
}

/// A byte four times.
const fn splat(byte: u8) -> u32 {
    byte as u32 * 0x0101_0101
}

/// The sums down four columns, the middle line's twice: those of the even columns, and of the odd ones, the
/// first in the lower half.
#[inline(always)]
fn sums_of_four(lines: [[u8; 4]; 3]) -> [u32; 2] {
    const EVEN: u32 = 0x00ff_00ff;
    let [above, line, below] = lines.map(u32::from_le_bytes);
    let odd = |word: u32| word >> 8 & EVEN;
    [(above & EVEN) + 2 * (line & EVEN) + (below & EVEN), odd(above) + 2 * odd(line) + odd(below)]
}

/// Where the last three columns and the first of the next four are edges: a byte for each, 1 or 0.
#[inline(always)]
fn are_edges(sums: [u32; 2], next: [u32; 2], least: u16) -> u32 {
    /// Stands above all sums in both halves.
    const BIT: u32 = 0x4000_4000;
    let least = u32::from(least) * 0x0001_0001;
    let apart = |sums: u32, next: u32| {
        // The columns after the pixels, less those before, moved up so that what is no edge is from `BIT` on,
        // and as far from the other end.
        let apart = (sums >> 16 | next << 16) + (BIT + least - 0x0001_0001) - sums;
        apart & (2 * BIT - 0x0002_0002 + 2 * least).wrapping_sub(apart)
    };
    let ([even, odd], [next_even, next_odd]) = (sums, next);
    let (second, third) = (apart(even, next_even), apart(odd, next_odd));
    // The pixels between even columns are first and third, those between odd ones second and fourth.
    !second >> 14 & 0x0001_0001 | !third >> 6 & 0x0100_0100
}
