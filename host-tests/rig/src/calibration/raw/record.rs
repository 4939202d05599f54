//! The core's record of a rig, as it stands in flash.

use super::Fault;
use crate::calibration::source;
use std::path::Path;
use stereopsis::geometry::camera::StereoRig;

/// The rig of a file that begins as a record does; nothing of other files, also of those that cannot be read.
pub(in crate::calibration) fn read(path: &Path) -> Option<Result<StereoRig<f64>, Fault>> {
    let bytes = source::bytes(path).ok()?;
    let record = bytes.get(..StereoRig::<f64>::RECORD_BYTES).unwrap_or(&bytes);
    record.starts_with(b"STRG").then(|| StereoRig::from_record(record).map_err(Fault::Record))
}
