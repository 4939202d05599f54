//! Answers refused that spread, pixel by pixel.

use crate::matching::backend::loops::keep_scalar_loop;
use crate::matching::backend::work::FatteningWork;
use crate::units::{Disparity, PixelFlags};

/// A bound that no answer is beyond.
const NO_BOUND: u32 = 1 << 24;

/// Refuses the answers of a row that spread; an edge is where `row` is set. One pass to the right, one back.
///
/// An answer that the first pass refuses is over another one's bound, and so is all that its own bound would
/// refuse in the second.
#[inline(never)]
pub(in crate::matching::backend) fn refuse(work: FatteningWork<'_>) {
    let FatteningWork { answers, flags, edges, row, slope } = work;
    let slope = u32::from(slope.raw());
    let mut bound = NO_BOUND;
    for ((answer, flags), edges) in answers.iter_mut().zip(flags.iter_mut()).zip(edges.iter()) {
        keep_scalar_loop();
        bound |= if_edge(*edges, row);
        refuse_one(answer, flags, &mut bound, slope);
    }
    bound = NO_BOUND;
    for ((answer, flags), edges) in answers.iter_mut().zip(flags).zip(edges.iter()).rev() {
        keep_scalar_loop();
        refuse_one(answer, flags, &mut bound, slope);
        bound |= if_edge(*edges, row);
    }
}

/// Refuses an answer beyond the bound, and moves the bound one pixel on. Few are refused: a branch takes half
/// of the instructions.
#[inline(always)]
fn refuse_one(answer: &mut Disparity, flags: &mut PixelFlags, bound: &mut u32, slope: u32) {
    // The number of `Disparity::NONE` is over all answers: it lowers no bound to where answers are.
    let here = u32::from(answer.raw());
    if here > *bound {
        // No answer is refused as well, which shows in no flag: one more than it alone has the 17th bit.
        const UP: u32 = 16 - PixelFlags::UNTEXTURED.bits().trailing_zeros();
        let flag = (!(here + 1) >> UP) as u8 & PixelFlags::UNTEXTURED.bits();
        *flags = flags.union(PixelFlags::from_bits(flag));
        *answer = Disparity::NONE;
    }
    *bound = (*bound + slope).min(here + u32::from(FatteningWork::TOLERANCE));
}

/// Refuses the answers that are marked.
#[inline(always)]
pub(in crate::matching::backend) fn refuse_marked(work: FatteningWork<'_>) {
    let FatteningWork { answers, flags, edges, .. } = work;
    for ((answer, flags), edges) in answers.iter_mut().zip(flags).zip(edges) {
        let refused = 0u16.wrapping_sub(u16::from(*edges >> FatteningWork::REFUSED.trailing_zeros()));
        // What has no answer is not refused.
        *flags = flags.union(PixelFlags::UNTEXTURED.when(refused & !answer.raw() != 0));
        *answer = Disparity::from_raw(answer.raw() | refused);
    }
}

/// [`NO_BOUND`] at an edge, nothing elsewhere.
#[inline(always)]
fn if_edge(edges: u8, row: u8) -> u32 {
    u32::from(edges & row != 0) * NO_BOUND
}
