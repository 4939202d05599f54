//! The costs along paths, and their winners: semi-global matching (Hirschmüller 2008) on lines as they come, with three
//! paths into a pixel, from the left, from the right and from above (the average of the two beside it, two columns off).
//!
//! Written once for groups of bytes, whose lanes run over the disparities of one pixel; the largest disparity has the first
//! lane, so that a pixel's candidates stand in memory as they do in the right image. A row takes three passes, or four:
//!
//! ```text
//! cost   (all columns):      a[d] = average(a[d], pixel cost[d])                                      with row y + 1
//!   within edges (if so):    a[d] = average of the column's pixel costs around row y                  with row y + 2
//! gather (left to right):    t[d] = a[d] + message(t of row y - 1)[d],  r[d] = a[d] + message(r)[d],  q[d] = r[d] + t[d]
//! decide (right to left):    l[d] = a[d] + message(l)[d],  s[d] = q[d] + l[d],  winner: the least s[d]
//!
//! message(p)[d] = min(p[d], p[d - 1] + step, p[d + 1] + step, least p + jump) - least p
//! ```
//!
//! Everything fits bytes: see [`Penalties`]. Kept from row to row are a, t and the room for q; within edges, two more.
//!
//! * `features`: what a pixel's cost compares, of a row of both images.
//! * `cost`, `edges`, `gather`, `decide`: the passes.
//! * `dispatch`: which groups of bytes they are called with.
//! * `group`: what they are written for. `words`, with `dsp`: four bytes in a word; `sse2`, `avx2`, `neon`: registers of
//!   larger processors.
//!
//! The work is the same for every picture, but for some instructions where a winner is at an end of the search.

mod cost;
mod decide;
mod dispatch;
mod edges;
mod features;
mod gather;
mod group;

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
mod dsp;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod words;

use super::winner::Select;
#[cfg(not(stereopsis_vectors))]
use super::winner::Winner;
#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
use super::winner::WinnerRows;
use super::{MASKS, STEP};
use crate::matching::paths::Along;
use crate::matching::penalties::{Change, Penalties};
use crate::matching::scheme::Around;
use edges::within_edges;
use group::Group;

pub(in crate::matching) use edges::EdgeWork;

#[cfg(target_arch = "x86_64")]
use avx2::Wide;
#[cfg(target_arch = "aarch64")]
use neon::Vector;
#[cfg(target_arch = "x86_64")]
use sse2::Vector;
use words::Word;
/// The target's own vectors, as far as they are used here.
#[cfg(all(target_pointer_width = "64", not(any(target_arch = "x86_64", target_arch = "aarch64"))))]
use words::Word as Vector;

/// What the passes work on.
///
/// Candidate `d` of column `x` is the right image's column `x - min_disparity - d`, where that lies left of the image its
/// first column. Lanes beyond the disparities that are searched stand where no path comes from.
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
    /// Costs, paths from above, and sums of two paths: each `stride` bytes for each column, where a word may stand.
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
}

/// Adds a row of both images to the costs.
#[inline(always)]
fn enter<G: Group, S: Along, const CELLS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    lines: [&Around<'_>; 2],
    room: &mut [u8],
) {
    if let Some(features) = features::of::<S>(work, lines, room) {
        cost::enter::<G, S, CELLS, ALL>(work, &features);
    }
}

/// Selects the winners of the row whose costs there are, and puts them in `ROWS` for each of their parts as kernels in
/// vectors have them, or one by one.
#[inline(always)]
fn select<G: Group, const ROWS: bool, const CELLS: usize, const ALL: bool>(
    mut work: PathWork<'_>,
    guide: Guide<'_>,
    select: Select<'_>,
) {
    gather::gather::<G, CELLS, ALL>(&mut work, guide);
    let Select { winners, unique, .. } = select;
    if ROWS {
        #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
        {
            let begin = work.min_disparity.min(work.width);
            let WinnerRows { below, costs, above, disparities } = WinnerRows::of(winners, begin);
            decide::decide::<G, CELLS, ALL>(
                &work,
                guide,
                unique,
                #[inline(always)]
                |x, found| {
                    let x = x - begin;
                    let places = (below.get_mut(x), costs.get_mut(x), above.get_mut(x), disparities.get_mut(x));
                    if let (Some(below), Some(cost), Some(above), Some(disparity)) = places {
                        (*below, *cost, *above, *disparity) =
                            (found.beside.0, found.cost, found.beside.1, found.disparity);
                    }
                },
            );
        }
    } else {
        #[cfg(not(stereopsis_vectors))]
        decide::decide::<G, CELLS, ALL>(
            &work,
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

/// Lanes of a column, known to the compiler if `ALL` the cells of a path are in use.
#[inline(always)]
fn stride<G: Group, const CELLS: usize, const ALL: bool>(work: &PathWork<'_>) -> usize {
    if ALL { CELLS * G::LANES } else { work.stride.max(STEP) }
}

/// The first column of a volume, and the rest.
#[inline(always)]
fn split_first<C, const CELLS: usize, const ALL: bool>(volume: &[C], count: usize) -> Option<(&[C], &[C])> {
    if ALL {
        let (column, rest) = volume.split_first_chunk::<CELLS>()?;
        Some((column, rest))
    } else {
        volume.split_at_checked(count)
    }
}

/// The same, to write.
#[inline(always)]
fn split_first_mut<C, const CELLS: usize, const ALL: bool>(
    volume: &mut [C],
    count: usize,
) -> Option<(&mut [C], &mut [C])> {
    if ALL {
        let (column, rest) = volume.split_first_chunk_mut::<CELLS>()?;
        Some((column, rest))
    } else {
        volume.split_at_mut_checked(count)
    }
}

/// The last column of a volume, after the rest.
#[inline(always)]
fn split_last<C, const CELLS: usize, const ALL: bool>(volume: &[C], count: usize) -> Option<(&[C], &[C])> {
    if ALL {
        let (rest, column) = volume.split_last_chunk::<CELLS>()?;
        Some((rest, column))
    } else {
        volume.split_at_checked(volume.len().checked_sub(count)?)
    }
}

/// A path at a pixel: its costs, of `CELLS` cells, all of them in use if `ALL`.
#[derive(Clone, Copy)]
struct Path<G, const CELLS: usize, const ALL: bool>([G; CELLS]);

impl<G: Group, const CELLS: usize, const ALL: bool> Path<G, CELLS, ALL> {
    /// What stands in memory.
    #[inline(always)]
    fn of(cells: &[G::Cell]) -> Self {
        let mut path = Self([G::splat(0); CELLS]);
        for (to, &from) in path.0.iter_mut().zip(cells) {
            *to = G::of(from);
        }
        path
    }

    /// Those in use.
    #[inline(always)]
    fn cells(&self, count: usize) -> &[G] {
        if ALL { &self.0 } else { self.0.get(..count).unwrap_or(&[]) }
    }

    /// The average with another one, rounded down.
    #[inline(always)]
    fn average(mut self, other: &[G::Cell]) -> Self {
        for (cell, &other) in self.0.iter_mut().zip(other) {
            *cell = cell.average_down(G::of(other));
        }
        self
    }

    /// Goes on to a pixel that has these costs.
    #[inline(always)]
    fn step(mut self, steps: &Steps<G, CELLS, ALL>, change: Change, costs: &[G::Cell]) -> Self {
        let least = self.cells(costs.len()).iter().fold(
            steps.far,
            #[inline(always)]
            |least, &cell| least.min(cell),
        );
        let least = least.least();
        let (step, jump) = (G::splat(change.step), least.plus(G::splat(change.jump)));
        let (mut before, mut here) = (steps.far, self.0.first().copied().unwrap_or(steps.far));
        for (i, &cost) in costs.iter().enumerate().take(CELLS) {
            let next = if i + 1 < costs.len() { self.0.get(i + 1).copied().unwrap_or(steps.far) } else { steps.far };
            let beside = here.after(before).min(here.before(next)).plus(step);
            let message = here.min(beside).min(jump).minus(least);
            if let Some(cell) = self.0.get_mut(i) {
                *cell = message.plus(G::of(cost));
            }
            (before, here) = (here, next);
        }
        self
    }
}

/// What every step of a path needs.
struct Steps<G, const CELLS: usize, const ALL: bool> {
    /// A cost so high that no path comes from there: beside the search's ends.
    far: G,
    /// The same where lanes are beyond the search, and 0 where they are not, if there are such lanes.
    beyond: Option<Path<G, CELLS, ALL>>,
}

impl<G: Group, const CELLS: usize, const ALL: bool> Steps<G, CELLS, ALL> {
    #[inline(always)]
    fn new(work: &PathWork<'_>) -> Self {
        // No path costs more: `Penalties::check`.
        let far = 127u8.saturating_sub(work.penalties.step[0]);
        let stride = stride::<G, CELLS, ALL>(work);
        let beyond = if work.disparities < stride {
            let mut beyond = Path([G::splat(0); CELLS]);
            let mut numbers = [0; 256];
            numbers.get_mut(..stride - work.disparities).unwrap_or_default().fill(far);
            for (cell, &numbers) in beyond.0.iter_mut().zip(G::groups(&numbers)) {
                *cell = G::of_bytes(numbers);
            }
            Some(beyond)
        } else {
            None
        };
        Self { far: G::splat(far), beyond }
    }

    /// Closes a path's lanes that are beyond the search.
    #[inline(always)]
    fn close(&self, path: &mut Path<G, CELLS, ALL>) {
        if let Some(beyond) = &self.beyond {
            for (cell, &beyond) in path.0.iter_mut().zip(&beyond.0) {
                *cell = cell.max(beyond);
            }
        }
    }
}

/// Masks the lanes of a column but the last `candidates`.
#[inline(always)]
fn mask(stride: usize, candidates: usize) -> &'static [u8] {
    let masked = stride.saturating_sub(candidates);
    MASKS.get(256usize.saturating_sub(masked)..).and_then(|mask| mask.get(..stride)).unwrap_or(&[])
}
