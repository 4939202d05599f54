//! The costs of a row, added to the columns under the window.

use super::super::groups::Group;
use super::super::row_codes::{RowCodes, pixels};
use crate::matching::window::Windowed;

/// Moves the sums of all columns one row down.
#[inline(always)]
pub(super) fn update<S: Windowed, G: Group>(
    stride: usize,
    enter: Option<RowCodes<'_>>,
    leave: Option<RowCodes<'_>>,
    columns: &mut [G::Cell],
) {
    let columns = columns.chunks_exact_mut(stride / G::LANES);
    match (enter.map(|row| pixels(row, stride)), leave.map(|row| pixels(row, stride))) {
        (Some(enter), Some(leave)) => {
            for (column, ((&new_code, new), (&old_code, old))) in columns.zip(enter.zip(leave)) {
                let (more, less) = (S::key::<G>(new_code), S::key::<G>(old_code));
                for (sum, (&new, &old)) in column.iter_mut().zip(G::groups(new).iter().zip(G::groups(old))) {
                    let (more, less) = (S::apart(more, G::of_bytes(new)), S::apart(less, G::of_bytes(old)));
                    *sum = G::of(*sum).minus(less).plus(more).cell();
                }
            }
        }
        (Some(enter), None) => {
            for (column, (&code, candidates)) in columns.zip(enter) {
                let more = S::key::<G>(code);
                for (sum, &new) in column.iter_mut().zip(G::groups(candidates)) {
                    *sum = G::of(*sum).plus(S::apart(more, G::of_bytes(new))).cell();
                }
            }
        }
        (None, Some(leave)) => {
            for (column, (&code, candidates)) in columns.zip(leave) {
                let less = S::key::<G>(code);
                for (sum, &old) in column.iter_mut().zip(G::groups(candidates)) {
                    *sum = G::of(*sum).minus(S::apart(less, G::of_bytes(old))).cell();
                }
            }
        }
        (None, None) => {}
    }
}
