//! Winner of one pixel in C, as another device hands it over.
#![allow(unsafe_code)]

use super::Status;
use crate::matching::WinnerRecord;

/// Winner of one pixel, computed by another device: eight bytes in the order that they are sent in.
///
/// In columns left of the smallest disparity, which have no candidate, only `row` and `check` mean anything.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CWinner {
    /// Cost of the disparity one below the winner; of that above, where the winner is the smallest candidate;
    /// the winner's own, where it is the only one.
    pub below: u8,
    /// Cost of the winner.
    pub cost: u8,
    /// Cost of the disparity one above the winner; of that below, where the winner is the largest candidate.
    pub above: u8,
    /// Winner over the smallest disparity searched, px.
    pub disparity: u8,
    /// Disparity that the winner's partner in the right image keeps, likewise: that of the cheapest winner
    /// that chose it, of the leftmost among equals. Methods along paths add four times the difference of the
    /// two pixels' grey levels to a winner's cost here, up to 255, unless noise is configured or the rows
    /// that a winner looks at end below the picture.
    pub kept: u8,
    /// Least cost of the candidates over two px from the winner; 255 where there is none or none was sought.
    pub second: u8,
    /// Number of the row, its lowest eight bits.
    pub row: u8,
    /// Exclusive or of the seven bytes before, all bits inverted: `stereopsis_winners_seal` writes it.
    pub check: u8,
}

/// Writes a row's check bytes and its number.
///
/// # Safety
///
/// `winners` is null or points to `count` winners.
pub unsafe fn winners_seal(winners: *mut CWinner, count: usize, row: u16) -> Status {
    if winners.is_null() {
        return Status::Null;
    }
    if count > usize::from(u16::MAX) {
        return Status::TooMany;
    }
    // SAFETY: the caller's promise; a winner is a record's bytes.
    let winners = unsafe { core::slice::from_raw_parts_mut(winners.cast::<WinnerRecord>(), count) };
    winners.iter_mut().for_each(|winner| *winner = winner.sealed(row));
    Status::Ok
}
