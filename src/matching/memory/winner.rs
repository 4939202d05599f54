//! The winner of one pixel, in a word (winner-take-all).
#![allow(dead_code, reason = "each target uses the form that suits it")]

/// The best disparity of a pixel, in a word: from the lowest byte up the cost below it, its own, the cost
/// above it, and the disparity.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(transparent)]
pub struct Winner(u32);

impl Winner {
    /// Where there is no candidate.
    pub const NONE: Self = Self(0);

    /// A winner over the smallest disparity, with the costs one below and one above. Where one of these is no
    /// candidate, the other stands for it; where none is, the winner does.
    #[inline(always)]
    pub fn new(cost: u8, disparity: u8, (below, above): (u8, u8)) -> Self {
        Self(u32::from_le_bytes([below, cost, above, disparity]))
    }

    /// [`Self::new`] of a word with the three costs from the lowest byte up, whatever its highest byte is.
    #[inline(always)]
    pub fn of_costs(costs: u32, disparity: u8) -> Self {
        Self(costs & 0x00ff_ffff | u32::from(disparity) << 24)
    }

    /// The costs one below and one above.
    #[inline(always)]
    pub fn beside(self) -> (u8, u8) {
        (self.0 as u8, (self.0 >> 16) as u8)
    }

    /// Returns the winner with other costs beside it.
    #[inline(always)]
    pub fn with_beside(self, beside: (u8, u8)) -> Self {
        Self::new(self.cost(), self.disparity() as u8, beside)
    }

    /// Returns the disparity over the smallest one searched: of those with the least cost the smallest. Means
    /// nothing in columns without a candidate, as all the rest.
    #[inline(always)]
    pub fn disparity(self) -> u32 {
        self.0 >> 24
    }

    /// Returns the cost.
    #[inline(always)]
    pub fn cost(self) -> u8 {
        (self.0 >> 8) as u8
    }

    /// Returns the cost above 8 bits of [`Self::disparity`].
    #[inline(always)]
    pub fn key(self) -> u32 {
        self.0 & 0xff00 | self.0 >> 24
    }

    /// How much more the disparities one below and one above cost.
    #[inline(always)]
    pub fn rises(self) -> (u32, u32) {
        // The winner costs least: nothing wraps.
        let cost = u32::from(self.cost());
        ((self.0 & 0xff).wrapping_sub(cost), (self.0 >> 16 & 0xff).wrapping_sub(cost))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_form_gives_what_went_in() {
        let bytes = [0, 1, 0x0f, 0x55, 0x80, 0xaa, 0xff];
        for (cost, disparity) in bytes.into_iter().flat_map(|cost| bytes.map(|disparity| (cost, disparity))) {
            for (below, above) in bytes.into_iter().flat_map(|below| bytes.map(|above| (below, above))) {
                let winner = Winner::new(cost, disparity, (below, above));
                let costs = u32::from_le_bytes([below, cost, above, !disparity]);
                assert_eq!(Winner::of_costs(costs, disparity), winner);
                assert_eq!(Winner::new(cost, disparity, (1, 2)).with_beside((below, above)), winner);
                assert_eq!(winner.beside(), (below, above));
                assert_eq!((winner.cost(), winner.disparity()), (cost, u32::from(disparity)));
                assert_eq!(winner.key(), 256 * u32::from(cost) + u32::from(disparity));
                if cost <= below.min(above) {
                    assert_eq!(winner.rises(), (u32::from(below - cost), u32::from(above - cost)));
                }
            }
        }
    }
}
