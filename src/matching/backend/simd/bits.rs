//! Pixels looked at together, by a bit for each.

use crate::matching::memory::slices::part;

/// Pixels that are looked at together.
pub(super) const TOGETHER: usize = u64::BITS as usize;

/// What a row has in a block of as many pixels; behind its end `none`.
#[inline(always)]
pub(super) fn in_block<T: Copy>(row: &[T], block: usize, none: T) -> [T; TOGETHER] {
    let row = part(row, block * TOGETHER..);
    row.first_chunk().copied().unwrap_or_else(|| {
        let mut all = [none; TOGETHER];
        all.iter_mut().zip(row).for_each(|(to, from)| *to = *from);
        all
    })
}

/// A bit for each pixel that something is true of, the lowest for the first.
#[inline(always)]
pub(super) fn bits_of<T: Copy>(pixels: &[T; TOGETHER], is_true: impl Fn(T) -> bool) -> u64 {
    let mut bits = 0;
    for (i, &pixel) in pixels.iter().enumerate() {
        bits |= u64::from(is_true(pixel)) << i;
    }
    bits
}

/// Does something with the place of each bit that is set, the lowest first.
#[inline(always)]
pub(super) fn each(mut bits: u64, mut work: impl FnMut(usize)) {
    while bits != 0 {
        work(bits.trailing_zeros() as usize);
        bits &= bits - 1;
    }
}
