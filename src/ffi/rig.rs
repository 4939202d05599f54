//! Rectified rig and depths in C.
#![allow(unsafe_code)]

use super::Status;
use super::state::checked;
use super::status::either;
use crate::depth::{DepthError, DepthScale};
use crate::geometry::camera::{RectifiedRig, RigError};
use crate::units::Disparity;

/// Rectified stereo rig: aligned rows and one focal length.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CRig {
    /// Focal length, px.
    pub focal_px: f32,
    /// Distance between the optical centres, m.
    pub baseline_m: f32,
    /// Principal point of the left camera, column, px.
    pub cx: f32,
    /// Principal point of both cameras, row, px.
    pub cy: f32,
    /// Principal point of the right camera, column, px.
    pub cx_right: f32,
}

impl CRig {
    fn checked(&self) -> Result<RectifiedRig, Status> {
        Ok(RectifiedRig::with_offset(self.focal_px, self.baseline_m, self.cx, self.cy, self.cx_right)?)
    }
}

impl From<RigError> for Status {
    fn from(e: RigError) -> Self {
        match e {
            RigError::NotFinite => Self::RigNotFinite,
            RigError::FocalLength => Self::RigFocalLength,
            RigError::Baseline => Self::RigBaseline,
        }
    }
}

impl From<DepthError> for Status {
    fn from(e: DepthError) -> Self {
        match e {
            DepthError::TooLarge => Self::RigTooLarge,
            DepthError::TooSmall => Self::RigTooSmall,
            DepthError::Offset => Self::RigOffset,
        }
    }
}

/// Converts disparities to depths, as `stereopsis_millimetres`.
///
/// # Safety
///
/// `rig` is null or points to a rig; `disparities` and `millimetres` are null or point to `count` words each.
pub unsafe fn millimetres(
    rig: *const CRig,
    disparities: *const u16,
    millimetres: *mut u16,
    count: usize,
) -> Status {
    let convert = || {
        // SAFETY: the caller's promise.
        let scale = unsafe { scale_of(rig) }?;
        checked(disparities)?;
        checked(millimetres)?;
        if count > isize::MAX as usize / size_of::<u16>() {
            return Err(Status::TooMany);
        }
        for i in 0..count {
            // SAFETY: the caller's promise. No slices are made: both may be one array.
            unsafe {
                let disparity = Disparity::from_raw(disparities.add(i).read());
                millimetres.add(i).write(scale.millimetres(disparity).0);
            }
        }
        Ok(Status::Ok)
    };
    either(convert())
}

/// Returns the depth scale of the rig at a pointer.
///
/// # Safety
///
/// `rig` is null or points to a rig.
pub(super) unsafe fn scale_of(rig: *const CRig) -> Result<DepthScale, Status> {
    // SAFETY: the caller's promise.
    Ok(DepthScale::new(&unsafe { rig_at(rig) }?)?)
}

/// Returns the rig at a pointer.
///
/// # Safety
///
/// `rig` is null or points to a rig.
pub(super) unsafe fn rig_at(rig: *const CRig) -> Result<RectifiedRig, Status> {
    checked(rig)?;
    // SAFETY: the caller's promise, it is aligned, and every bit pattern is a rig.
    unsafe { rig.read() }.checked()
}
