//! The left-right check, from the left winners alone.
//!
//! Each column of the right image keeps the cheapest of the left pixels that chose it. A left pixel whose disparity is
//! far from what its partner kept was beaten there: it is occluded or wrong. Nothing is searched a second time, and on
//! real pairs the check refuses fewer right answers than one against the right image's own winners.

use super::kernels::Winner;
use crate::units::PixelFlags;

/// What each right column keeps: the cost above 8 bits of the winner, over the smallest disparity; all ones while nobody
/// offered.
pub(super) struct Consistency<'a>(pub &'a mut [u16]);

impl Consistency<'_> {
    /// Forgets the row before, and offers every winner of this one to its partner. The first of equal costs stays.
    /// `winners` are those of the columns that have a candidate: the first one's is the first right column.
    #[inline(never)]
    pub(super) fn offer(&mut self, winners: &[Winner]) {
        self.0.fill(u16::MAX);
        for (x, winner) in winners.iter().enumerate() {
            if let Some(kept) = self.0.get_mut(x.wrapping_sub(winner.disparity() as usize)) {
                // Of one partner, those who come later are farther away: their disparity is larger.
                *kept = (*kept).min(winner.key());
            }
        }
    }

    /// Whether the partner of a winner, that of the `x`-th column with a candidate, keeps something else by over
    /// `tolerance` px.
    #[inline(always)]
    pub(super) fn mismatch(&self, x: usize, winner: Winner, tolerance: u8) -> PixelFlags {
        let disparity = winner.disparity();
        let kept = self.0.get(x.wrapping_sub(disparity as usize)).map_or(disparity, |&kept| u32::from(kept & 0xff));
        let apart = kept.wrapping_sub(disparity).wrapping_add(u32::from(tolerance));
        PixelFlags::MISMATCH.when(apart > 2 * u32::from(tolerance))
    }
}
