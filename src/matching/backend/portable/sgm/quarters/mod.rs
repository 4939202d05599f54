//! The passes on cores without instructions on bytes, four candidates in a word.
//!
//! * Each lane of a column's words holds a quarter of the candidates, one after the other from word to word:
//!   what is beside the candidates of a word are whole words. Only at the ends is it the next lane's.
//! * Numbers have seven bits, so that a subtraction compares four of them (`lanes`).
//! * Of a cost there is the agreement (`cost`), so that it cuts itself off.
//! * A path along the row is moved by the same number for all candidates, by as much as saves an addition.
//!   What it was moved by is taken off the winner.
//!
//! * `features`: what is compared; `others`: what it is compared with, in the order of the words; `cost`: the
//!   costs. `edges`: averaged within edges.
//! * `steps`: from pixel to pixel; `in_rounds`: the paths and the least sums; `second`: the second least;
//!   `columns`: where they stand. `rounds`: what is done to each word. `rv32`: the rows of that core.

mod columns;
mod cost;
mod edges;
mod features;
#[allow(dead_code, unused_imports, reason = "an RV32 has rows of its own")]
mod in_rounds;
mod lanes;
mod others;
mod rounds;
#[cfg(stereopsis_rv32m)]
mod rv32;
mod second;
mod steps;

use super::Passes;
use super::features::Features;
use crate::matching::backend::loops::fill_bytes;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::work::{EdgeWork, Guide, PathWork};
use crate::matching::memory::winners::{Found, Unique, Winner};
use features::WordRows;
#[cfg(not(stereopsis_rv32m))]
use in_rounds as paths;
#[cfg(stereopsis_rv32m)]
use rv32 as paths;

/// The passes over columns of up to `WORDS` words, all of them in use if `ALL`: then the compiler knows how
/// many. Costs are made with room for so many groups of right pixels, whole fours and more than a column has.
pub(super) struct Quarters<const WORDS: usize, const ALL: bool, const GROUPS: usize>;

impl<const WORDS: usize, const ALL: bool, const GROUPS: usize> Passes for Quarters<WORDS, ALL, GROUPS> {
    type Rows = WordRows;

    #[inline(always)]
    fn clear(work: &mut PathWork<'_>) {
        fill_bytes(work.costs, steps::most(work.penalties));
    }

    #[inline(always)]
    fn enter<S: SgmParameters>(work: &mut PathWork<'_>, features: &Features<'_>) {
        cost::enter::<S, WORDS, ALL, GROUPS>(work, features);
    }

    #[inline(always)]
    fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        edges::within_edges(work, edges, columns::words::<WORDS, ALL>(work));
    }

    #[inline(always)]
    fn select(
        work: &mut PathWork<'_>,
        guide: Guide<'_>,
        mut unique: Unique<'_>,
        mut put: impl FnMut(usize, Found),
    ) {
        paths::select::<WORDS, ALL>(work, guide, &mut unique, &mut put);
    }

    const SELECTS_WORDS: bool = paths::SELECTS_WORDS;

    #[inline(always)]
    fn select_words(work: &mut PathWork<'_>, guide: Guide<'_>, winners: &mut [Winner]) {
        paths::select_words::<WORDS, ALL>(work, guide, winners);
    }
}
