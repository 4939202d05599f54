//! The passes on cores with Arm's instructions on four bytes (`--cfg stereopsis_dsp`: Cortex-M4, M7, and M33
//! with its extension): the same numbers as `portable::words` has, in fewer instructions.
//!
//! * A path stays in memory, between two words that no path comes from: what stands beside a disparity is the
//!   same word one byte off. A path's two pixels take turns in two places.
//! * Of a cost there is the agreement, the most that it may be less what it is: a saturating subtraction cuts
//!   it off, and the halving addition, which rounds down, rounds the cost up.
//! * Lanes beyond the search agree so little that no path from there is the least.
//!
//! * `rows`: the paths through a row; `changes`: what they pay; `walk`: their loops, in assembler.
//! * `blocks`: the other loops over a pixel's words, in assembler.
//! * `winners`: the least of the paths' sums.
//! * `features`: what is compared, four pixels at a time.
//! * `edges`: how far a row's costs are averaged with others.

mod blocks;
mod changes;
mod edges;
mod features;
mod rows;
mod walk;
mod winners;

use crate::matching::backend::loops::fill_bytes;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features::Features;
use crate::matching::backend::portable::sgm::{Passes, words};
use crate::matching::backend::work::{CostWork, EdgeWork, Guide, PathWork, STEP};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::{Found, Select, Unique, Winner};
use crate::matching::penalties::Penalties;
use features::DspRows;
use rows::Direction;

/// The passes over columns of up to `WORDS` words, all of them in use if `ALL`: then the compiler knows how
/// many.
pub(super) struct Words<const WORDS: usize, const ALL: bool>;

impl<const WORDS: usize, const ALL: bool> Passes for Words<WORDS, ALL> {
    type Rows = DspRows;

    #[inline(always)]
    fn clear(work: &mut PathWork<'_>) {
        fill_bytes(work.costs, work.penalties.cost);
    }

    #[inline(always)]
    fn enter<S: SgmParameters>(work: &mut PathWork<'_>, features: &Features<'_>) {
        let Features { left, right, count } = *features;
        let stride = stride::<WORDS, ALL>(work);
        let left = [left.along, left.across, left.census, left.brightness];
        let costs = view_mut::<u8, u32>(work.costs);
        blocks::enter::<S>(costs, stride, left, right, count, splat(work.penalties.cost));
        work.close(stride, beyond_search(work.penalties));
    }

    #[inline(always)]
    fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        edges::within_edges(work, stride::<WORDS, ALL>(work), edges);
    }

    #[inline(always)]
    fn select(work: &mut PathWork<'_>, guide: Guide<'_>, unique: Unique<'_>, put: impl FnMut(usize, Found)) {
        paths::<WORDS, ALL>(work, guide);
        winners::select(work, stride::<WORDS, ALL>(work), unique, put);
    }

    const SELECTS_WORDS: bool = true;

    #[inline(always)]
    fn select_words(work: &mut PathWork<'_>, guide: Guide<'_>, winners: &mut [Winner]) {
        paths::<WORDS, ALL>(work, guide);
        winners::select_words(work, stride::<WORDS, ALL>(work), winners);
    }
}

/// Takes the paths through a row, and adds them up.
#[inline(never)]
fn paths<const WORDS: usize, const ALL: bool>(work: &mut PathWork<'_>, guide: Guide<'_>) {
    rows::down::<WORDS, ALL>(work, guide);
    rows::along::<WORDS, ALL>(work, guide, Direction::Right);
    rows::along::<WORDS, ALL>(work, guide, Direction::Left);
}

/// Bytes of a column.
#[inline(always)]
fn stride<const WORDS: usize, const ALL: bool>(work: &PathWork<'_>) -> usize {
    if ALL { 4 * WORDS } else { work.stride.max(STEP).min(4 * WORDS) }
}

/// A byte four times.
#[inline(always)]
fn splat(number: u8) -> u32 {
    u32::from(number) * 0x0101_0101
}

/// A cost from which no path comes: a step from there costs no less than a jump.
fn far(penalties: &Penalties) -> u8 {
    127u8.saturating_sub(penalties.step[0])
}

/// An agreement so small that a path's cost there is no less than that.
fn beyond_search(penalties: &Penalties) -> u8 {
    penalties.cost.wrapping_sub(far(penalties))
}

/// Calls a pass with words, of which there is room for so many in a column, and whether all of a column is
/// used. Each is a function of its own, so that a firmware is linked without those for numbers of disparities
/// that cannot be asked for.
macro_rules! in_words {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            0 => (),
            16 if MOST == 0 || MOST == 16 => words::$pass::<Words<4, true>, $($more)?>($work, $($argument),*),
            32 if MOST == 0 || MOST == 32 => words::$pass::<Words<8, true>, $($more)?>($work, $($argument),*),
            64 if MOST == 0 || MOST == 64 => {
                words::$pass::<Words<16, true>, $($more)?>($work, $($argument),*)
            }
            128 if MOST == 0 => words::$pass::<Words<32, true>, $($more)?>($work, $($argument),*),
            // Room for as few as will do: a path's costs stand on the stack, several times.
            ..64 if MOST == 0 => words::$pass::<Words<16, false>, $($more)?>($work, $($argument),*),
            ..128 if MOST == 0 => words::$pass::<Words<32, false>, $($more)?>($work, $($argument),*),
            _ if MOST == 0 => words::$pass::<Words<64, false>, $($more)?>($work, $($argument),*),
            _ => (),
        }
    };
}

/// [`Isa::sgm_cost`](crate::matching::backend::Isa::sgm_cost) for each number of candidates.
#[inline(always)]
pub(in crate::matching::backend) fn cost<S: SgmParameters, const MOST: usize>(
    work: &mut PathWork<'_>,
    row: CostWork<'_>,
) {
    in_words!(work, enter, [S], row);
}

/// [`Isa::sgm_within_edges`](crate::matching::backend::Isa::sgm_within_edges) for each number of candidates.
#[inline(always)]
pub(in crate::matching::backend) fn within_edges<const MOST: usize>(
    work: &mut PathWork<'_>,
    edges: EdgeWork<'_>,
) {
    in_words!(work, within_edges, [], edges);
}

/// [`Isa::sgm_select`](crate::matching::backend::Isa::sgm_select) for each number of candidates.
#[inline(always)]
pub(in crate::matching::backend) fn select<const ROWS: bool, const MOST: usize>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    select: Select<'_>,
) {
    in_words!(work, select, [ROWS], guide, select);
}
