//! A row's costs, averaged with those above and below as far as no edge is crossed.
//!
//! An edge is where the left image's brightness changes much from a row to the next one of the column, and the ends of the
//! image are edges: beyond them there may be another surface. With p the costs of a row's pixels:
//!
//! ```text
//! above[d] = average(above of row y - 1, p[d] of row y)         p[d] of row y alone below an edge
//! below[d] = average(p[d] of row y + 1, p[d] of row y + 2)      p[d] of row y + 1 alone above an edge
//! cost[d]  = average(above[d], below[d])                        above[d] alone above an edge
//! ```
//!
//! No branch looks at the picture: masks choose what is averaged, and the average of a number with itself is that number.

use super::group::Group;
use super::{PathWork, stride};

/// What the costs of a row are averaged with, and how far.
pub(in crate::matching) struct EdgeWork<'a> {
    /// The left image's row and the two below it, as far as they are inside of the image.
    pub guides: [Option<&'a [u8]>; 3],
    /// The average of the row's costs and those above; afterwards that of the next row. As the volumes of [`PathWork`].
    pub above: &'a mut [u8],
    /// The costs of the next row's pixels; afterwards those of the row after it.
    pub below: &'a mut [u8],
}

/// Makes the costs of the row of those that stand in their place before: of the pixels two rows below, or of no meaning
/// where that is outside of the image.
#[inline(always)]
pub(super) fn within_edges<G: Group, const CELLS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    edges: EdgeWork<'_>,
) {
    let count = stride::<G, CELLS, ALL>(work) / G::LANES;
    let much = work.penalties.edges[1];
    let [here, next, last] = edges.guides;
    let above = G::cells_mut(edges.above).chunks_exact_mut(count);
    let below = G::cells_mut(edges.below).chunks_exact_mut(count);
    let columns = G::cells_mut(work.costs).chunks_exact_mut(count).zip(above.zip(below));
    for (x, (costs, (above, below))) in columns.enumerate() {
        let at_next = Choice::<G>::new(is_edge(here, next, x, much));
        let at_last = Choice::<G>::new(is_edge(next, last, x, much));
        for (cost, (above, below)) in costs.iter_mut().zip(above.iter_mut().zip(below)) {
            let (row, one, two) = (G::of(*above), G::of(*below), G::of(*cost));
            let both = one.average_up(at_last.of(one, two));
            *cost = row.average_up(at_next.of(row, both)).cell();
            *above = one.average_up(at_next.of(one, row)).cell();
            *below = two.cell();
        }
    }
}

/// Whether the brightness of a column changes `much` between two rows, or one of them is outside of the image.
#[inline(always)]
fn is_edge(row: Option<&[u8]>, next: Option<&[u8]>, x: usize, much: u8) -> bool {
    match (row.and_then(|row| row.get(x)), next.and_then(|next| next.get(x))) {
        (Some(a), Some(b)) => a.abs_diff(*b) >= much,
        _ => true,
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
