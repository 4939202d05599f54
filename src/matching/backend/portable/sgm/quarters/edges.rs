//! A row's costs, averaged within edges.

use super::lanes::average;
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::sgm::edges::edges_at;
use crate::matching::backend::work::{EdgeWork, PathWork};
use crate::matching::memory::slices::chunks_mut;
use crate::matching::memory::views::view_mut;

/// Makes the costs of the row of those that stand in their place before: of the pixels two rows below, or of
/// no meaning where that is outside of the image.
#[inline(never)]
pub(super) fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>, count: usize) {
    // Not known when compiled: the loop over a column is not written out.
    let count = core::hint::black_box(count);
    let much = work.penalties.edges[1];
    let above = chunks_mut(view_mut::<u8, u32>(edges.above), count);
    let below = chunks_mut(view_mut::<u8, u32>(edges.below), count);
    let columns = chunks_mut(view_mut::<u8, u32>(work.costs), count).zip(above.zip(below));
    for (x, (costs, (above, below))) in columns.enumerate() {
        let [at_next, at_last] =
            edges_at(&edges.guides, x, much).map(|is_edge| 0u32.wrapping_sub(is_edge.into()));
        for (cost, (above, below)) in costs.iter_mut().zip(above.iter_mut().zip(below)) {
            keep_loop();
            let (row, one, two) = (*above, *below, *cost);
            // One of two numbers: the first at an edge.
            let choose = |at: u32, first: u32, second: u32| second ^ (first ^ second) & at;
            let both = average(one, choose(at_last, one, two));
            *cost = average(row, choose(at_next, row, both));
            *above = average(one, choose(at_next, one, row));
            *below = two;
        }
    }
}
