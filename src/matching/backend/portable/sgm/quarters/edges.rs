//! A row's costs, averaged within edges.

use super::lanes::average;
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::sgm::edges::edges_at;
use crate::matching::backend::work::{EdgeWork, PathWork};
use crate::matching::memory::views::view_mut;

/// Makes the costs of the row of those that stand in their place before: of the pixels two rows below, or of
/// no meaning where that is outside of the image.
#[inline(never)]
pub(super) fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>, count: usize) {
    let much = work.penalties.edges[1];
    let [costs, above, below] = [&mut *work.costs, edges.above, edges.below].map(view_mut::<u8, u32>);
    // Words of the column that are left, and the number of the next one.
    let (mut left, mut x, mut masks) = (0, 0, [0; 2]);
    for (cost, (above, below)) in costs.iter_mut().zip(above.iter_mut().zip(below)) {
        keep_loop();
        if left == 0 {
            masks = edges_at(&edges.guides, x, much).map(|is_edge| 0u32.wrapping_sub(is_edge.into()));
            (left, x) = (count, x + 1);
        }
        left -= 1;
        let [at_next, at_last] = masks;
        let (row, one, two) = (*above, *below, *cost);
        // One of two numbers: the first at an edge.
        let choose = |at: u32, first: u32, second: u32| second ^ (first ^ second) & at;
        let both = average(one, choose(at_last, one, two));
        *cost = average(row, choose(at_next, row, both));
        *above = average(one, choose(at_next, one, row));
        *below = two;
    }
}
