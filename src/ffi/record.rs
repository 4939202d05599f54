//! Calibration record in C: what `stereo calib convert --to c` writes.
#![allow(unsafe_code)]

use super::Status;
use super::state::checked;
use super::status::either;
use crate::geometry::camera::{RecordError, StereoRig};

/// Bytes of a calibration record.
pub const STEREOPSIS_RECORD_BYTES: usize = 328;
/// Value of `alpha` that keeps the scale of the raw images.
pub const STEREOPSIS_ALPHA_NATURAL: f32 = -1.0;

const _: () = assert!(STEREOPSIS_RECORD_BYTES == StereoRig::<f32>::RECORD_BYTES);

/// What a calibration record says about the raw images.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CCameras {
    /// Columns of the left camera's raw images, and of the right one's, px.
    pub width: [u16; 2],
    /// Rows of the left camera's raw images, and of the right one's, px.
    pub height: [u16; 2],
    /// Distance between the optical centres, m.
    pub baseline_m: f32,
}

impl From<RecordError> for Status {
    fn from(e: RecordError) -> Self {
        match e {
            RecordError::TooShort { .. } => Self::RecordTooShort,
            RecordError::NotARecord => Self::NotARecord,
            RecordError::Version { .. } => Self::RecordVersion,
            RecordError::Checksum => Self::RecordChecksum,
            RecordError::Lens { .. } => Self::RecordLens,
            RecordError::Camera(..) | RecordError::Rig(_) => Self::RecordNumbers,
        }
    }
}

/// Returns the rig of a record, in single precision.
///
/// # Safety
///
/// `record` is null or points to `length` bytes.
pub(super) unsafe fn rig_of(record: *const u8, length: usize) -> Result<StereoRig<f32>, Status> {
    checked(record)?;
    // SAFETY: the caller's promise, and no more than a record is looked at.
    let bytes = unsafe { core::slice::from_raw_parts(record, length.min(STEREOPSIS_RECORD_BYTES)) };
    Ok(StereoRig::from_record(bytes)?)
}

/// Checks a record, as `stereopsis_record_read`.
///
/// # Safety
///
/// `record` is null or points to `length` bytes; `cameras` is null or points to a structure's bytes.
pub unsafe fn record_read(record: *const u8, length: usize, cameras: *mut CCameras) -> Status {
    let read = || {
        // SAFETY: the caller's promise.
        let rig = unsafe { rig_of(record, length) }?;
        checked(cameras)?;
        let [left, right] = rig.sizes();
        let found = CCameras {
            width: [left.width, right.width],
            height: [left.height, right.height],
            baseline_m: rig.baseline_m(),
        };
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { cameras.write(found) };
        Ok(Status::Ok)
    };
    either(read())
}
