//! Census rows in 32-bit words: four pixels' comparisons at once.
//!
//! A neighbour `n` is not darker than the centre `c` where the average of `n` and `255 - c`, rounded up, has its highest
//! bit: `n + 255 - c + 1 >= 256`. Averages of bytes need no room beside them, `(a | b) - ((a ^ b) >> 1)` (Warren 2012,
//! 2-5).

use crate::matching::kernels::scratch::{words_mut, words_of};
use crate::matching::scheme::{Around, Scheme};

/// The highest bit of every byte.
const TOP: u32 = 0x8080_8080;

/// The word of a line in three places: two columns to the left, here, two to the right.
type Three = [u32; 3];

/// The census row of five lines, if all of them and the codes lie in whole words; `false` if not.
#[inline(never)]
pub(in crate::matching::kernels) fn census<S: Scheme>(rows: &Around<'_>, out: &mut [u8]) -> bool {
    let width = out.len();
    let line = |row: usize| rows.get(row).and_then(|r| r.get(..width)).map_or(&[][..], words_of);
    let (above, here, below, out) = (line(0), line(2), line(4), words_mut(out));
    if [above, here, below].iter().any(|words| words.len() * 4 != width) || out.len() * 4 != width {
        return false;
    }
    // Columns outside the line are the nearest inside it.
    let lines = [above, here, below];
    let mut before = lines.map(|line| line.first().map_or(0, |first| (first & 0xff) * 0x0101_0101));
    let mut centre = lines.map(|line| line.first().copied().unwrap_or(0));
    let last = lines.map(|line| line.last().map_or(0, |last| (last >> 24) * 0x0101_0101));
    let mut next = |after: Three| {
        let places = |i: usize| [centre[i] << 16 | before[i] >> 16, centre[i], centre[i] >> 16 | after[i] << 16];
        let codes = S::codes(&[places(0), places(1), places(2)]);
        (before, centre) = (centre, after);
        codes
    };
    let Some((out_last, out)) = out.split_last_mut() else { return true };
    let [above, here, below] = lines.map(|line| line.get(1..).unwrap_or(&[]));
    for (out, ((&above, &here), &below)) in out.iter_mut().zip(above.iter().zip(here).zip(below)) {
        *out = next([above, here, below]);
    }
    *out_last = next(last);
    true
}

/// The codes of four pixels, bit `i` from the neighbour `neighbours[i]`: its row and column among `around`.
#[inline(always)]
pub(in crate::matching) fn codes<const BITS: usize>(around: &[Three; 3], neighbours: &[(usize, usize); BITS]) -> u32 {
    let inverse = !around[1][1];
    let mut not_darker = 0;
    for &(row, column) in neighbours {
        let n = around[row][column];
        let average = (n | inverse).wrapping_sub((n ^ inverse) >> 1 & !TOP);
        not_darker = not_darker >> 1 | average & TOP;
    }
    (!not_darker >> (8 - BITS)) & ((0xff >> (8 - BITS)) * 0x0101_0101)
}
