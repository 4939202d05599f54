//! The paths along the row.

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::sgm::quarters::columns::{column, words};
use crate::matching::backend::portable::sgm::quarters::rounds;
use crate::matching::backend::portable::sgm::quarters::steps::Steps;
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::slices::part;
use crate::matching::memory::views::{view, view_mut};
use core::cell::Cell;

/// A path along the row: the least of its costs at a pixel. The costs are in a column, all moved by the same
/// number.
pub(super) struct Along {
    steps: Steps,
    least: u32,
}

impl Along {
    /// Before the first pixel all cost nothing.
    #[inline(always)]
    pub fn new(work: &PathWork<'_>, count: usize) -> Self {
        Self { steps: Steps::new(work.penalties, count), least: 0 }
    }

    /// Goes on from the column `from`, or from no costs, to `to`, a pixel that has these costs and differs by
    /// a change of brightness. Both may be the same. Returns what a jump costs there.
    #[inline(always)]
    pub fn advance(&mut self, change: u8, costs: &[u32], from: &[Cell<u32>], to: &[Cell<u32>]) -> u32 {
        let (least, jump) = rounds::along(&self.steps, (change, self.least), costs, from, to);
        self.least = least;
        jump
    }
}

/// Takes the path from the left along the row. What jumps cost on its way into each pixel is put in the
/// workspace.
#[inline(never)]
pub(super) fn right<const WORDS: usize, const ALL: bool>(work: &mut PathWork<'_>, guide: Guide<'_>) {
    let count = words::<WORDS, ALL>(work);
    let mut path = Along::new(work, count);
    let costs = view::<u8, u32>(work.costs);
    let columns = Cell::from_mut(view_mut::<u8, u32>(work.sums)).as_slice_of_cells();
    let jumps = view_mut::<u32, u8>(work.workspace);
    // Before the first pixel all cost nothing.
    let Some(mut from) = column(columns, 0, count) else { return };
    for path in from {
        keep_loop();
        path.set(0);
    }
    let (mut before, mut place) = (0, 0);
    for (&here, jump) in part(guide.here, ..work.width).iter().zip(jumps) {
        let (Some(costs), Some(to)) = (column(costs, place, count), column(columns, place, count)) else {
            return;
        };
        place += count;
        keep_loop();
        *jump = path.advance(here.abs_diff(before), costs, from, to) as u8;
        (before, from) = (here, to);
    }
}
