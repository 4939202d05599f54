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
    /// What each right column keeps: the cost above 8 bits of the winner, over the smallest disparity; all ones while
    /// nobody offered.
    pub right: &'a mut [u32],
    /// The smallest disparity, px.
    pub min_disparity: usize,
}

impl Consistency<'_> {
    /// Forgets the row before.
    pub(super) fn begin(&mut self) {
        self.right.fill(u32::MAX);
    }

    /// Notes the winners of the columns from `first` on and offers them to their partners. The first of equal costs
    /// stays.
    #[inline(never)]
    pub(super) fn offer(&mut self, first: usize, winners: &[Winner]) {
        let left = self.left.get_mut(first..).unwrap_or_default();
        // Where a column's candidates begin; left of the smallest disparity it wraps, and there is no partner.
        let mut place = first.wrapping_sub(self.min_disparity);
        for (left, winner) in left.iter_mut().zip(winners) {
            *left = winner.disparity() as u8;
            if let Some(kept) = self.right.get_mut(place.wrapping_sub(winner.disparity() as usize)) {
                // Of one partner, those who come later are farther away: their disparity is larger.
                *kept = (*kept).min(winner.key());
            }
            place = place.wrapping_add(1);
        }
    }

    /// Whether the partner of left column `x`, whose winner is `disparity`, keeps something else by over `tolerance` px.
    #[inline(always)]
    pub(super) fn mismatch(&self, x: usize, disparity: u8, tolerance: u8) -> PixelFlags {
        let partner = x.wrapping_sub(self.min_disparity + usize::from(disparity));
        let kept = self.right.get(partner).map_or(disparity, |&kept| kept as u8);
        let apart = u32::from(kept).wrapping_sub(u32::from(disparity)).wrapping_add(u32::from(tolerance));
        PixelFlags::MISMATCH.when(apart > 2 * u32::from(tolerance))
    }
}
