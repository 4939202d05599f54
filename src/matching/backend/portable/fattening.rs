//! Answers refused that spread, pixel by pixel.

use crate::matching::backend::loops::keep_scalar_loop;
use crate::matching::backend::work::FatteningWork;
use crate::units::{Disparity, PixelFlags};
use core::cell::Cell;

/// A bound that no answer is beyond.
const NO_BOUND: u32 = 1 << 24;

/// Refuses the answers of a row that spread; an edge is where `row` is set.
#[inline(never)]
pub(in crate::matching::backend) fn refuse(work: FatteningWork<'_>) {
    let edges = Cell::from_mut(&mut *work.edges).as_slice_of_cells();
    mark(work.answers, edges, work.row, u32::from(work.slope.raw()));
    refuse_marked(work);
}

/// Refuses the answers that are marked.
#[inline(always)]
pub(in crate::matching::backend) fn refuse_marked(work: FatteningWork<'_>) {
    let FatteningWork { answers, flags, edges, .. } = work;
    for ((answer, flags), edges) in answers.iter_mut().zip(flags).zip(edges) {
        keep_scalar_loop();
        let refused = 0u16.wrapping_sub(u16::from(*edges >> FatteningWork::REFUSED.trailing_zeros()));
        // What has no answer is not refused.
        *flags = flags.union(PixelFlags::UNTEXTURED.when(refused & !answer.raw() != 0));
        *answer = Disparity::from_raw(answer.raw() | refused);
    }
}

/// Marks the answers that are beyond the bound of those on their left or of those on their right. Both passes
/// run side by side: each waits for its own step before, but not for the other's.
fn mark(answers: &[Disparity], edges: &[Cell<u8>], row: u8, slope: u32) {
    let (mut right, mut left) = (NO_BOUND, NO_BOUND);
    let pixels = answers.iter().zip(edges);
    for ((to_right, edge_right), (to_left, edge_left)) in pixels.clone().zip(pixels.rev()) {
        keep_scalar_loop();
        right |= if_edge(edge_right.get(), row);
        mark_one(*to_right, edge_right, &mut right, slope);
        mark_one(*to_left, edge_left, &mut left, slope);
        left |= if_edge(edge_left.get(), row);
    }
}

/// Marks an answer beyond the bound, and moves the bound one pixel on.
#[inline(always)]
fn mark_one(answer: Disparity, edges: &Cell<u8>, bound: &mut u32, slope: u32) {
    // The number of `Disparity::NONE` is over all answers: it lowers no bound to where answers are.
    let here = u32::from(answer.raw());
    edges
        .set(edges.get() | (bound.wrapping_sub(here) >> 31 << FatteningWork::REFUSED.trailing_zeros()) as u8);
    *bound = (*bound + slope).min(here + u32::from(FatteningWork::TOLERANCE));
}

/// [`NO_BOUND`] at an edge, nothing elsewhere.
#[inline(always)]
fn if_edge(edges: u8, row: u8) -> u32 {
    u32::from(edges & row != 0) * NO_BOUND
}
