//! The costs of a row, added to the columns under the window.

use super::super::row_codes::{RowCodes, pixels};
use crate::matching::window::Windowed;

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
                for (sums, &new) in
                    column.as_chunks_mut::<N>().0.iter_mut().zip(candidates.as_chunks::<N>().0)
                {
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
                for (sums, &old) in
                    column.as_chunks_mut::<N>().0.iter_mut().zip(candidates.as_chunks::<N>().0)
                {
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
