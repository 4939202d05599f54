//! The row in Helium, the vectors of a Cortex-M55, in assembly: what `lanes` does for 32 and for 64
//! candidates of a column (other numbers are left to the compiler), and the stages before and after it.
//!
//! * [`census`]: the codes of `fast`.
//! * [`columns`]: costs of a row added to the columns under the window, and others subtracted.
//! * [`windows`]: sums along the row, and the winner of each pixel.
//! * [`partners`]: the left-right check.
//! * [`surface`]: answers averaged within their surface, and its length.
//! * [`speckle`]: support counted.
//!
//! Of `lanes` the compiler makes two or three instructions where one is needed: it loads and stores the sums
//! of a window for every pixel, counts bits in nine instructions, and looks for the winner in a loop of its
//! own. Here
//!
//! * the window's sums stay in registers along the row;
//! * how many bits differ is looked up, by one load that takes a place for each of 16 lanes (one instruction,
//!   though a core may spend a cycle on each place). The codes of `fast` have four bits: a byte holds those
//!   of the row that enters and of the one that leaves, and the table has the difference;
//! * a loop ends with `le`, which counts and jumps, or with `letp`, which leaves out the lanes that are too
//!   many as well.
//!
//! Vectors are no operands of `asm!`: it names them, and says that they are overwritten. Of their predicate
//! the compiler cannot be told. So every function with assembly stands alone (`inline(never)`), as no
//! predicate outlives a call. Addresses of loads that widen and of stores that narrow have to be in one of
//! the first registers, which are named too.

mod census;
mod columns;
mod partners;
mod speckle;
mod surface;
mod windows;

pub use census::census_plus4;
pub use partners::keep;
pub use speckle::judge;
pub use surface::average;

use super::lanes::best_of_the_rest;
use super::scratch::{bytes_mut, bytes_of};
use super::winner::{Select, WinnerRows};
use super::{MASKS, OUTSIDE, RowWork};
use crate::matching::window::Windowed;
use windows::{Windows, complete};

/// Bytes in a vector.
const LANES: usize = 16;

/// [`super::Kernel::row`] for `STRIDE` candidates of a column.
#[inline(always)]
pub(super) fn row<S: Windowed, const STRIDE: usize>(work: RowWork<'_>, select: Option<Select<'_>>) {
    const { assert!(S::RADIUS_X < OUTSIDE) };
    let RowWork { width, min_disparity, enter, leave, columns, scratch, .. } = work;
    let room = bytes_mut(scratch);
    if let Some(inside) = columns.get_mut(OUTSIDE * STRIDE..(OUTSIDE + width) * STRIDE) {
        if S::BITS <= 4 {
            columns::of_four_bits::<STRIDE>([enter, leave], min_disparity, room, inside);
        } else {
            columns::of_eight_bits::<STRIDE>([enter, leave], min_disparity, room, inside);
        }
    }
    if let (Some(select), Some(sums)) = (select, room.get_mut(..STRIDE + 2)) {
        winners::<S, STRIDE>(columns, width, min_disparity.min(width), sums, select);
    }
}

/// The winners from column `begin` on. `sums` has room for a byte beside them on both sides.
#[inline(never)]
fn winners<S: Windowed, const STRIDE: usize>(
    columns: &[u8],
    width: usize,
    begin: usize,
    sums: &mut [u8],
    select: Select<'_>,
) {
    let Select { disparities, winners, unique } = select;
    let rows = bytes_of(winners).get_mut(begin..).unwrap_or_default();
    // The column that leaves at the first pixel is among them.
    let from = |column: usize| columns.get(column * STRIDE..).unwrap_or(&[]);
    let (leaves, enters) = (from(OUTSIDE + begin - S::RADIUS_X - 1), from(OUTSIDE + begin + S::RADIUS_X));
    let inside = sums.get_mut(1..=STRIDE).and_then(|sums| sums.first_chunk_mut::<STRIDE>());
    let columns = leaves.as_chunks::<STRIDE>().0.iter().take(2 * S::RADIUS_X + 1);
    if let Some(sums) = inside {
        let mut first = [0u8; STRIDE];
        for column in columns {
            for lane in 0..STRIDE {
                first[lane] = first[lane].wrapping_add(column[lane] >> S::COLUMN_SHIFT);
            }
        }
        *sums = first;
    }
    let judged = unique.is_asked();
    let mut judge = unique.starting_at(begin);
    let mut windows = Windows::<STRIDE> { leaves, enters, sums, rows, width };
    // The first pixels have fewer candidates than the others.
    let few = (disparities - 1).min(width - begin);
    let mut done = 0;
    while done < width - begin {
        let alike = if done < few { few - done } else { width - begin - done };
        let count = if judged { 1 } else { alike };
        let candidates = (done + 1).min(disparities);
        let mask = MASKS.get(256 - (STRIDE - candidates)..).unwrap_or(&[]);
        if candidates < STRIDE {
            windows.select::<S, true>(count, mask, usize::from(done < few));
        } else {
            windows.select::<S, false>(count, mask, 0);
        }
        done += count;
        if judged {
            let (cost, disparity) = windows.last();
            judge(cost, &mut || {
                let (mask, sums) = (mask.get(..STRIDE).unwrap_or(&[]), windows.sums.get_mut(1..=STRIDE));
                best_of_the_rest::<LANES>(usize::from(disparity), mask, sums.unwrap_or_default())
            });
        }
    }
    let WinnerRows { below, costs, above, disparities: found } = WinnerRows::of(winners, begin);
    complete([below, costs, above, found], disparities);
}
