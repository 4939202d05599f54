//! Answers refused that spread, a block of pixels at a time.
//!
//! A bound is a minimum over the answers before a pixel, each raised by the slope for every pixel between, as
//! far back as no edge is crossed. In a register it is made by doubling, over one pixel, two, four and so on;
//! from one register to the next a number is carried. What is held is how far a bound is below `u16::MAX`: so
//! the zeros that are moved in stand for none.

use super::bits::{TOGETHER as BLOCK, in_block};
use super::half_words::HalfWords;
use crate::matching::backend::portable::fattening::refuse_marked;
use crate::matching::backend::work::FatteningWork;
use crate::matching::memory::slices::{part, part_mut};
use crate::units::Disparity;

/// How far below `u16::MAX` a bound is that no answer is beyond.
const NO_BOUND: u16 = 0;

/// [`Isa::refuse_fattening`](crate::matching::backend::Isa::refuse_fattening).
#[inline(always)]
pub(super) fn refuse<H: HalfWords>(mut work: FatteningWork<'_>) {
    let blocks = work.answers.len().div_ceil(BLOCK);
    // The bounds that answers on the left set, and those that answers on the right set. Each waits for its
    // own step before, but not for the other's.
    let (mut right, mut left) = (NO_BOUND, NO_BOUND);
    for block in 0..blocks {
        let opposite = blocks - 1 - block;
        let (ahead, back) = (Block::new(&work, block), Block::new(&work, opposite));
        let mut from_left = [right; BLOCK + 1];
        pass_on::<H, true>(&ahead.steps, &ahead.bounds, right, part_mut(&mut from_left, 1..));
        let mut from_right = [left; BLOCK + 1];
        pass_on::<H, false>(&back.steps, &back.bounds_of_no_edge(), left, part_mut(&mut from_right, ..BLOCK));
        (right, left) = (from_left[BLOCK], from_right[0]);
        // What comes from the left ends before an edge, what comes from the right behind it.
        for (bound, edge) in from_left.iter_mut().zip(&ahead.edges) {
            *bound &= !edge;
        }
        mark(&mut work, block, part(&from_left, ..BLOCK));
        mark(&mut work, opposite, part(&from_right, 1..));
    }
    refuse_marked(work);
}

/// Moves a bound over the pixels of a block, given how much it grows over each and which bound each sets, and
/// puts down what it is behind each of them.
#[inline(always)]
fn pass_on<H: HalfWords, const TO_RIGHT: bool>(
    steps: &[u16; BLOCK],
    bounds: &[u16; BLOCK],
    mut bound: u16,
    out: &mut [u16],
) {
    let registers = BLOCK / H::COUNT;
    for register in 0..registers {
        let at = H::COUNT * if TO_RIGHT { register } else { registers - 1 - register };
        let [mut steps, mut bounds] =
            [steps, bounds].map(|numbers| H::of_half_words(part(numbers, at..at + H::COUNT)));
        macro_rules! double {
            ($($by:literal)*) => {$(
                if $by < H::COUNT {
                    let [grown, before] = [steps, bounds].map(
                        #[inline(always)]
                        |numbers| if TO_RIGHT { numbers.on::<$by>() } else { numbers.back::<$by>() },
                    );
                    bounds = bounds.greater(before.differences(steps));
                    steps = steps.sums(grown);
                }
            )*};
        }
        double!(1 2 4 8 16);
        let out = part_mut(out, at..at + H::COUNT);
        bounds.greater(H::of_half_words(&[bound; BLOCK]).differences(steps)).put_half_words(out);
        bound = if TO_RIGHT { out.last() } else { out.first() }.copied().unwrap_or(NO_BOUND);
    }
}

/// What bounds are made of, of the pixels of a block; behind the row nothing is.
struct Block {
    /// All ones at edges.
    edges: [u16; BLOCK],
    /// How much a bound grows to the next pixel: at an edge beyond all.
    steps: [u16; BLOCK],
    /// The bound that each pixel's answer sets.
    bounds: [u16; BLOCK],
}

impl Block {
    #[inline(always)]
    fn new(work: &FatteningWork<'_>, block: usize) -> Self {
        let answers = in_block(work.answers, block, Disparity::NONE);
        let edges = in_block(work.edges, block, 0);
        let edges = edges.map(|edges| 0u16.wrapping_sub(u16::from(edges & work.row != 0)));
        Self {
            edges,
            steps: edges.map(|edge| edge | work.slope.raw()),
            bounds: answers.map(|answer| (!answer.raw()).saturating_sub(FatteningWork::TOLERANCE)),
        }
    }

    /// The bounds of pixels that are no edge.
    #[inline(always)]
    fn bounds_of_no_edge(&self) -> [u16; BLOCK] {
        core::array::from_fn(|i| self.bounds[i] & !self.edges[i])
    }
}

/// Marks the answers of a block that are beyond their bounds.
#[inline(always)]
fn mark(work: &mut FatteningWork<'_>, block: usize, bounds: &[u16]) {
    let row = part_mut(work.edges, block * BLOCK..).iter_mut().zip(part(work.answers, block * BLOCK..));
    for ((edges, answer), &bound) in row.zip(bounds) {
        *edges |= if !bound < answer.raw() { FatteningWork::REFUSED } else { 0 };
    }
}
