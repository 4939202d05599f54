//! Census rows in 32-bit words: four pixels' comparisons at once.
//!
//! A neighbour `n` is not darker than the centre `c` where the average of `n` and `255 - c`, rounded up, has
//! its highest bit: `n + 255 - c + 1 >= 256`. Averages of bytes need no room beside them, `(a | b) - ((a ^ b)
//! >> 1)` (Warren 2012, 2-5).

use crate::matching::backend::parameters::WindowParameters;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::{view, view_mut};

/// The highest bit of every byte.
const TOP: u32 = 0x8080_8080;

/// The word of a line in three places: two columns to the left, here, two to the right.
pub(in crate::matching::backend) type Three = [u32; 3];

/// The census row of five lines.
#[inline(never)]
pub(in crate::matching::backend) fn census<S: WindowParameters>(rows: &Rows5<'_>, out: &mut [u8]) {
    let width = out.len();
    let [above, _, here, _, below] = *rows;
    let lines = [above, here, below].map(|line| part(line, ..width));
    let in_words = |bytes: &[u8]| view::<u8, u32>(bytes).len() * 4 == width;
    if in_words(out) && lines.into_iter().all(in_words) {
        census_of_words::<S>(lines.map(view::<u8, u32>), view_mut::<u8, u32>(out));
        census_of_bytes::<S>(lines, out, (width / 4).saturating_sub(1));
    } else {
        census_of_bytes::<S>(lines, out, 0);
    }
}

/// The census row of lines that are not all in whole words, as those whose width is no multiple of four: of
/// the groups of four pixels from the `first` on.
#[inline(never)]
pub(in crate::matching::backend) fn census_of_bytes<S: WindowParameters>(
    lines: [&[u8]; 3],
    out: &mut [u8],
    first: usize,
) {
    for (group, out) in (first..).zip(part_mut(out, 4 * first..).chunks_mut(4)) {
        let x = 4 * group;
        let codes = codes::<S>(&lines.map(|line| [0, 2, 4].map(|place| word(line, x + place))));
        for (out, code) in out.iter_mut().zip(codes.to_le_bytes()) {
            *out = code;
        }
    }
}

/// The pixels from two left of `x` to one right of it; outside the line the nearest inside it.
#[inline(never)]
fn word(line: &[u8], x: usize) -> u32 {
    if let Some(&inside) = x.checked_sub(2).and_then(|x| line.get(x..)).and_then(|line| line.first_chunk()) {
        return u32::from_le_bytes(inside);
    }
    let last = line.len().saturating_sub(1);
    let pixel = |x: usize| line.get(x.saturating_sub(2).min(last)).copied().unwrap_or(0);
    (x..x + 4).fold(0, |word, x| word >> 8 | u32::from(pixel(x)) << 24)
}

/// The census row of lines in whole words, but for the last one.
#[inline(always)]
fn census_of_words<S: WindowParameters>(lines: [&[u32]; 3], out: &mut [u32]) {
    // Columns outside the line are the nearest inside it.
    let mut before = lines.map(|line| line.first().map_or(0, |first| (first & 0xff) * 0x0101_0101));
    let mut centre = lines.map(|line| line.first().copied().unwrap_or(0));
    // Rows are taken apart, not indexed: no optimiser has to prove that a row is there.
    let mut next = |after: Three| {
        let places = |before: u32, centre: u32, after: u32| {
            [centre << 16 | before >> 16, centre, centre >> 16 | after << 16]
        };
        let ([b0, b1, b2], [c0, c1, c2], [a0, a1, a2]) = (before, centre, after);
        let codes = codes::<S>(&[places(b0, c0, a0), places(b1, c1, a1), places(b2, c2, a2)]);
        (before, centre) = (centre, after);
        codes
    };
    let [above, here, below] = lines.map(|line| part(line, 1..));
    for (out, ((&above, &here), &below)) in out.iter_mut().zip(above.iter().zip(here).zip(below)) {
        *out = next([above, here, below]);
    }
}

/// The codes of four pixels, from the words around them: rows, and columns two to the left, here, two to the
/// right. The neighbours are those of [`census_plus4`](crate::imaging::census_plus4) and
/// [`census_ring8`](crate::imaging::census_ring8) in order of their bits, two rows and columns to a step.
#[inline(always)]
pub(in crate::matching::backend) fn codes<S: WindowParameters>(around: &[Three; 3]) -> u32 {
    let &[[a, b, c], [d, centre, e], [f, g, h]] = around;
    if S::BITS <= 4 { codes_of(centre, [b, d, e, g]) } else { codes_of(centre, [a, b, c, d, e, f, g, h]) }
}

/// The codes of four pixels, bit `i` from the neighbour `neighbours[i]`.
#[inline(always)]
fn codes_of<const BITS: usize>(centre: u32, neighbours: [u32; BITS]) -> u32 {
    let inverse = !centre;
    let mut not_darker = 0;
    for n in neighbours {
        let first = (n | inverse).wrapping_sub((n ^ inverse) >> 1 & !TOP) & TOP;
        not_darker = not_darker >> 1 | first;
    }
    (!not_darker >> (8 - BITS)) & ((0xff >> (8 - BITS)) * 0x0101_0101)
}
