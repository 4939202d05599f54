//! A row's costs, averaged within edges: `portable/sgm/edges.rs` says how.
#![allow(unsafe_code)]

use super::LANES;
use crate::matching::backend::portable::sgm::edges::edges_at;
use crate::matching::backend::work::{EdgeWork, PathWork};
use crate::matching::memory::slices::chunks_mut;
use core::arch::asm;

/// Makes the costs of the row of those that stand in their place before.
#[inline(always)]
pub(super) fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
    let (much, stride) = (work.penalties.edges[1], work.stride.max(LANES));
    let (above, below) = (chunks_mut(edges.above, stride), chunks_mut(edges.below, stride));
    let columns = chunks_mut(work.costs, stride).zip(above.zip(below));
    for (x, (costs, (above, below))) in columns.enumerate() {
        average(costs, above, below, edges_at(&edges.guides, x, much));
    }
}

/// A column: 15 instructions for 16 candidates. Beside an edge a number is averaged with itself.
#[inline(never)]
fn average(costs: &mut [u8], above: &mut [u8], below: &mut [u8], edges: [bool; 2]) {
    let groups = costs.len() / LANES;
    if groups == 0 || above.len() < costs.len() || below.len() < costs.len() {
        return;
    }
    let [at_next, at_last] = edges.map(|edge| 0u32.wrapping_sub(edge.into()));
    // SAFETY: whole vectors of the three columns are read and written.
    unsafe {
        asm!(
            "dls lr, {groups}",
            "2:",
            "vldrb.u8 q0, [{above}]",
            "vldrb.u8 q1, [{below}]",
            "vldrb.u8 q2, [{costs}]",
            "vmsr p0, {at_last}",
            "vpsel q3, q1, q2",
            "vrhadd.u8 q3, q1, q3",
            "vmsr p0, {at_next}",
            "vpsel q3, q0, q3",
            "vrhadd.u8 q3, q0, q3",
            "vpsel q0, q1, q0",
            "vrhadd.u8 q0, q1, q0",
            "vstrb.8 q3, [{costs}], #16",
            "vstrb.8 q0, [{above}], #16",
            "vstrb.8 q2, [{below}], #16",
            "le lr, 2b",
            costs = inout(reg) costs.as_mut_ptr() => _, above = inout(reg) above.as_mut_ptr() => _,
            below = inout(reg) below.as_mut_ptr() => _, at_next = in(reg) at_next, at_last = in(reg) at_last,
            groups = in(reg) groups, out("lr") _,
            out("q0") _, out("q1") _, out("q2") _, out("q3") _, options(nostack),
        );
    }
}
