//! Calibrations of other programs, and what they say in words.
//!
//! * [`Calibration`], [`RawCalibration`] and the rest of `stereopsis_rig`'s: files read and written.
//! * [`describe`], [`describe_rectified`], [`warnings`]: a calibration in words, as far as it was [`Asked`].
//! * [`off_middle`]: whether a calibration seems to be of images of another size.

mod words;

pub use stereopsis_rig::calibration::{
    Calibration, CalibrationError, Cameras, Fault, RawCalibration, Reach, bytes, write_c, write_middlebury,
    write_opencv, write_rust,
};
pub use words::{Asked, describe, describe_rectified, off_middle, warnings};
