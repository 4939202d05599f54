//! The rectifier's content of the caller's memory, its size, and its errors as statuses.

use super::state::{Content, kind};
use super::{CRig, Status};
use crate::geometry::camera::{ImageSize, RectifiedRig};
use crate::geometry::rectify::RectifyError;
use crate::imaging::{RemapError, RemapPair, RemapTable};

/// Rectifier of raw lines in the caller's memory.
pub struct RectifierHandle {
    _opaque: [u8; 0],
}

/// Remaps of both cameras, and what may be asked of them.
pub(super) struct Rectifying<const W: usize, const N: usize, const SLOTS: usize> {
    pub pair: RemapPair<W, N, SLOTS>,
    pub is_started: bool,
    pub is_begun: bool,
}

impl<const W: usize, const N: usize, const SLOTS: usize> Content for Rectifying<W, N, SLOTS> {
    type Handle = RectifierHandle;
    const NEW: Self = Self { pair: RemapPair::empty(), is_started: false, is_begun: false };
    const KIND: usize = kind("rectifier", &[W, N, SLOTS]);
    const MOST_BYTES: usize = bytes(W, N, SLOTS);
}

/// Smallest cell of a rectifier's lattices as a power of two: 16 px are enough for strong lenses.
pub(super) const CELL: u32 = 4;
/// Largest number of bytes of sizes and padding beside lattices, lines and masks.
const FIXED_BYTES: usize = 80;

/// Returns the longest line of a rectifier in a library with lines of up to `width` pixels.
pub const fn rectifier_width(width: usize) -> usize {
    if width > ImageSize::MOST as usize { ImageSize::MOST as usize } else { width }
}

/// Returns the entries of each camera's table of a rectifier.
pub const fn rectifier_slots(width: usize, height: usize) -> usize {
    let (width, height) = (rectifier_width(width) as u16, rectifier_width(height) as u16);
    RemapTable::<0>::slots(ImageSize { width, height }, CELL)
}

/// Returns the bytes of memory that are enough for a rectifier on any target, as the macro
/// `STEREOPSIS_RECTIFIER_BYTES` does.
pub const fn rectifier_bytes(width: usize, height: usize, lines: usize) -> usize {
    bytes(width, lines, rectifier_slots(width, height))
}

const fn bytes(width: usize, lines: usize, slots: usize) -> usize {
    2 * (8 * slots + width * lines + width) + lines + FIXED_BYTES
}

impl<const W: usize, const N: usize, const SLOTS: usize> Rectifying<W, N, SLOTS> {
    /// Returns the remaps if a frame is under way.
    pub fn begun(&mut self) -> Result<&mut RemapPair<W, N, SLOTS>, Status> {
        if self.is_begun { Ok(&mut self.pair) } else { Err(Status::NotBegun) }
    }

    /// Takes the next raw lines as `accept` does, where some are due.
    pub fn take(&mut self, accept: impl FnOnce(&mut RemapPair<W, N, SLOTS>)) -> Result<Status, Status> {
        let pair = self.begun()?;
        if pair.next_row() >= pair.remaps()[0].table().size().height {
            return Ok(Status::FrameDone);
        }
        if !pair.wants_lines() {
            return Err(Status::LineWaiting);
        }
        accept(pair);
        Ok(if pair.wants_lines() { Status::NoRowYet } else { Status::Ok })
    }
}

impl From<RectifyError> for Status {
    fn from(e: RectifyError) -> Self {
        match e {
            RectifyError::Swapped(_) => Self::RectifySwapped,
            RectifyError::Forward | RectifyError::Apart => Self::RectifyPose,
            RectifyError::NothingShared | RectifyError::Camera(_) => Self::RectifyNothing,
            RectifyError::Alpha => Self::RectifyAlpha,
            RectifyError::Size => Self::RectifySize,
        }
    }
}

impl From<RemapError> for Status {
    fn from(e: RemapError) -> Self {
        match e {
            RemapError::Lines { .. } => Self::RectifyLines,
            RemapError::Width { .. } => Self::RectifySize,
            RemapError::BufferTooShort { .. } => Self::LineLength,
            RemapError::Early { .. } => Self::NoRowYet,
            RemapError::Late { .. } => Self::LineWaiting,
            RemapError::NoLineLeft => Self::FrameDone,
            RemapError::Table(_) => Self::RectifyBent,
        }
    }
}

impl From<RectifiedRig> for CRig {
    fn from(rig: RectifiedRig) -> Self {
        let (cx, cy) = rig.principal_point();
        Self {
            focal_px: rig.focal_px(),
            baseline_m: rig.baseline_m(),
            cx,
            cy,
            cx_right: cx + rig.disparity_offset_px(),
        }
    }
}
