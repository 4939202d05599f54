//! A row's costs, averaged within edges: `portable/sgm/edges.rs` says how.
#![allow(unsafe_code)]

use super::LANES;
use crate::matching::backend::portable::sgm::edges::edges_at;
use crate::matching::backend::work::{EdgeWork, PathWork};
use crate::matching::memory::slices::chunks_mut;
use core::arch::asm;

/// Makes the costs of the row of those that stand in their place before.
#[inline(always)]
pub(super) fn within_edges<const STRIDE: usize>(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
    let much = work.penalties.edges[1];
    let (above, below) = (chunks_mut(edges.above, STRIDE), chunks_mut(edges.below, STRIDE));
    let columns = chunks_mut(work.costs, STRIDE).zip(above.zip(below));
    for (x, (costs, (above, below))) in columns.enumerate() {
        if let (Some(costs), Some(above), Some(below)) =
            (costs.first_chunk_mut(), above.first_chunk_mut(), below.first_chunk_mut())
        {
            average::<STRIDE>(costs, above, below, edges_at(&edges.guides, x, much));
        }
    }
}

/// A column: 14 instructions for 16 candidates. Beside an edge a number is averaged with itself.
#[inline(never)]
fn average<const STRIDE: usize>(
    costs: &mut [u8; STRIDE],
    above: &mut [u8; STRIDE],
    below: &mut [u8; STRIDE],
    edges: [bool; 2],
) {
    let [at_next, at_last] = edges.map(|edge| 0u32.wrapping_sub(edge.into()));
    // SAFETY: whole vectors of the three columns are read and written.
    unsafe {
        asm!(
            ".irp v, 0, 1, 2, 3",
            ".if \\v < {groups}",
            "vldrb.u8 q0, [{above}, #16 * \\v]",
            "vldrb.u8 q1, [{below}, #16 * \\v]",
            "vldrb.u8 q2, [{costs}, #16 * \\v]",
            "vmsr p0, {at_last}",
            "vpsel q3, q1, q2",
            "vrhadd.u8 q3, q1, q3",
            "vmsr p0, {at_next}",
            "vpsel q3, q0, q3",
            "vrhadd.u8 q3, q0, q3",
            "vpsel q0, q1, q0",
            "vrhadd.u8 q0, q1, q0",
            "vstrb.8 q3, [{costs}, #16 * \\v]",
            "vstrb.8 q0, [{above}, #16 * \\v]",
            "vstrb.8 q2, [{below}, #16 * \\v]",
            ".endif",
            ".endr",
            costs = in(reg) costs.as_mut_ptr(), above = in(reg) above.as_mut_ptr(),
            below = in(reg) below.as_mut_ptr(), at_next = in(reg) at_next, at_last = in(reg) at_last,
            groups = const STRIDE / LANES,
            out("q0") _, out("q1") _, out("q2") _, out("q3") _, options(nostack),
        );
    }
}
