//! The kernel in bytes, for cores with Arm's instructions on four bytes in a word (Cortex-M4, M7, M33): a
//! word is four candidates of a column, the smallest disparity lowest.
//!
//! In running order:
//!
//! * `census`: the codes of a row.
//! * `tables`: what every left code costs against a row's right codes, where codes have four bits.
//! * `columns`: costs into the columns under the window.
//! * `windows`: columns into windows, windows into winners.
//! * `rows`: the right codes from right to left, and the loops of both over the pixels of a row, in assembly
//!   for the usual numbers of candidates.
//! * `answers`: winners into answers; `surface`: these averaged; `speckle`: their support counted, which all
//!   methods share.
//! * `word`: what is done to four bytes.
//!
//! The compiler has no instructions on four bytes, and keeps too little in registers: the loops over pixels
//! are in assembly. A loop over two pixels in a round is entered in its middle where their number is odd.
//! Each loop is a function that stands alone (`inline(never)`). Where a loop needs more registers than
//! operands may be, or such that one instruction loads, all of them are named, and the two that are not the
//! assembly's (r6, r7) are kept on the stack.
//!
//! The work is the same for every picture, but for a few instructions where a winner is at an end of the
//! search.

mod answers;
mod census;
mod columns;
mod rows;
mod speckle;
mod surface;
mod tables;
mod windows;
mod word;

use super::scratch::{bytes_of_words as bytes_of, words_mut};
use super::{RowWork, Select, TABLE_WORDS};
use crate::matching::scheme::Around;
use crate::matching::window::{Windowed, code_bytes};
use census::census;

pub use answers::{Refused, answer, offer};
pub use speckle::judge;
pub use surface::average;
pub(super) use word::not_less;

const _: () = assert!(TABLE_WORDS == size_of::<[tables::Table; 2]>() / size_of::<u32>() + 4);

/// A row's columns and what enters and leaves them.
struct Rows<'a> {
    width: usize,
    stride: usize,
    min_disparity: usize,
    enter: Option<&'a [u8]>,
    leave: Option<&'a [u8]>,
}

/// [`super::Kernel::codes`] for bytes: where codes have four bits a pixel's two are one byte, the left one
/// low; else the left ones are before the right ones.
#[inline]
pub(super) fn codes_of<S: Windowed>([left, right]: [&Around<'_>; 2], out: &mut [u8]) {
    if S::BITS > 4 {
        let (of_left, of_right) = out.split_at_mut_checked(out.len() / 2).unwrap_or_default();
        census::<S>(left, false, of_left);
        census::<S>(right, false, of_right);
        return;
    }
    let width = out.len() / code_bytes::<S>();
    let out = out.get_mut(..width).unwrap_or_default();
    census::<S>(left, false, out);
    census::<S>(right, true, out);
}

/// [`super::Kernel::row`] in bytes.
#[inline(always)]
pub(super) fn row<S: Windowed>(work: RowWork<'_>, select: Option<Select<'_>>) {
    // The usual numbers of candidates, then any number of them.
    match work.stride {
        16 => row_of::<S, 16>(work, select),
        32 => row_of::<S, 32>(work, select),
        48 => row_of::<S, 48>(work, select),
        64 => row_of::<S, 64>(work, select),
        _ => row_of::<S, 0>(work, select),
    }
}

#[inline(always)]
fn row_of<S: Windowed, const STRIDE: usize>(work: RowWork<'_>, select: Option<Select<'_>>) {
    let RowWork { width, stride, min_disparity, enter, leave, columns, scratch } = work;
    let rows = Rows { width, stride, min_disparity, enter, leave };
    let columns = words_mut(columns);
    // The first column that a window with a candidate has.
    let begin = min_disparity.min(width).saturating_sub(S::RADIUS_X);
    if S::BITS > 4 {
        columns::update::<S, STRIDE>(&rows, begin, scratch, columns);
    } else {
        columns::update_by_tables::<STRIDE>(&rows, begin, scratch, columns);
    }
    if let Some(select) = select {
        windows::select::<S, STRIDE>(&rows, scratch, columns, select);
    }
}
