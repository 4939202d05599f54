//! Row of results in C.

use crate::matching;
use crate::units::{Disparity, PixelFlags};

/// Disparity that means "no answer".
pub const STEREOPSIS_NONE: u16 = 0xFFFF;
/// Steps of a disparity per pixel.
pub const STEREOPSIS_STEPS_PER_PX: u16 = 32;

/// Flag: no candidate lies inside the right image, or a camera did not see the pixel.
pub const STEREOPSIS_FLAG_OUTSIDE: u8 = 1;
/// Flag: the winner is the largest disparity searched, or its partner is the first column of the right image;
/// the surface may be nearer, or the right camera may not see it.
pub const STEREOPSIS_FLAG_CEILING: u8 = 2;
/// Flag: the winner costs as much as both its neighbours, too few pixels of the window have a gradient, or
/// the answer had spread from an edge over a place without any.
pub const STEREOPSIS_FLAG_UNTEXTURED: u8 = 4;
/// Flag: another disparity matches nearly as well, the answer was less sure than asked for, or it stood on a
/// pattern that repeats.
pub const STEREOPSIS_FLAG_AMBIGUOUS: u8 = 8;
/// Flag: the right image's pixel has a better partner elsewhere.
pub const STEREOPSIS_FLAG_MISMATCH: u8 = 16;
/// Flag: too few answers around the pixel belong to its surface.
pub const STEREOPSIS_FLAG_SPECKLE: u8 = 32;
/// Flag: the answer is the farther one of those on both sides of a small gap in the row.
pub const STEREOPSIS_FLAG_FILLED: u8 = 64;
/// Flag: the pixel depends on a line that was lost (`stereopsis_push_lost`); an answer may be affected.
pub const STEREOPSIS_FLAG_DAMAGED: u8 = 128;

/// The constants are literals for the header; these assertions check their values.
const _: () = {
    assert!(STEREOPSIS_NONE == Disparity::NONE.raw());
    assert!(STEREOPSIS_STEPS_PER_PX == Disparity::ONE);
    assert!(STEREOPSIS_FLAG_OUTSIDE == PixelFlags::OUTSIDE.bits());
    assert!(STEREOPSIS_FLAG_CEILING == PixelFlags::CEILING.bits());
    assert!(STEREOPSIS_FLAG_UNTEXTURED == PixelFlags::UNTEXTURED.bits());
    assert!(STEREOPSIS_FLAG_AMBIGUOUS == PixelFlags::AMBIGUOUS.bits());
    assert!(STEREOPSIS_FLAG_MISMATCH == PixelFlags::MISMATCH.bits());
    assert!(STEREOPSIS_FLAG_SPECKLE == PixelFlags::SPECKLE.bits());
    assert!(STEREOPSIS_FLAG_FILLED == PixelFlags::FILLED.bits());
    assert!(STEREOPSIS_FLAG_DAMAGED == PixelFlags::DAMAGED.bits());
};

/// Row of results, with arrays in the matcher's memory that hold until the next call with its handle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CRow {
    /// Row in the image, from 0.
    pub index: u16,
    /// Number of pixels, the length of the arrays.
    pub width: u16,
    /// Disparities of the columns in 1/32 px, `STEREOPSIS_NONE` for no answer.
    pub disparities: *const u16,
    /// `STEREOPSIS_FLAG_` bits of the columns.
    pub flags: *const u8,
    /// Confidences of the columns, 1 to 207, 0 for no answer; null unless the configuration's `confidence` or
    /// `min_confidence` is over 0. They rank answers, likely wrong ones first, and are no probabilities.
    pub confidences: *const u8,
}

impl CRow {
    /// The empty row.
    pub(super) const NONE: Self = Self {
        index: 0,
        width: 0,
        disparities: core::ptr::null(),
        flags: core::ptr::null(),
        confidences: core::ptr::null(),
    };
}

impl From<matching::Row<'_>> for CRow {
    fn from(row: matching::Row<'_>) -> Self {
        let (disparities, flags, confidences) = (row.disparities(), row.flags(), row.confidences());
        Self {
            index: row.index(),
            // A row is as wide as the configuration says, in 16 bits.
            width: disparities.len().min(flags.len()) as u16,
            disparities: disparities.as_ptr().cast(),
            flags: flags.as_ptr().cast(),
            confidences: if confidences.is_empty() { core::ptr::null() } else { confidences.as_ptr() },
        }
    }
}
