//! The costs of a row, added to the columns under the window.

use super::row_codes::{RowCodes, pixels};
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::portable::group::Group;

/// Moves the sums of all columns one row down.
#[inline(always)]
pub(super) fn update<S: WindowParameters, G: Group>(
    stride: usize,
    enter: Option<RowCodes<'_>>,
    leave: Option<RowCodes<'_>>,
    columns: &mut [G::Cell],
) {
    let columns = columns.chunks_exact_mut(stride / G::LANES);
    match (enter.map(|row| pixels(row, stride)), leave.map(|row| pixels(row, stride))) {
        (Some(enter), Some(leave)) => {
            for (column, ((&new_code, new), (&old_code, old))) in columns.zip(enter.zip(leave)) {
                let (more, less) = (key::<S, G>(new_code), key::<S, G>(old_code));
                for (sum, (&new, &old)) in column.iter_mut().zip(G::groups(new).iter().zip(G::groups(old))) {
                    let (more, less) =
                        (apart::<S, G>(more, G::of_bytes(new)), apart::<S, G>(less, G::of_bytes(old)));
                    *sum = G::of(*sum).minus(less).plus(more).cell();
                }
            }
        }
        (Some(enter), None) => {
            for (column, (&code, candidates)) in columns.zip(enter) {
                let more = key::<S, G>(code);
                for (sum, &new) in column.iter_mut().zip(G::groups(candidates)) {
                    *sum = G::of(*sum).plus(apart::<S, G>(more, G::of_bytes(new))).cell();
                }
            }
        }
        (None, Some(leave)) => {
            for (column, (&code, candidates)) in columns.zip(leave) {
                let less = key::<S, G>(code);
                for (sum, &old) in column.iter_mut().zip(G::groups(candidates)) {
                    *sum = G::of(*sum).minus(apart::<S, G>(less, G::of_bytes(old))).cell();
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
