//! The columns of a volume.

use crate::matching::backend::work::{PathWork, STEP};

/// Words that are worked on in a round: a column has whole fours of them.
pub(super) const FOUR: usize = STEP / size_of::<u32>();

/// Words of a column, at least four.
#[inline(always)]
pub(super) fn words<const WORDS: usize, const ALL: bool>(work: &PathWork<'_>) -> usize {
    if ALL { WORDS } else { work.stride.max(STEP) / size_of::<u32>() }
}

/// The words of the column that begins at a place; none where it is not there.
#[inline(always)]
pub(super) fn column<C>(volume: &[C], place: usize, count: usize) -> Option<&[C]> {
    volume.get(place..place.wrapping_add(count))
}
