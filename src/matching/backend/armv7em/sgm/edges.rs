//! A row's agreements, averaged within edges.

use crate::dsp::average;
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::sgm::edges::edges_at;
use crate::matching::backend::work::{EdgeWork, PathWork};
use crate::matching::memory::slices::chunks_mut;
use crate::matching::memory::views::view_mut;

/// Averages agreements within edges as `groups` averages costs; these averages are rounded down.
#[inline(always)]
pub(super) fn within_edges(work: &mut PathWork<'_>, stride: usize, edges: EdgeWork<'_>) {
    // Not known when compiled: the loop over a column is not written out.
    let count = core::hint::black_box(stride / 4);
    let much = work.penalties.edges[1];
    let above = chunks_mut(view_mut::<u8, u32>(edges.above), count);
    let below = chunks_mut(view_mut::<u8, u32>(edges.below), count);
    let columns = chunks_mut(view_mut::<u8, u32>(work.costs), count).zip(above.zip(below));
    for (x, (costs, (above, below))) in columns.enumerate() {
        let [at_next, at_last] = edges_at(&edges.guides, x, much).map(|edge| u32::from(edge).wrapping_neg());
        let choose = |first: u32, second: u32, mask: u32| second ^ (first ^ second) & mask;
        for (cost, (above, below)) in costs.iter_mut().zip(above.iter_mut().zip(below)) {
            keep_loop();
            let (row, one, two) = (*above, *below, *cost);
            let both = average(one, choose(one, two, at_last));
            *cost = average(row, choose(row, both, at_next));
            *above = average(one, choose(one, row, at_next));
            *below = two;
        }
    }
}
