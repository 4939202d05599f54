//! The costs along paths, and their winners: semi-global matching (Hirschmüller 2008) on lines as they come,
//! with three paths into a pixel, from the left, from the right and from above (the average of the two beside
//! it, two columns off).
//!
//! A pixel's candidates are bytes side by side; the largest disparity comes first, so that they stand in
//! memory as they do in the right image. A row takes these passes:
//!
//! ```text
//! enter  (all columns):      a[d] = average(a[d], pixel cost[d])                                      with row y + 1
//!   within edges (if so):    a[d] = average of the column's pixel costs around row y                  with row y + 2
//! select (to the right):     t[d] = a[d] + message(t of row y - 1)[d],  r[d] = a[d] + message(r)[d]
//!        (to the left):      l[d] = a[d] + message(l)[d]
//!        (where both were):  s[d] = r[d] + t[d] + l[d],  winner: the least s[d]
//!
//! message(p)[d] = min(p[d], p[d - 1] + step, p[d + 1] + step, least p + jump) - least p
//! ```
//!
//! Everything fits bytes: see [`Penalties`]. Kept from row to row are a, t and the room for s; within edges,
//! two more.
//!
//! * `features`: what a pixel's cost compares, of a row of both images.
//! * `edges`: how far a row's costs are averaged with others.
//! * `passes`: the passes, for vectors and for plain words.
//! * `dsp`: the passes for cores with Arm's instructions on four bytes.
//! * `dispatch`: which of them a kernel calls.
//!
//! The work is the same for every picture, but for some instructions where a winner is at an end of the
//! search.

mod dispatch;
#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
mod dsp;
mod edges;
mod features;
#[cfg(not(any(stereopsis_dsp, stereopsis_vectors)))]
mod passes;

use super::winner::Select;
#[cfg(not(stereopsis_vectors))]
use super::winner::Winner;
#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
use super::winner::WinnerRows;
use super::winner::{Found, Unique};
use crate::matching::paths::Along;
use crate::matching::penalties::Penalties;
use crate::matching::scheme::Around;
use features::Features;

pub(in crate::matching) use edges::EdgeWork;

/// What the passes work on.
///
/// Candidate `d` of column `x` is the right image's column `x - min_disparity - d`, where that lies left of
/// the image its first column. Lanes beyond the disparities that are searched stand where no path comes from.
pub(in crate::matching) struct PathWork<'a> {
    /// Pixels in the row.
    pub width: usize,
    /// Lanes of a column: [`Kernel::candidates`](super::Kernel::candidates).
    pub stride: usize,
    /// Disparities searched.
    pub disparities: usize,
    /// The smallest disparity, px.
    pub min_disparity: usize,
    pub penalties: &'a Penalties,
    /// How far gradients are shifted to the right.
    pub gradient_shift: u32,
    /// Costs, paths from above, and sums of paths: each `stride` bytes for each column, where a word may
    /// stand. The paths from above have [`COLUMNS_OFF`] columns more.
    pub costs: &'a mut [u8],
    pub top: &'a mut [u8],
    pub sums: &'a mut [u8],
}

/// What the passes that decide look at beside.
#[derive(Clone, Copy)]
pub(in crate::matching) struct Guide<'a> {
    /// The left image's row.
    pub here: &'a [u8],
    /// The row above, if there is one.
    pub above: Option<&'a [u8]>,
    /// Its number.
    #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
    pub row: usize,
}

/// How many columns to each side the path from above comes from.
pub(in crate::matching) const COLUMNS_OFF: usize = 2;

/// The passes of a row. What they keep from row to row they keep in a form of their own.
trait Passes {
    /// Makes the costs those of no row.
    fn clear(work: &mut PathWork<'_>);
    /// Averages a row into the costs; within edges, puts it in their place.
    fn enter<S: Along>(work: &mut PathWork<'_>, features: &Features<'_>);
    /// Makes the costs of the row, of those that stand in their place before: of the pixels two rows below,
    /// or of no meaning where that is outside of the image.
    fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>);
    /// Moves the path from above down to the row, and those from the left and from the right through it, adds
    /// the three up, and selects the winner of every pixel that has a candidate.
    fn select(work: &mut PathWork<'_>, guide: Guide<'_>, unique: Unique<'_>, put: impl FnMut(usize, Found));
}

/// Adds a row of both images to the costs; the first row of a frame to none.
#[inline(always)]
fn enter<P: Passes, S: Along>(
    work: &mut PathWork<'_>,
    is_first: bool,
    lines: [&Around<'_>; 2],
    room: &mut [u8],
) {
    if is_first {
        P::clear(work);
    }
    if let Some(features) = features::of::<S>(work, lines, room) {
        P::enter::<S>(work, &features);
    }
}

/// Averages the costs of a row with those around it, within edges.
#[inline(always)]
fn within_edges<P: Passes>(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
    P::within_edges(work, edges);
}

/// Selects the winners of the row whose costs there are, and puts them in `ROWS` for each of their parts as
/// kernels in vectors have them, or one by one.
#[inline(always)]
fn select<P: Passes, const ROWS: bool>(mut work: PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
    let Select { winners, unique, .. } = select;
    if ROWS {
        #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
        {
            let begin = work.min_disparity.min(work.width);
            let WinnerRows { below, costs, above, disparities } = WinnerRows::of(winners, begin);
            P::select(
                &mut work,
                guide,
                unique,
                #[inline(always)]
                |x, found| {
                    let x = x - begin;
                    let places =
                        (below.get_mut(x), costs.get_mut(x), above.get_mut(x), disparities.get_mut(x));
                    if let (Some(below), Some(cost), Some(above), Some(disparity)) = places {
                        (*below, *cost, *above, *disparity) =
                            (found.beside.0, found.cost, found.beside.1, found.disparity);
                    }
                },
            );
        }
    } else {
        #[cfg(not(stereopsis_vectors))]
        P::select(
            &mut work,
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
