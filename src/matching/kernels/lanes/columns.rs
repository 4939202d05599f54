//! The costs of a row, added to the columns under the window.

use crate::matching::window::Windowed;

/// The codes of a row in both images.
#[derive(Clone, Copy)]
pub(super) struct RowCodes<'a> {
    left: &'a [u8],
    right: &'a [u8],
}

/// The code of every column with the codes that it is compared with, the farthest first.
#[inline(always)]
fn pixels(row: RowCodes<'_>, stride: usize) -> impl Iterator<Item = (&u8, &[u8])> {
    row.left.iter().zip(row.right.windows(stride))
}

/// Moves the sums of all columns one row down.
#[inline(always)]
pub(super) fn update<S: Windowed, const N: usize>(
    stride: usize,
    enter: Option<RowCodes<'_>>,
    leave: Option<RowCodes<'_>>,
    columns: &mut [u8],
) {
    let columns = columns.chunks_exact_mut(stride);
    // Groups are taken and put as values, so that the compiler need not ask whether the slices overlap.
    match (enter.map(|row| pixels(row, stride)), leave.map(|row| pixels(row, stride))) {
        (Some(enter), Some(leave)) => {
            for (column, ((&new_code, new), (&old_code, old))) in columns.zip(enter.zip(leave)) {
                let codes = new.as_chunks::<N>().0.iter().zip(old.as_chunks::<N>().0);
                for (sums, (&new, &old)) in column.as_chunks_mut::<N>().0.iter_mut().zip(codes) {
                    let mut group = *sums;
                    for i in 0..N {
                        let (more, less) = (S::hamming(new_code, new[i]), S::hamming(old_code, old[i]));
                        group[i] = group[i].wrapping_add(more).wrapping_sub(less);
                    }
                    *sums = group;
                }
            }
        }
        (Some(enter), None) => {
            for (column, (&code, candidates)) in columns.zip(enter) {
                for (sums, &new) in column.as_chunks_mut::<N>().0.iter_mut().zip(candidates.as_chunks::<N>().0) {
                    let mut group = *sums;
                    for i in 0..N {
                        group[i] = group[i].wrapping_add(S::hamming(code, new[i]));
                    }
                    *sums = group;
                }
            }
        }
        (None, Some(leave)) => {
            for (column, (&code, candidates)) in columns.zip(leave) {
                for (sums, &old) in column.as_chunks_mut::<N>().0.iter_mut().zip(candidates.as_chunks::<N>().0) {
                    let mut group = *sums;
                    for i in 0..N {
                        group[i] = group[i].wrapping_sub(S::hamming(code, old[i]));
                    }
                    *sums = group;
                }
            }
        }
        (None, None) => {}
    }
}

/// The row with more before its right codes: column x is compared with `stride` of them from x on. The first code is
/// repeated for those that lie left of the image.
#[cfg_attr(stereopsis_vectors, inline(never))]
#[cfg_attr(not(stereopsis_vectors), inline(always))]
pub(super) fn with_more_before<'a>(
    codes: &'a [u8],
    min_disparity: usize,
    stride: usize,
    out: &'a mut [u8],
) -> RowCodes<'a> {
    let (left, right) = codes.split_at_checked(codes.len() / 2).unwrap_or_default();
    // One more than is wanted, so that words are copied to words' places.
    let out = out.get_mut(..left.len() + stride).unwrap_or_default();
    let outside = out.len().min(stride + min_disparity);
    let (before, inside) = out.split_at_mut_checked(outside).unwrap_or_default();
    before.fill(right.first().copied().unwrap_or(0));
    for (inside, code) in inside.iter_mut().zip(right) {
        *inside = *code;
    }
    RowCodes { left, right: out.get(1..).unwrap_or(&[]) }
}
