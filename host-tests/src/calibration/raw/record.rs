//! The core's record of a rig, as it stands in flash.

use super::Fault;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use stereopsis::geometry::camera::StereoRig;

/// The rig of a file that begins as a record does; nothing of other files, also of those that cannot be read.
pub(in crate::calibration) fn read(path: &Path) -> Option<Result<StereoRig<f64>, Fault>> {
    if !std::fs::metadata(path).is_ok_and(|found| found.is_file()) {
        return None;
    }
    let mut bytes = Vec::new();
    let most = StereoRig::<f64>::RECORD_BYTES as u64;
    File::open(path).ok()?.take(most).read_to_end(&mut bytes).ok()?;
    bytes.starts_with(b"STRG").then(|| StereoRig::from_record(&bytes).map_err(Fault::Record))
}
