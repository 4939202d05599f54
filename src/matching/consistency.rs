//! The left-right check, from the left winners alone.
//!
//! Each column of the right image keeps the cheapest of the left pixels that chose it. A left pixel whose disparity is
//! far from what its partner kept was beaten there: it is occluded or wrong. Nothing is searched a second time, and on
//! real pairs the check refuses fewer right answers than one against the right image's own winners.

use super::kernels::Winner;
use crate::units::PixelFlags;
use core::slice;

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

    /// Takes the row's winners, from the first column on.
    pub(super) fn offers(&mut self) -> Offers<'_> {
        // Where a column's candidates begin, counted modulo the size of a place.
        Offers { left: self.left.iter_mut(), right: self.right, place: 0usize.wrapping_sub(self.min_disparity) }
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

/// A row's winners, one after the other.
pub(super) struct Offers<'a> {
    left: slice::IterMut<'a, u8>,
    right: &'a mut [u32],
    place: usize,
}

impl Offers<'_> {
    /// Notes the winner of the next column and offers it to its partner. The first of equal costs stays.
    #[inline(always)]
    pub(super) fn next(&mut self, winner: &Winner) {
        if let Some(left) = self.left.next() {
            *left = winner.disparity() as u8;
        }
        // A pixel without candidates lies left of the smallest disparity: it has no partner.
        let partner = self.place.wrapping_sub(winner.disparity() as usize);
        if let Some(kept) = self.right.get_mut(partner) {
            // Of one partner, those who come later are farther away: their disparity is larger.
            *kept = (*kept).min(winner.key());
        }
        self.place = self.place.wrapping_add(1);
    }
}
