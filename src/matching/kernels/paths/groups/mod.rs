//! The passes, written once for groups of bytes whose lanes run over the disparities of one pixel.
//!
//! * `cost`, `edges`, `gather`, `decide`: the passes.
//! * `group`: what they are written for. `words`: four bytes in a word; `sse2`, `avx2`, `avx512`, `neon`: registers of
//!   larger processors, with what they have alike from `registers`.

mod cost;
mod decide;
mod edges;
mod gather;
mod group;

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod registers;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod words;

use super::features::Features;
use super::{COLUMNS_OFF, EdgeWork, Guide, Passes, PathWork};
use crate::matching::kernels::winner::{Found, Unique};
use crate::matching::kernels::{MASKS, STEP};
use crate::matching::paths::Along;
use crate::matching::penalties::Change;
use core::marker::PhantomData;
use group::Group;

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Wide;
#[cfg(target_arch = "x86_64")]
pub(super) use avx512::Widest;
#[cfg(target_arch = "aarch64")]
pub(super) use neon::Vector;
#[cfg(target_arch = "x86_64")]
pub(super) use sse2::Vector;
pub(super) use words::Word;
/// The target's own vectors, as far as they are used here.
#[cfg(all(target_pointer_width = "64", not(any(target_arch = "x86_64", target_arch = "aarch64"))))]
pub(super) use words::Word as Vector;

/// The passes over columns of up to `CELLS` groups, all of them in use if `ALL`: then the compiler knows how many.
pub(super) struct Groups<G, const CELLS: usize, const ALL: bool>(PhantomData<G>);

impl<G: Group, const CELLS: usize, const ALL: bool> Passes for Groups<G, CELLS, ALL> {
    #[inline(always)]
    fn clear(work: &mut PathWork<'_>) {
        work.costs.fill(0);
    }

    #[inline(always)]
    fn enter<S: Along>(work: &mut PathWork<'_>, features: &Features<'_>) {
        cost::enter::<G, S, CELLS, ALL>(work, features);
    }

    #[inline(always)]
    fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        edges::within_edges::<G, CELLS, ALL>(work, edges);
    }

    #[inline(always)]
    fn gather(work: &mut PathWork<'_>, guide: Guide<'_>) {
        gather::gather::<G, CELLS, ALL>(work, guide);
    }

    #[inline(always)]
    fn decide(work: &mut PathWork<'_>, guide: Guide<'_>, unique: Unique<'_>, put: impl FnMut(usize, Found)) {
        decide::decide::<G, CELLS, ALL>(work, guide, unique, put);
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
