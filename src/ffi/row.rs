//! A row of results, as C has it.

use crate::matching;
use crate::units::{Disparity, PixelFlags};

/// The disparity that means "no answer".
pub const STEREOPSIS_NONE: u16 = 0xFFFF;
/// Steps of a disparity in one pixel.
pub const STEREOPSIS_STEPS_PER_PX: u16 = 32;

/// No candidate lies inside the right image.
pub const STEREOPSIS_FLAG_OUTSIDE: u8 = 1;
/// The winner is the largest disparity searched: the surface may be nearer.
pub const STEREOPSIS_FLAG_CEILING: u8 = 2;
/// The winner costs as much as both its neighbours, or too few pixels of the window have a gradient.
pub const STEREOPSIS_FLAG_UNTEXTURED: u8 = 4;
/// Another disparity matches nearly as well.
pub const STEREOPSIS_FLAG_AMBIGUOUS: u8 = 8;
/// The right image's pixel found a better partner elsewhere.
pub const STEREOPSIS_FLAG_MISMATCH: u8 = 16;
/// Too few answers around it are of its surface.
pub const STEREOPSIS_FLAG_SPECKLE: u8 = 32;
/// The answer is not the pixel's own but the farther one of those on both sides of a small gap in the row.
pub const STEREOPSIS_FLAG_FILLED: u8 = 64;
/// A line near the row was lost (`stereopsis_push_lost`). Beside an answer: the line can have touched it.
pub const STEREOPSIS_FLAG_DAMAGED: u8 = 128;

/// The constants are literals, so that the header has them; these are what they say.
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

/// A row of results. The arrays stand in the matcher's memory and hold until the next call with its handle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CRow {
    /// The row in the image, from 0.
    pub index: u16,
    /// Pixels in the row: the length of the arrays.
    pub width: u16,
    /// A disparity for each column in 1/32 px, `STEREOPSIS_NONE` for no answer.
    pub disparities: *const u16,
    /// The `STEREOPSIS_FLAG_` bits of each column: why there is no answer, or none of its own.
    pub flags: *const u8,
    /// How sure the answer of each column is, 1 to 207, 0 for no answer; null unless the configuration's
    /// `confidence` asked for it. The number puts answers in order, the wrong ones first; it is no
    /// probability.
    pub confidences: *const u8,
}

impl CRow {
    /// No row.
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
