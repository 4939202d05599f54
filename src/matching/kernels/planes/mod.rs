//! The kernel in bit planes, for cores without vectors: 32 candidates are the bits of a word, and a number for each of them
//! is as many words as it has bits. Additions are chains of full adders, bit by bit; comparisons go from the highest plane
//! down. Safe Rust; the arithmetic is that of plain words.
//!
//! * `census`: four pixels of a row at a time.
//! * `columns`: the bits in which codes differ, counted into the columns under the window.
//! * `windows`: columns into windows, windows into winners.
//! * `plane`: the word itself.
//!
//! The work is the same for every picture, but for some ten instructions where a winner is at an end of the search.

mod census;
mod columns;
mod plane;
mod windows;

use super::{Found, OUTSIDE, RowWork, Select, Winner};
use crate::matching::scheme::Scheme;
use plane::Plane;
use windows::{WINDOW, Windows};

pub(super) use census::census;
pub(in crate::matching) use census::codes;
pub(super) use columns::prepare;

/// Winners handed on at a time.
const BATCH: usize = 16;

/// The sums of a column, lowest plane first: a place for each eighth of its bytes, of which the last are free.
type Column<P> = [P; 8];

/// [`super::Kernel::row`] in planes.
#[inline(always)]
pub(super) fn row<S: Scheme>(work: RowWork<'_>, select: Option<Select>, found: Found<'_>) {
    // The usual numbers of candidates, then any number of words of them, or of half-words.
    match work.stride {
        16 => row_of::<S, u16, 1>(work, select, found),
        32 => row_of::<S, u32, 1>(work, select, found),
        64 => row_of::<S, u32, 2>(work, select, found),
        stride if !stride.is_multiple_of(32) && stride > 32 => row_of::<S, u16, 0>(work, select, found),
        stride if stride > 64 => row_of::<S, u32, 0>(work, select, found),
        _ => {}
    }
}

/// A row whose candidates are `GROUPS` words of them; 0 where the number is not known when the crate is compiled.
#[inline(always)]
fn row_of<S: Scheme, P: Plane, const GROUPS: usize>(work: RowWork<'_>, select: Option<Select>, found: Found<'_>) {
    let RowWork { width, stride, min_disparity, enter, leave, columns, scratch } = work;
    // At least one, for the compiler to see that no column is empty.
    let groups = if GROUPS > 0 { GROUPS } else { (stride / P::CANDIDATES).max(1) };
    let columns = P::of_bytes(columns).as_chunks_mut::<8>().0;
    let scratch = P::of_words(scratch);
    if let Some(inside) = columns.get_mut(OUTSIDE * groups..) {
        columns::update::<S, P, GROUPS>(width, groups, min_disparity, [enter, leave], scratch, inside);
    }
    let Some(select) = select else { return };

    // Left of here no pixel has a candidate.
    let begin = min_disparity.min(width);
    let mut batch = [Winner::default(); BATCH];
    for first in (0..begin).step_by(BATCH) {
        found(batch.get(..BATCH.min(begin - first)).unwrap_or(&[]));
    }
    let Some(windows) = scratch.as_chunks_mut::<WINDOW>().0.get_mut(..groups) else { return };
    let mut windows = Windows::new(windows, select);
    // What is farther to the left is no candidate's: its sums are zero.
    let (before, after) = (begin.saturating_sub(S::RADIUS_X), begin + S::RADIUS_X);
    for column in columns.chunks_exact(groups).take(OUTSIDE + after).skip(OUTSIDE + before) {
        windows.slide::<S>(column, columns);
    }
    let size = (BATCH * groups).max(1);
    let from = |column: usize| columns.get(column * groups..).unwrap_or(&[]).chunks(size);
    let (mut entering, mut leaving) = (from(OUTSIDE + after), from(OUTSIDE + begin - S::RADIUS_X - 1));
    for first in (begin..width).step_by(BATCH) {
        let (Some(entering), Some(leaving)) = (entering.next(), leaving.next()) else { return };
        let batch = batch.get_mut(..BATCH.min(width - first)).unwrap_or_default();
        if GROUPS > 0 {
            windows.winners::<S, GROUPS>(entering, leaving, batch);
        } else {
            windows.winners_of_many::<S>(entering, leaving, batch);
        }
        found(batch);
    }
}
