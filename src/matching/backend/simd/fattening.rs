//! Answers refused that spread, a block of pixels at a time: bounds go from pixel to pixel, and all else is
//! done side by side, in loops that the compiler turns into vectors.

use crate::matching::backend::portable::fattening::refuse_marked;
use crate::matching::backend::work::FatteningWork;
use crate::matching::memory::slices::{part, part_mut};

/// Pixels of a block.
const BLOCK: usize = 64;
/// A bound that no answer is beyond.
const NO_BOUND: u16 = u16::MAX;

/// [`Isa::refuse_fattening`](crate::matching::backend::Isa::refuse_fattening).
#[inline(always)]
pub(super) fn refuse(mut work: FatteningWork<'_>) {
    let blocks = work.answers.len().div_ceil(BLOCK);
    // The bounds that answers on the left set, and those that answers on the right set. Each waits for its
    // own step before, but not for the other's.
    let (mut right, mut left) = (u32::from(NO_BOUND), u32::from(NO_BOUND));
    for block in 0..blocks {
        let opposite = blocks - 1 - block;
        let (ahead, back) = (Block::new(&work, block), Block::new(&work, opposite));
        let (mut from_left, mut from_right) = ([NO_BOUND; BLOCK], [NO_BOUND; BLOCK]);
        let to_right = from_left.iter_mut().zip(ahead.steps.iter().zip(&ahead.bounds));
        let to_left = from_right.iter_mut().zip(back.steps.iter().zip(&back.bounds_of_no_edge));
        for ((from_left, (&step, &bound)), (from_right, (&step_back, &bound_back))) in
            to_right.zip(to_left.rev())
        {
            *from_left = pass_on(&mut right, step, bound);
            *from_right = pass_on(&mut left, step_back, bound_back);
        }
        // What comes from the left ends before an edge, what comes from the right behind it.
        for (bound, edge) in from_left.iter_mut().zip(&ahead.edges) {
            *bound |= edge;
        }
        mark(&mut work, block, &from_left);
        mark(&mut work, opposite, &from_right);
    }
    refuse_marked(work);
}

/// Moves a bound over a pixel that sets a bound of its own, and returns what it was.
#[inline(always)]
fn pass_on(bound: &mut u32, step: u16, own: u16) -> u16 {
    let before = *bound as u16;
    *bound = (*bound + u32::from(step)).min(u32::from(own));
    before
}

/// What bounds are made of, of the pixels of a block; behind the row nothing is.
struct Block {
    /// All ones at edges.
    edges: [u16; BLOCK],
    /// How much a bound grows to the next pixel: at an edge beyond all.
    steps: [u16; BLOCK],
    /// The bound that each pixel's answer sets, and the one that it sets if it is no edge.
    bounds: [u16; BLOCK],
    bounds_of_no_edge: [u16; BLOCK],
}

impl Block {
    #[inline(always)]
    fn new(work: &FatteningWork<'_>, block: usize) -> Self {
        let mut pixels = Self {
            edges: [0; BLOCK],
            steps: [work.slope.raw(); BLOCK],
            bounds: [NO_BOUND; BLOCK],
            bounds_of_no_edge: [NO_BOUND; BLOCK],
        };
        let row = part(work.answers, block * BLOCK..).iter().zip(part(work.edges, block * BLOCK..));
        for (i, (answer, edges)) in (0..BLOCK).zip(row) {
            let edge = 0u16.wrapping_sub(u16::from(edges & work.row != 0));
            let bound = answer.raw().saturating_add(FatteningWork::TOLERANCE);
            pixels.edges[i] = edge;
            pixels.steps[i] |= edge;
            pixels.bounds[i] = bound;
            pixels.bounds_of_no_edge[i] = bound | edge;
        }
        pixels
    }
}

/// Marks the answers of a block that are beyond their bounds.
#[inline(always)]
fn mark(work: &mut FatteningWork<'_>, block: usize, bounds: &[u16; BLOCK]) {
    let row = part_mut(work.edges, block * BLOCK..).iter_mut().zip(part(work.answers, block * BLOCK..));
    for ((edges, answer), &bound) in row.zip(bounds) {
        *edges |= if bound < answer.raw() { FatteningWork::REFUSED } else { 0 };
    }
}
