//! The costs along paths, and their winners: semi-global matching (Hirschmüller 2008) on lines as they come, with three
//! paths into a pixel, from the left, from the right and from above (the average of the two beside it, two columns off).
//!
//! Written once for groups of bytes, whose lanes run over the disparities of one pixel; the largest disparity has the first
//! lane, so that a pixel's candidates stand in memory as they do in the right image. A row takes three passes:
//!
//! ```text
//! cost   (all columns):      a[d] = average(a[d], pixel cost[d])                                      with row y + 1
//! gather (left to right):    t[d] = a[d] + message(t of row y - 1)[d],  r[d] = a[d] + message(r)[d],  q[d] = r[d] + t[d]
//! decide (right to left):    l[d] = a[d] + message(l)[d],  s[d] = q[d] + l[d],  winner: the least s[d]
//!
//! message(p)[d] = min(p[d], p[d - 1] + step, p[d + 1] + step, least p + jump) - least p
//! ```
//!
//! Everything fits bytes: see [`Penalties`]. Kept from row to row are a, t and the room for q.
//!
//! * `features`: what a pixel's cost compares, of a row of both images.
//! * `cost`, `gather`, `decide`: the passes.
//! * `group`: what they are written for. `words`, with `dsp`: four bytes in a word; `sse2`, `avx2`, `neon`: registers of
//!   larger processors; `arrays`: what the compiler makes of an array elsewhere.
//!
//! The work is the same for every picture, but for some instructions where a winner is at an end of the search.

mod cost;
mod decide;
mod features;
mod gather;
mod group;

#[cfg(all(
    any(target_pointer_width = "64", stereopsis_vectors),
    not(any(target_arch = "x86_64", target_arch = "aarch64"))
))]
mod arrays;
#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(stereopsis_dsp)]
mod dsp;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(target_arch = "x86_64")]
mod sse2;
#[cfg(not(stereopsis_vectors))]
mod words;

use super::winner::Select;
#[cfg(not(stereopsis_vectors))]
use super::winner::Winner;
#[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
use super::winner::WinnerRows;
use super::{MASKS, STEP};
use crate::matching::paths::Along;
use crate::matching::penalties::Penalties;
use crate::matching::scheme::Around;
use group::Group;

#[cfg(target_arch = "x86_64")]
pub(in crate::matching) use avx2::Wide;
#[cfg(target_arch = "aarch64")]
pub(in crate::matching) use neon::Vector;
#[cfg(target_arch = "x86_64")]
pub(in crate::matching) use sse2::Vector;
#[cfg(not(stereopsis_vectors))]
pub(in crate::matching) use words::Word;
/// Vectors of the compilation's own target.
#[cfg(all(
    any(target_pointer_width = "64", stereopsis_vectors),
    not(any(target_arch = "x86_64", target_arch = "aarch64"))
))]
pub(in crate::matching) type Vector = arrays::Array<16>;

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

/// Adds a row of both images to the costs; the first of a frame takes their place.
#[inline(always)]
pub(in crate::matching) fn enter<G: Group, S: Along>(
    work: &mut PathWork<'_>,
    lines: [&Around<'_>; 2],
    is_first: bool,
    room: &mut [u8],
) {
    if let Some(features) = features::of::<S>(work, lines, room) {
        cost::enter::<G, S>(work, &features, is_first);
    }
}

/// Selects the winners of the row whose costs there are.
#[inline(always)]
pub(in crate::matching) fn select<G: Group, S: Along, const CELLS: usize, const ALL: bool>(
    mut work: PathWork<'_>,
    guide: Guide<'_>,
    select: Select<'_>,
) {
    gather::gather::<G, S, CELLS, ALL>(&mut work, guide);
    let Select { winners, unique, .. } = select;
    if G::PUTS_ROWS {
        #[cfg(any(target_pointer_width = "64", stereopsis_vectors))]
        {
            let begin = work.min_disparity;
            let WinnerRows { below, costs, above, disparities } = WinnerRows::of(winners, begin.min(work.width));
            decide::decide::<G, CELLS, ALL>(&work, guide, unique, |x, found| {
                let x = x - begin;
                let places = (below.get_mut(x), costs.get_mut(x), above.get_mut(x), disparities.get_mut(x));
                if let (Some(below), Some(cost), Some(above), Some(disparity)) = places {
                    (*below, *cost, *above, *disparity) = (found.beside.0, found.cost, found.beside.1, found.disparity);
                }
            });
        }
    } else {
        #[cfg(not(stereopsis_vectors))]
        decide::decide::<G, CELLS, ALL>(&work, guide, unique, |x, found| {
            if let Some(winner) = winners.get_mut(x) {
                *winner = Winner::new(found.cost, found.disparity, found.beside);
            }
        });
    }
}

/// Lanes of a column, known to the compiler if `ALL` the cells of a path are in use.
#[inline(always)]
fn stride<G: Group, const CELLS: usize, const ALL: bool>(work: &PathWork<'_>) -> usize {
    if ALL { CELLS * G::LANES } else { work.stride.max(STEP) }
}

/// Column `x` of a volume.
#[inline(always)]
fn cells<G: Group>(volume: &[u8], x: usize, stride: usize) -> &[G::Cell] {
    let volume = G::cells(volume);
    let count = stride / G::LANES;
    volume.get(x * count..).and_then(|cells| cells.get(..count)).unwrap_or(&[])
}

/// The same, to write.
#[inline(always)]
fn cells_mut<G: Group>(volume: &mut [u8], x: usize, stride: usize) -> &mut [G::Cell] {
    let volume = G::cells_mut(volume);
    let count = stride / G::LANES;
    volume.get_mut(x * count..).and_then(|cells| cells.get_mut(..count)).unwrap_or_default()
}

/// A path at a pixel: its costs, of `CELLS` cells, all of them in use if `ALL`.
#[derive(Clone, Copy)]
struct Path<G, const CELLS: usize, const ALL: bool> {
    cells: [G; CELLS],
    count: usize,
}

impl<G: Group, const CELLS: usize, const ALL: bool> Path<G, CELLS, ALL> {
    /// What stands at column `x` of a volume.
    #[inline(always)]
    fn at(volume: &[u8], x: usize, stride: usize) -> Self {
        Self::of(cells::<G>(volume, x, stride))
    }

    /// What stands in memory.
    #[inline(always)]
    fn of(cells: &[G::Cell]) -> Self {
        let mut path = Self { cells: [G::splat(0); CELLS], count: cells.len().min(CELLS) };
        for (to, &from) in path.cells_mut().iter_mut().zip(cells) {
            *to = G::of(from);
        }
        path
    }

    #[inline(always)]
    fn cells(&self) -> &[G] {
        if ALL { &self.cells } else { self.cells.get(..self.count).unwrap_or(&[]) }
    }

    #[inline(always)]
    fn cells_mut(&mut self) -> &mut [G] {
        if ALL { &mut self.cells } else { self.cells.get_mut(..self.count).unwrap_or_default() }
    }

    /// The average of two, rounded down.
    #[inline(always)]
    fn average(mut self, other: &Self) -> Self {
        for (cell, &other) in self.cells_mut().iter_mut().zip(other.cells()) {
            *cell = cell.average_down(other);
        }
        self
    }

    /// With the costs of a pixel.
    #[inline(always)]
    fn plus(mut self, costs: &[G::Cell]) -> Self {
        for (cell, &cost) in self.cells_mut().iter_mut().zip(costs) {
            *cell = cell.plus(G::of(cost));
        }
        self
    }

    /// What it says to a pixel: [`Self::step`] without costs.
    #[inline(always)]
    fn message(mut self, steps: &Steps<G, CELLS, ALL>, jump: u8) -> Self {
        self.replace(steps, jump, |_, message| message);
        self
    }

    /// Goes on to a pixel that has these costs.
    #[inline(always)]
    fn step(&mut self, steps: &Steps<G, CELLS, ALL>, jump: u8, costs: &[G::Cell]) {
        self.replace(steps, jump, |i, message| costs.get(i).map_or(message, |&cost| message.plus(G::of(cost))));
    }

    /// Puts in each cell's place what `each` makes of its message.
    #[inline(always)]
    fn replace(&mut self, steps: &Steps<G, CELLS, ALL>, jump: u8, each: impl Fn(usize, G) -> G) {
        let least = self.cells().iter().fold(steps.far, |least, &cell| least.min(cell)).least();
        let (jump, least) = (G::splat(least + jump), G::splat(least));
        let (mut before, mut here) = (steps.far, self.cells().first().copied().unwrap_or(steps.far));
        for i in 0..self.cells().len() {
            let next = self.cells().get(i + 1).copied().unwrap_or(steps.far);
            let beside = here.after(before).min(here.before(next)).plus(steps.step);
            let message = here.min(beside).min(jump).minus(least);
            if let Some(cell) = self.cells_mut().get_mut(i) {
                *cell = each(i, message);
            }
            (before, here) = (here, next);
        }
    }
}

/// What every step of a path needs.
struct Steps<G, const CELLS: usize, const ALL: bool> {
    /// A cost so high that no path comes from there: beside the search's ends.
    far: G,
    step: G,
    /// The same where lanes are beyond the search, and 0 where they are not, if there are such lanes.
    beyond: Option<Path<G, CELLS, ALL>>,
}

impl<G: Group, const CELLS: usize, const ALL: bool> Steps<G, CELLS, ALL> {
    #[inline(always)]
    fn new(work: &PathWork<'_>) -> Self {
        // No path costs more: `Penalties::check`.
        let far = 127u8.saturating_sub(work.penalties.step);
        let stride = stride::<G, CELLS, ALL>(work);
        let beyond = (work.disparities < stride).then(|| {
            let mut beyond = Path { cells: [G::splat(0); CELLS], count: CELLS.min(stride / G::LANES) };
            let mut numbers = [0; 256];
            if let Some(numbers) = numbers.get_mut(..stride - work.disparities) {
                numbers.fill(far);
            }
            for (cell, &numbers) in beyond.cells_mut().iter_mut().zip(G::groups(&numbers)) {
                *cell = G::of_bytes(numbers);
            }
            beyond
        });
        Self { far: G::splat(far), step: G::splat(work.penalties.step), beyond }
    }

    /// Closes a path's lanes that are beyond the search.
    #[inline(always)]
    fn close(&self, path: &mut Path<G, CELLS, ALL>) {
        if let Some(beyond) = &self.beyond {
            for (cell, &beyond) in path.cells_mut().iter_mut().zip(beyond.cells()) {
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
