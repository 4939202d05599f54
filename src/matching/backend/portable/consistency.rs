//! The left-right check, from the left winners alone.
//!
//! The check itself is described in `left_right` of [`stages`](crate::matching::stages).
//!
//! A right column keeps the cost above 8 bits of the winner, over the smallest disparity; all ones while
//! nobody offered.

use crate::matching::backend::loops::{fill_row, keep_loop};
use crate::units::PixelFlags;

/// Offers every winner to its partner, each by its cost above 8 bits of its disparity, and that disparity.
/// The first of equal costs stays. The first winner is that of the first column that has a candidate, whose
/// partner is the first right column.
#[inline(always)]
pub(super) fn offer(winners: impl Iterator<Item = (u32, u8)>, right: &mut [u16]) {
    fill_row(right, u16::MAX);
    for (x, (key, disparity)) in winners.enumerate() {
        keep_loop();
        if let Some(kept) = right.get_mut(x.wrapping_sub(usize::from(disparity))) {
            // Of one partner, those who come later are farther away: their disparity is larger.
            *kept = key.min(u32::from(*kept)) as u16;
        }
    }
}

/// The cost of an offer whose pixels are compared: the winner's and four times what the two pixels differ by,
/// 255 at most. Costs along paths are those of a surface: left of a near one they make pixels cheap that the
/// right camera does not see. What these look like tells them from those it sees.
#[inline(always)]
pub(in crate::matching) fn compared_cost(cost: u8, left: u8, partner: u8) -> u8 {
    let apart = (i32::from(left) - i32::from(partner)).unsigned_abs();
    (u32::from(cost) + 4 * apart).min(255) as u8
}

/// The disparity that the partner of winner `x` keeps.
#[inline(always)]
pub(super) fn kept(x: usize, disparity: u8, right: &[u16]) -> u8 {
    right.get(x.wrapping_sub(usize::from(disparity))).map_or(disparity, |&kept| kept as u8)
}

/// Whether a winner's partner keeps something else by over `tolerance` px.
#[inline(always)]
pub(super) fn mismatch(disparity: u8, kept: u8, tolerance: u8) -> PixelFlags {
    PixelFlags::MISMATCH.when(disparity.max(kept) - disparity.min(kept) > tolerance)
}
