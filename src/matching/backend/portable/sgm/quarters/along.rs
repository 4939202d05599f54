//! The paths along the row.

use super::columns::words;
use super::lanes::{least_of_four, lesser};
use super::steps::{Change, Step, Steps, close, ends};
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::slices::{chunks, part, part_mut};
use crate::matching::memory::views::{view, view_mut};
use core::cell::Cell;

/// A path along the row: the least of its costs at a pixel. The costs are in a column, all moved by the same
/// number.
pub(super) struct Along {
    least: u32,
    /// Candidates that stand before those that are searched.
    beyond: usize,
    far: u32,
}

impl Along {
    /// Before the first pixel all cost nothing.
    #[inline(always)]
    pub fn new(work: &PathWork<'_>, steps: &Steps, count: usize) -> Self {
        Self { least: 0, beyond: (4 * count).saturating_sub(work.disparities), far: steps.far }
    }

    /// Goes on from the column `from`, or from no costs, to `to`, a pixel that has these costs. Both may be
    /// the same.
    #[inline(always)]
    pub fn advance(&mut self, change: Change, costs: &[u32], from: &[Cell<u32>], to: &[Cell<u32>]) {
        let step = Step::new(ends(from), self.least, change, self.far);
        let mut marked = u32::MAX;
        let with = costs.as_chunks().0.iter().zip(to.as_chunks().0);
        let with =
            with.map(|([a, b, c, d], [to_a, to_b, to_c, to_d])| [(a, to_a), (b, to_b), (c, to_c), (d, to_d)]);
        step.through(from, with, |(cost, to), come| {
            let path = come.wrapping_sub(*cost);
            to.set(path);
            marked = lesser(marked, path);
        });
        // Else the compiler finds the least only where nothing is beyond the search, of words put away
        // for it.
        marked = core::hint::black_box(marked);
        if self.beyond > 0 {
            marked = close(to, self.beyond, self.far);
        }
        self.least = least_of_four(marked);
    }
}

/// Takes the path from the left along the row. What jumps cost on its way into each pixel is put in the
/// workspace.
#[inline(never)]
pub(super) fn right<const WORDS: usize, const ALL: bool>(work: &mut PathWork<'_>, guide: Guide<'_>) {
    let steps = Steps::new(work.penalties);
    let count = words::<WORDS, ALL>(work);
    let mut path = Along::new(work, &steps, count);
    let costs = chunks(view::<u8, u32>(work.costs), count);
    let columns = Cell::from_mut(view_mut::<u8, u32>(work.sums)).as_slice_of_cells();
    let jumps = view_mut::<u32, u8>(work.workspace);
    let mut none = [0; WORDS];
    let mut from = Cell::from_mut(part_mut(&mut none, ..count)).as_slice_of_cells();
    let mut before = 0;
    let pixels = part(guide.here, ..work.width).iter().zip(jumps);
    for ((&here, jump), (costs, to)) in pixels.zip(costs.zip(chunks(columns, count))) {
        let change = steps.between(here, before);
        *jump = change.jump as u8;
        path.advance(change, costs, from, to);
        (before, from) = (here, to);
    }
}
