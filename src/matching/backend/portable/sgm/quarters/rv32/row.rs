//! What assembly takes of a row.

use crate::matching::backend::portable::sgm::quarters::columns::words;
use crate::matching::backend::portable::sgm::quarters::steps::{Steps, most};
use crate::matching::backend::work::{Guide, PathWork};
use core::mem::offset_of;

/// What gives the bits below the top one of each lane, as the upper half of a product.
pub(super) const BELOW: u32 = 0u32.wrapping_sub(1 << (32 - 7));

/// The pixels that a path goes through, from left to right, and where it is.
pub(super) struct Pixels {
    pub here: *const u8,
    /// Where the kinds of the changes go, times eight.
    pub kinds: *mut u8,
    pub costs: *const u32,
    /// The column before.
    pub from: *const u32,
    /// The first pixel's column, behind which are those of the others.
    pub to: *mut u32,
    /// The brightness before.
    pub before: u8,
    /// The least of the column before.
    pub least: u32,
}

/// Takes a path through so many pixels; returns the least of the last one's column.
pub(super) type Along = unsafe fn(&Row, Pixels, usize) -> u32;

/// Whether all columns are known to have eight words.
pub(super) const fn has_eight<const WORDS: usize, const ALL: bool>() -> bool {
    ALL && WORDS == 8
}

/// What assembly takes of a row.
#[repr(C)]
pub(super) struct Row {
    pub steps: Steps,
    /// Bytes of a column.
    pub size: usize,
    /// From the end of a column to where the next pixel's begins, on the way down.
    pub skip: isize,
    /// From a pixel to the next one there.
    pub pixel: isize,
    /// What the sums of two paths along the row have more than their costs, and twice what jumps cost.
    pub more: u32,
    /// What takes a path along the row through columns of that size.
    pub along: Along,
}

/// Where the costs of the largest changes stand in a row: of the others so many bytes before, as `kind` says.
pub(super) const CHANGES: usize = offset_of!(Row, steps) + offset_of!(Steps, changes) + 16;
/// What a jump costs in it.
pub(super) const JUMPS: usize = CHANGES + 4;

impl Row {
    /// Of columns of up to `WORDS` words, all of them in use if `ALL`.
    #[inline(always)]
    pub fn new<const WORDS: usize, const ALL: bool>(
        work: &PathWork<'_>,
        guide: Guide<'_>,
        along: Along,
    ) -> Self {
        let count = words::<WORDS, ALL>(work);
        let (size, is_odd) = (4 * count, !guide.row.is_multiple_of(2));
        Self {
            steps: Steps::new(work.penalties, count),
            size,
            skip: if is_odd { -2 * size as isize } else { 0 },
            pixel: if is_odd { -1 } else { 1 },
            more: 2 * (128 - u32::from(most(work.penalties))),
            along,
        }
    }
}
