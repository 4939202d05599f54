//! The costs of a row, added to the columns under the window.

use super::row_codes::{RowCodes, pixels};
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::portable::candidates::Candidates;
use crate::matching::backend::portable::group::Group;

/// Moves the sums of all columns one row down.
#[inline(always)]
pub(super) fn update<S: WindowParameters, G: Group, const CELLS: usize, const SLIDES: bool>(
    stride: usize,
    enter: Option<RowCodes<'_>>,
    leave: Option<RowCodes<'_>>,
    columns: &mut [G::Cell],
) {
    let columns = columns.chunks_exact_mut(stride / G::LANES);
    let candidates = |row: RowCodes<'_>| Candidates::<G, CELLS, SLIDES>::new(row.right, stride);
    match (enter, leave) {
        (Some(enter), Some(leave)) => {
            // One is moved in registers, the other read anew: a processor does both at a time.
            let mut news = candidates(enter);
            let mut olds = Candidates::<G, CELLS, false>::new(leave.right, stride);
            let rows = pixels(enter, stride).zip(pixels(leave, stride));
            for (column, ((&new_code, new), (&old_code, old))) in columns.zip(rows) {
                let (more, less) = (key::<S, G>(new_code), key::<S, G>(old_code));
                for (sum, (&new, &old)) in column.iter_mut().zip(news.next(new).iter().zip(olds.next(old))) {
                    let (more, less) = (apart::<S, G>(more, new), apart::<S, G>(less, old));
                    *sum = G::of(*sum).minus(less).plus(more).cell();
                }
            }
        }
        (Some(enter), None) => {
            let mut news = candidates(enter);
            for (column, (&code, new)) in columns.zip(pixels(enter, stride)) {
                let more = key::<S, G>(code);
                for (sum, &new) in column.iter_mut().zip(news.next(new)) {
                    *sum = G::of(*sum).plus(apart::<S, G>(more, new)).cell();
                }
            }
        }
        (None, Some(leave)) => {
            let mut olds = candidates(leave);
            for (column, (&code, old)) in columns.zip(pixels(leave, stride)) {
                let less = key::<S, G>(code);
                for (sum, &old) in column.iter_mut().zip(olds.next(old)) {
                    *sum = G::of(*sum).minus(apart::<S, G>(less, old)).cell();
                }
            }
        }
        (None, None) => {}
    }
}

/// What a code is compared by with [`apart`].
#[inline(always)]
fn key<S: WindowParameters, G: Group>(code: u8) -> G {
    if S::BITS <= 4 { G::key_of_four(code) } else { G::splat(code) }
}

/// How many bits of a code, whose key this is, and of others differ.
#[inline(always)]
fn apart<S: WindowParameters, G: Group>(key: G, others: G) -> G {
    if S::BITS <= 4 { key.four_bits_apart(others) } else { key.bits_apart(others) }
}

/// The digits of columns' sums that a window adds up.
#[inline(always)]
pub(super) fn digits<S: WindowParameters, G: Group>(columns: G) -> G {
    const { assert!(S::COLUMN_SHIFT == 0 || S::COLUMN_SHIFT == 2, "all digits, or quarters") };
    if S::COLUMN_SHIFT == 0 { columns } else { columns.quarter() }
}
