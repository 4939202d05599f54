//! The costs along paths, and their winners: semi-global matching (Hirschmüller 2008) on lines as they come,
//! with three paths into a pixel, from the left, from the right and from above (the average of the two beside
//! it, two columns off).
//!
//! A pixel's candidates are bytes side by side; the largest disparity comes first, so that they stand in
//! memory as they do in the right image. A row takes these passes:
//!
//! ```text
//! enter  (all columns):      a[d] = average(a[d], pixel cost[d]), with row y + 1
//!   within edges (if so):    a[d] = average of the column's pixel costs around row y, with row y + 2
//! select (to the right):     t[d] = a[d] + message(t of row y - 1)[d],  r[d] = a[d] + message(r)[d]
//!        (to the left):      l[d] = a[d] + message(l)[d]
//!        (where both were):  s[d] = r[d] + t[d] + l[d],  winner: the least s[d]
//!
//! message(p)[d] = min(p[d], p[d - 1] + step, p[d + 1] + step, least p + jump) - least p
//! ```
//!
//! Everything fits bytes: see [`Penalties`](crate::matching::Penalties). Kept from row to row are a, t and
//! the room for s; within edges, two more.
//!
//! * `features`: what a pixel's cost compares, of a row of both images; `features_by_four`: four pixels.
//! * `edges`: how far a row's costs are averaged with others.
//! * `passes`: the passes, for vectors; `quarters`: for cores without.
//!
//! The work is the same for every picture, but for some instructions where a winner is at an end of the
//! search.

pub(in crate::matching::backend) mod edges;
pub(in crate::matching::backend) mod features;
pub(in crate::matching::backend) mod features_by_four;
pub(in crate::matching::backend) mod passes;
mod quarters;

use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::work::{CostWork, EdgeWork, Guide, PathWork};
use crate::matching::memory::winners::{Found, Select, Unique, Winner, WinnerRows};
use features::{FeatureRows, Features};
use quarters::Quarters;

/// The passes of a row. What they keep from row to row they keep in a form of their own.
pub(in crate::matching::backend) trait Passes {
    /// How the features of a row are made.
    type Rows: FeatureRows;
    /// Makes the costs those of no row.
    fn clear(work: &mut PathWork<'_>);
    /// Averages a row into the costs; within edges, puts it in their place.
    fn enter<S: SgmParameters>(work: &mut PathWork<'_>, features: &Features<'_>);
    /// Makes the costs of the row, of those that stand in their place before: of the pixels two rows below,
    /// or of no meaning where that is outside of the image.
    fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>);
    /// Moves the path from above down to the row, and those from the left and from the right through it, adds
    /// the three up, and selects the winner of every pixel that has a candidate.
    fn select(work: &mut PathWork<'_>, guide: Guide<'_>, unique: Unique<'_>, put: impl FnMut(usize, Found));
    /// Whether there is code for [`Self::select_words`].
    const SELECTS_WORDS: bool = false;
    /// [`Self::select`] with words for winners, where nothing is asked of the second best.
    #[inline(always)]
    fn select_words(_work: &mut PathWork<'_>, _guide: Guide<'_>, _winners: &mut [Winner]) {}
}

/// Adds a row of both images to the costs; the first row of a frame to none.
#[inline(always)]
pub(in crate::matching::backend) fn enter<P: Passes, S: SgmParameters>(
    work: &mut PathWork<'_>,
    row: CostWork<'_>,
) {
    if row.is_first {
        P::clear(work);
    }
    if let Some(features) = features::of::<P::Rows, S>(work, row.lines, row.workspace) {
        P::enter::<S>(work, &features);
    }
}

/// Averages the costs of a row with those around it, within edges.
#[inline(always)]
pub(in crate::matching::backend) fn within_edges<P: Passes>(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
    P::within_edges(work, edges);
}

/// Selects the winners of the row whose costs there are, and puts them in `ROWS` for each of their parts as
/// kernels in vectors have them, or one by one.
#[inline(always)]
pub(in crate::matching::backend) fn select<P: Passes, const ROWS: bool>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    select: Select<'_>,
) {
    let Select { winners, unique, .. } = select;
    if ROWS {
        let begin = work.min_disparity.min(work.width);
        let count = work.width - begin;
        let WinnerRows { below, costs, above, disparities } = winners.rows(begin);
        // All of one length, which is asked about once.
        let rows = [below, costs, above, disparities].map(|row| row.get_mut(..count));
        let [Some(below), Some(costs), Some(above), Some(disparities)] = rows else { return };
        P::select(
            work,
            guide,
            unique,
            #[inline(always)]
            |x, found| {
                let x = x - begin;
                if x < count {
                    (below[x], costs[x], above[x], disparities[x]) =
                        (found.beside.0, found.cost, found.beside.1, found.disparity);
                }
            },
        );
    } else {
        let winners = winners.words();
        if P::SELECTS_WORDS && !unique.is_asked() {
            return P::select_words(work, guide, winners);
        }
        P::select(
            work,
            guide,
            unique,
            #[inline(always)]
            |x, found| {
                if let Some(winner) = winners.get_mut(x) {
                    *winner = Winner::new(found.cost, found.disparity, found.beside);
                }
            },
        );
    }
}

/// Calls a pass with words, of which there is room for so many in a column. Each is a function of its own, so
/// that a firmware is linked without those for numbers of disparities that cannot be asked for.
macro_rules! in_words {
    ($work:ident, $pass:ident, [$($more:tt)?], $($argument:expr),*) => {
        match $work.stride {
            0 => (),
            16 if MOST == 0 || MOST == 16 => {
                words::$pass::<Quarters<4, true, 16>, $($more)?>($work, $($argument),*)
            }
            ..=32 if MOST == 32 => words::$pass::<Quarters<8, true, 28>, $($more)?>($work, $($argument),*),
            // Room for as few as will do: it stands on the stack.
            ..=64 if MOST != 16 && MOST != 32 => {
                words::$pass::<Quarters<16, false, 28>, $($more)?>($work, $($argument),*)
            }
            ..=128 if MOST == 0 => words::$pass::<Quarters<32, false, 44>, $($more)?>($work, $($argument),*),
            _ if MOST == 0 => words::$pass::<Quarters<64, false, 76>, $($more)?>($work, $($argument),*),
            _ => (),
        }
    };
}

/// [`Isa::sgm_cost`](crate::matching::backend::Isa::sgm_cost) in words.
#[inline(always)]
pub(in crate::matching::backend) fn cost_in_words<S: SgmParameters, const MOST: usize>(
    work: &mut PathWork<'_>,
    row: CostWork<'_>,
) {
    in_words!(work, enter, [S], row);
}

/// [`Isa::sgm_within_edges`](crate::matching::backend::Isa::sgm_within_edges) in words.
#[inline(always)]
pub(in crate::matching::backend) fn within_edges_in_words<const MOST: usize>(
    work: &mut PathWork<'_>,
    edges: EdgeWork<'_>,
) {
    in_words!(work, within_edges, [], edges);
}

/// [`Isa::sgm_select`](crate::matching::backend::Isa::sgm_select) in words.
#[inline(always)]
pub(in crate::matching::backend) fn select_in_words<const MOST: usize>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    select: Select<'_>,
) {
    in_words!(work, select, [false], guide, select);
}

/// The passes, each compiled once for a kind of path and called, not inlined.
pub(in crate::matching::backend) mod words {
    use super::{CostWork, EdgeWork, Guide, Passes, PathWork, Select, SgmParameters};

    #[inline(never)]
    pub(in crate::matching::backend) fn enter<P: Passes, S: SgmParameters>(
        work: &mut PathWork<'_>,
        row: CostWork<'_>,
    ) {
        super::enter::<P, S>(work, row);
    }

    #[inline(never)]
    pub(in crate::matching::backend) fn within_edges<P: Passes>(
        work: &mut PathWork<'_>,
        edges: EdgeWork<'_>,
    ) {
        super::within_edges::<P>(work, edges);
    }

    #[inline(never)]
    pub(in crate::matching::backend) fn select<P: Passes, const ROWS: bool>(
        work: &mut PathWork<'_>,
        guide: Guide<'_>,
        select: Select<'_>,
    ) {
        super::select::<P, ROWS>(work, guide, select);
    }
}
