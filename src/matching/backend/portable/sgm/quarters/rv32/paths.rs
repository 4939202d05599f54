//! The paths through a row, and its winners.

use super::along::{along_eight, along_fours, right};
use super::down::down;
use super::left::{left, left_words};
use super::row::{Along, Row, has_eight};
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::winners::{Found, Unique, Winner};

/// Whether there is code for [`select_words`].
pub(in super::super) const SELECTS_WORDS: bool = true;

/// See [`Passes::select`](crate::matching::backend::portable::sgm::Passes::select).
#[inline(always)]
pub(in super::super) fn select<const WORDS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    unique: &mut Unique<'_>,
    put: &mut impl FnMut(usize, Found),
) {
    let row = Row::new::<WORDS, ALL>(work, guide, along_of::<WORDS, ALL>());
    right::<WORDS, ALL>(&row, work, guide);
    down::<WORDS, ALL>(&row, work, guide);
    left::<WORDS, ALL>(&row, work, guide, unique, put);
}

/// [`select`] into words, where nothing is asked of the second best.
#[inline(always)]
pub(in super::super) fn select_words<const WORDS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    winners: &mut [Winner],
) {
    let row = Row::new::<WORDS, ALL>(work, guide, along_of::<WORDS, ALL>());
    right::<WORDS, ALL>(&row, work, guide);
    down::<WORDS, ALL>(&row, work, guide);
    left_words::<WORDS, ALL>(&row, work, winners);
}

/// What takes a path along the row.
const fn along_of<const WORDS: usize, const ALL: bool>() -> Along {
    if has_eight::<WORDS, ALL>() { along_eight } else { along_fours }
}
