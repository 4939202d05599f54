//! Grid of cells that keeps the strongest corners of each.

use super::{Corner, Descriptor};

/// What a detector keeps of a corner, 40 bytes: with the descriptor that it gets once its patch is whole.
#[derive(Clone, Copy, Debug)]
pub struct CornerSlot {
    pub(super) corner: Corner,
    pub(super) descriptor: Descriptor,
}

impl CornerSlot {
    /// Not in use. All zeros.
    pub const EMPTY: Self = Self { corner: Corner::NONE, descriptor: Descriptor::NONE };

    fn is_free(&self) -> bool {
        self.corner.score == 0
    }
}

/// Puts a corner into a cell: into a free slot or the place of the weakest corner there, of equals the last
/// that came, if the new one is stronger. Whether a corner had to stay outside or leave.
pub(super) fn insert(cell: &mut [CornerSlot], corner: Corner) -> bool {
    // Most corners are no match for those that are there, which their scores say.
    if cell.iter().all(|slot| slot.corner.score >= corner.score) {
        return true;
    }
    // Corners come in reading order: of equals the one that is farther on is the later one.
    let Some(weakest) = cell.iter_mut().min_by_key(|slot| order(&slot.corner)) else { return true };
    let crowded = !weakest.is_free();
    weakest.corner = corner;
    crowded
}

/// Takes the strongest corner out of a cell, of equals the first that came.
pub(super) fn take_strongest(cell: &mut [CornerSlot]) -> Option<CornerSlot> {
    let strongest = cell.iter_mut().filter(|slot| !slot.is_free()).max_by_key(|slot| order(&slot.corner))?;
    Some(core::mem::replace(strongest, CornerSlot::EMPTY))
}

/// Stronger is more, and of equals the one that comes first in reading order.
fn order(corner: &Corner) -> u64 {
    let place = u32::from(corner.row) << 16 | u32::from(corner.column);
    u64::from(corner.score) << 32 | u64::from(!place)
}
