//! The left-right check, from the left winners alone.
//!
//! Each column of the right image keeps the cheapest of the left pixels that chose it. A left pixel whose disparity is
//! far from what its partner kept was beaten there: it is occluded or wrong. Nothing is searched a second time, and on
//! real pairs the check refuses fewer right answers than one against the right image's own winners.

use super::kernels::Winner;
use crate::units::PixelFlags;

/// One row's winners, seen from both sides. All slices have the row's width.
pub(super) struct Consistency<'a> {
    /// Winner of each left column, over the smallest disparity.
    pub left: &'a mut [u8],
    /// Winner that each right column keeps, over the smallest disparity.
    pub right: &'a mut [u8],
    /// Its cost; `u16::MAX` while nobody offered.
    pub right_cost: &'a mut [u16],
    /// The smallest disparity, px.
    pub min_disparity: usize,
}

impl Consistency<'_> {
    /// Forgets the row before.
    pub(super) fn begin(&mut self) {
        self.right_cost.fill(u16::MAX);
    }

    /// Notes the winners of the left columns from `x` on and offers each to its partner. The first of equal costs stays.
    #[inline(always)]
    pub(super) fn offer(&mut self, x: usize, winners: &[Winner]) {
        let left = self.left.get_mut(x..).unwrap_or_default();
        for ((x, left), winner) in (x..).zip(left).zip(winners) {
            *left = winner.disparity as u8;
            let partner = x.wrapping_sub(self.min_disparity + usize::from(winner.disparity));
            if let (Some(cost), Some(kept)) = (self.right_cost.get_mut(partner), self.right.get_mut(partner)) {
                let better = winner.candidates > 0 && winner.cost < *cost;
                *cost = if better { winner.cost } else { *cost };
                *kept = if better { *left } else { *kept };
            }
        }
    }

    /// Whether the partner of left column `x` keeps something else than `x`'s winner, by over `tolerance` px.
    #[inline(always)]
    pub(super) fn mismatch(&self, x: usize, tolerance: u8) -> PixelFlags {
        let disparity = self.left.get(x).copied().unwrap_or(0);
        let partner = x.wrapping_sub(self.min_disparity + usize::from(disparity));
        let kept = self.right.get(partner).copied().unwrap_or(disparity);
        PixelFlags::MISMATCH.when(kept.abs_diff(disparity) > tolerance)
    }
}
