//! A row's costs, averaged within edges.

use super::super::edges::edges_at;
use super::{PathWork, stride};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::group::Group;
use crate::matching::backend::work::EdgeWork;
use crate::matching::memory::slices::chunks_mut;

/// Makes the costs of the row of those that stand in their place before: of the pixels two rows below, or of
/// no meaning where that is outside of the image.
#[inline(always)]
pub(super) fn within_edges<G: Group, const CELLS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    edges: EdgeWork<'_>,
) {
    let count = stride::<G, CELLS, ALL>(work) / G::LANES;
    let much = work.penalties.edges[1];
    let above = chunks_mut(G::cells_mut(edges.above), count);
    let below = chunks_mut(G::cells_mut(edges.below), count);
    let columns = chunks_mut(G::cells_mut(work.costs), count).zip(above.zip(below));
    for (x, (costs, (above, below))) in columns.enumerate() {
        let [at_next, at_last] = edges_at(&edges.guides, x, much).map(Choice::<G>::new);
        for (cost, (above, below)) in costs.iter_mut().zip(above.iter_mut().zip(below)) {
            keep_loop();
            let (row, one, two) = (G::of(*above), G::of(*below), G::of(*cost));
            let both = one.average_up(at_last.of(one, two));
            *cost = row.average_up(at_next.of(row, both)).cell();
            *above = one.average_up(at_next.of(one, row)).cell();
            *below = two.cell();
        }
    }
}

/// One of two groups, the same for all lanes.
#[derive(Clone, Copy)]
struct Choice<G> {
    first: G,
    second: G,
}

impl<G: Group> Choice<G> {
    #[inline(always)]
    fn new(is_first: bool) -> Self {
        let mask = 0u8.wrapping_sub(is_first.into());
        Self { first: G::splat(mask), second: G::splat(!mask) }
    }

    #[inline(always)]
    fn of(self, first: G, second: G) -> G {
        first.and(self.first).or(second.and(self.second))
    }
}
