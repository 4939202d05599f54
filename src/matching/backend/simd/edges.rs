//! Edges of a line, pixels side by side, in a loop that the compiler turns into vectors.

use crate::matching::backend::portable::edges::push_at;
use crate::matching::backend::work::FatteningWork;
use crate::matching::memory::slices::part_mut;

/// [`Isa::push_edges`](crate::matching::backend::Isa::push_edges): half-words.
#[inline(always)]
pub(super) fn push(edges: &mut [u8], lines: [&[u8]; 3], least: u16) {
    let width = edges.len();
    let [above, line, below] = lines.map(|line| line.windows(3));
    for (edges, ((above, line), below)) in part_mut(edges, 1..).iter_mut().zip(above.zip(line).zip(below)) {
        let sum =
            |column: usize| u16::from(above[column]) + 2 * u16::from(line[column]) + u16::from(below[column]);
        *edges = (*edges << 1 & !FatteningWork::REFUSED) | u8::from(sum(2).abs_diff(sum(0)) >= least);
    }
    for x in [0, width.wrapping_sub(1)].into_iter().take(width) {
        push_at(edges, lines, x, least);
    }
}
