//! What the paths work with, at places that a vector's load or store reaches from one address.
//!
//! ```text
//! from     0                 STRIDE   + 15   + 16            2 STRIDE + 16    + 32           3 STRIDE + 32
//!          the disparities            far    the path        far              the sums       a byte
//! ```

use crate::matching::backend::mve::rows::fill;

/// Bytes between two of them; the last one before each is beside its first lane.
const GAP: usize = 16;
/// How far the [middle](Room::middle) is behind the path's first byte.
const BEHIND: usize = 32;

/// The room: the disparities of the lanes, a path's costs, and the sums that a winner is selected by.
pub(super) struct Room<'a, const STRIDE: usize>(&'a mut [u8]);

impl<'a, const STRIDE: usize> Room<'a, STRIDE> {
    /// Where the path is, the sums, and the disparities, in bytes from the [middle](Self::middle).
    pub const PATH_AT: i32 = -(BEHIND as i32);
    pub const SUMS_AT: i32 = Self::PATH_AT + (STRIDE + GAP) as i32;
    pub const LANES_AT: i32 = Self::PATH_AT - (STRIDE + GAP) as i32;

    /// With no path; none if there is too little room.
    pub fn new(room: &'a mut [u8]) -> Option<Self> {
        let room = room.get_mut(..3 * STRIDE + 2 * GAP + 1)?;
        fill(room, u8::MAX);
        for (disparity, place) in (0..STRIDE as u8).rev().zip(room.iter_mut()) {
            *place = disparity;
        }
        Some(Self(room))
    }

    /// Makes the path one that comes from nowhere: no disparity costs anything.
    pub fn begin(&mut self) {
        if let Some(path) = self.0.get_mut(STRIDE + GAP..2 * STRIDE + GAP) {
            fill(path, 0);
        }
    }

    /// Where the path's costs are, by a pointer to all of the room.
    pub fn path(&mut self) -> *mut u8 {
        self.0.as_mut_ptr().wrapping_add(STRIDE + GAP)
    }

    /// The address from which everything is near.
    pub fn middle(&mut self) -> *mut u8 {
        self.path().wrapping_add(BEHIND)
    }

    /// The sums.
    pub fn sums(&mut self) -> &mut [u8] {
        self.0.get_mut(2 * (STRIDE + GAP)..3 * STRIDE + 2 * GAP).unwrap_or_default()
    }
}
