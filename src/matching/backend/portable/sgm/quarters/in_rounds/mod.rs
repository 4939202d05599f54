//! A row's paths and winners, pixel by pixel, whose words are gone through in `rounds`.

mod along;
mod down;
mod winners;

pub(super) use super::others::shift_in;
pub(super) use super::rounds::enter;

use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::winners::{Found, Unique, Winner};

/// Whether there is code for [`select_words`].
pub(super) const SELECTS_WORDS: bool = false;

/// See [`Passes::select`](crate::matching::backend::portable::sgm::Passes::select).
#[inline(always)]
pub(super) fn select<const WORDS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    unique: &mut Unique<'_>,
    put: &mut impl FnMut(usize, Found),
) {
    along::right::<WORDS, ALL>(work, guide);
    down::down::<WORDS, ALL>(work, guide);
    winners::left::<WORDS, ALL>(work, guide, unique, put);
}

/// There is none.
#[inline(always)]
pub(super) fn select_words<const WORDS: usize, const ALL: bool>(
    _work: &mut PathWork<'_>,
    _guide: Guide<'_>,
    _winners: &mut [Winner],
) {
}
