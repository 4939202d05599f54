//! The winner of a pixel as another device hands it over: eight bytes, as they stand in memory.
//!
//! ```text
//! byte  holds
//! 0     cost of the disparity one below the winner (that above, where the winner is the smallest candidate)
//! 1     cost of the winner
//! 2     cost of the disparity one above (that below, where the winner is the largest candidate)
//! 3     the winner over the smallest disparity searched, px
//! 4     the disparity that the winner's partner in the right image keeps, likewise
//! 5     least cost of the candidates over two px from the winner; 255 where there is none or none was sought
//! 6     the row's number, its lowest eight bits
//! 7     check byte: exclusive or of bytes 0 to 6, all bits inverted
//! ```
//!
//! Beside a single candidate its own cost stands in bytes 0 and 2. In columns left of the smallest disparity,
//! which have no candidate, only bytes 6 and 7 mean anything.

use super::winner::Winner;

/// The winner of one pixel, computed by another device: eight bytes in the order that it is sent in.
///
/// ```
/// use stereopsis::matching::WinnerRecord;
/// let record = WinnerRecord::new(12, 30, [34, 41]).with_kept(12).with_second(90).sealed(7);
/// assert_eq!(record.bytes(), [34, 30, 41, 12, 12, 90, 7, !(34 ^ 30 ^ 41 ^ 12 ^ 12 ^ 90 ^ 7)]);
/// assert!(record.is_intact(7) && !record.is_intact(8));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub struct WinnerRecord([u8; 8]);

impl WinnerRecord {
    /// Bytes of a record.
    pub const BYTES: usize = 8;

    /// All bytes zero.
    pub const ZERO: Self = Self([0; 8]);

    /// A winner over the smallest disparity, its cost and the costs one below and one above; its partner
    /// keeps it, and no second best was sought.
    pub const fn new(disparity: u8, cost: u8, [below, above]: [u8; 2]) -> Self {
        Self([below, cost, above, disparity, disparity, u8::MAX, 0, 0])
    }

    /// A record of its bytes.
    pub const fn from_bytes(bytes: [u8; Self::BYTES]) -> Self {
        Self(bytes)
    }

    /// The bytes.
    pub const fn bytes(self) -> [u8; Self::BYTES] {
        self.0
    }

    /// The record with another disparity that the winner's partner keeps.
    pub const fn with_kept(self, kept: u8) -> Self {
        let [below, cost, above, disparity, _, second, row, check] = self.0;
        Self([below, cost, above, disparity, kept, second, row, check])
    }

    /// The record with the least cost of the candidates over two px from the winner.
    pub const fn with_second(self, second: u8) -> Self {
        let [below, cost, above, disparity, kept, _, row, check] = self.0;
        Self([below, cost, above, disparity, kept, second, row, check])
    }

    /// The record with its row's number and the check byte.
    pub const fn sealed(self, row: u16) -> Self {
        let [below, cost, above, disparity, kept, second, ..] = self.0;
        let row = row as u8;
        let check = !(below ^ cost ^ above ^ disparity ^ kept ^ second ^ row);
        Self([below, cost, above, disparity, kept, second, row, check])
    }

    /// Whether the record is of that row and its check byte fits.
    pub const fn is_intact(self, row: u16) -> bool {
        let [.., own, check] = self.0;
        let [.., fits] = self.sealed(own as u16).0;
        own == row as u8 && check == fits
    }

    /// The winner over the smallest disparity searched, px.
    pub const fn disparity(self) -> u8 {
        self.0[3]
    }

    /// The winner's cost.
    pub const fn cost(self) -> u8 {
        self.0[1]
    }

    /// The costs one below and one above.
    pub const fn beside(self) -> [u8; 2] {
        [self.0[0], self.0[2]]
    }

    /// The lowest eight bits of the row's number.
    pub const fn row(self) -> u8 {
        self.0[6]
    }

    /// The disparity that the winner's partner in the right image keeps, over the smallest one searched, px:
    /// that of the cheapest winner that chose it, of the leftmost among equals. In the methods along paths a
    /// winner costs four times the difference of the two pixels' grey levels more here, up to 255, unless
    /// noise is configured or the rows that a winner looks at end below the picture.
    pub const fn kept(self) -> u8 {
        self.0[4]
    }

    /// Least cost of the candidates over two px from the winner, 255 where there is none.
    pub const fn second(self) -> u8 {
        self.0[5]
    }

    /// The winner alone.
    #[inline(always)]
    pub(in crate::matching) fn winner(self) -> Winner {
        let [below, above] = self.beside();
        Winner::new(self.cost(), self.disparity(), (below, above))
    }

    /// Whether a search over so many `candidates` can have this winner.
    #[inline(always)]
    pub(in crate::matching) fn is_possible(self, candidates: usize) -> bool {
        let [below, above] = self.beside();
        usize::from(self.disparity()) < candidates && self.cost() <= below.min(above).min(self.second())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_the_record() {
        let record = WinnerRecord::new(12, 30, [34, 41]);
        assert_eq!(record.bytes(), [34, 30, 41, 12, 12, 255, 0, 0]);
        let record = record.with_kept(9).with_second(90).sealed(0x307);
        assert_eq!(record.bytes(), [34, 30, 41, 12, 9, 90, 7, !(34 ^ 30 ^ 41 ^ 12 ^ 9 ^ 90 ^ 7)]);
        assert_eq!((record.disparity(), record.cost(), record.beside()), (12, 30, [34, 41]));
        assert_eq!((record.kept(), record.second(), record.row()), (9, 90, 7));
        assert_eq!(WinnerRecord::from_bytes(record.bytes()), record);
        assert_eq!(record.winner(), Winner::new(30, 12, (34, 41)));
    }

    #[test]
    fn a_record_of_another_row_or_with_another_bit_is_not_intact() {
        let record = WinnerRecord::new(12, 30, [34, 41]).sealed(7);
        assert!(record.is_intact(7) && record.is_intact(0x107) && !record.is_intact(6));
        for (byte, bit) in (0..8).flat_map(|byte| (0..8).map(move |bit| (byte, bit))) {
            let mut bytes = record.bytes();
            bytes[byte] ^= 1 << bit;
            let row = u16::from(bytes[6]);
            assert!(!WinnerRecord::from_bytes(bytes).is_intact(row), "byte {byte}, bit {bit}");
        }
    }

    #[test]
    fn a_winner_costs_least_and_is_a_candidate() {
        let costs = [0, 1, 29, 30, 31, 254, 255];
        for (below, above) in costs.into_iter().flat_map(|below| costs.map(|above| (below, above))) {
            for second in costs {
                let record = WinnerRecord::new(12, 30, [below, above]).with_second(second);
                let is_least = below >= 30 && above >= 30 && second >= 30;
                assert_eq!(record.is_possible(13), is_least, "{record:?}");
                assert!(!record.is_possible(12), "{record:?}");
            }
        }
    }
}
