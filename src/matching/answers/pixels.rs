//! Pixel by pixel.

use super::{Rules, consistency, subpixel};
use crate::matching::kernels::Winner;
use crate::matching::scheme::Scheme;
use crate::units::{Disparity, PixelFlags};

/// [`consistency::offer`] of all winners.
#[cfg(not(stereopsis_dsp))]
#[inline(never)]
pub(super) fn offer(winners: &[Winner], right: &mut [u16]) {
    consistency::offer(winners.iter().map(|winner| (winner.key(), winner.disparity() as u8)), right);
}

/// The answers and flags of the columns that have a candidate.
#[inline(never)]
pub(super) fn answer<S: Scheme>(
    winners: &[Winner],
    right: &[u16],
    rules: &Rules,
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
    let min_disparity = u32::from(rules.min_disparity);
    for (x, ((answer, flags), &winner)) in answers.iter_mut().zip(flags).zip(winners).enumerate() {
        let disparity = winner.disparity() as u8;
        let said = flags
            .union(consistency::mismatch(disparity, consistency::kept(x, disparity, right), rules.tolerance))
            .union(rules.flat.when(winner.rises() == (0, 0)))
            .union(PixelFlags::CEILING.when(disparity == rules.ceiling));
        let none = 0u16.wrapping_sub(u16::from(said.intersects(rules.refused)));
        *answer =
            Disparity::from_raw(subpixel::refine(winner, min_disparity, u32::from(S::STEP)).raw() | none);
        *flags = said;
    }
}
