//! A row's codes, as kernels in vectors read them.

use crate::matching::memory::slices::{part, part_mut, split_mut};

/// The codes of a row in both images.
#[derive(Clone, Copy)]
pub(super) struct RowCodes<'a> {
    left: &'a [u8],
    pub(super) right: &'a [u8],
}

/// The code of every column with the codes that it is compared with, the farthest first.
#[inline(always)]
pub(super) fn pixels(row: RowCodes<'_>, stride: usize) -> impl Iterator<Item = (&u8, &[u8])> {
    row.left.iter().zip(row.right.windows(stride))
}

/// The row with more before its right codes: column x is compared with `stride` of them from x on. The first
/// code is repeated for those that lie left of the image.
#[inline(always)]
pub(super) fn with_more_before<'a>(
    codes: &'a [u8],
    min_disparity: usize,
    stride: usize,
    out: &'a mut [u8],
) -> RowCodes<'a> {
    let half = codes.len() / 2;
    let (left, right) = (part(codes, ..half), part(codes, half..));
    // One more than is wanted, so that words are copied to words' places.
    let out = part_mut(out, ..left.len() + stride);
    let outside = out.len().min(stride + min_disparity);
    let (before, inside) = split_mut(out, outside);
    before.fill(right.first().copied().unwrap_or(0));
    for (inside, code) in inside.iter_mut().zip(right) {
        *inside = *code;
    }
    RowCodes { left, right: part(out, 1..) }
}
