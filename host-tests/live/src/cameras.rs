//! Calibration files of the page, read as `stereo match` reads them.

use serde::Serialize;
use std::path::{Path, PathBuf};
use stereopsis::geometry::camera::{ImageSize, RectifiedRig};
use stereopsis::geometry::rectify::{Crop, Rectification};
use stereopsis_rig::calibration::{Calibration, CalibrationError, Fault, RawCalibration, hold, release};

/// Lengths of OpenCV's files, in the order of the page's list, m: as the file says, or as it is told.
const UNITS_M: [Option<f64>; 4] = [None, Some(1.0), Some(0.01), Some(0.001)];

/// The files that were given, by their names.
#[derive(Debug, Default)]
pub struct Files(Vec<PathBuf>);

/// What the page shows of a calibration.
#[derive(Debug, Serialize)]
pub struct Told {
    /// The format's name.
    format: &'static str,
    /// The focal length of the pictures that are matched, px.
    focal_px: f32,
    /// The baseline, mm.
    baseline_mm: f64,
    /// What is added to a disparity before it divides, px.
    offset_px: f32,
    /// The principal point of the pictures that are matched, px.
    centre_px: (f32, f32),
    /// Whether the pictures are rectified by it before they are matched.
    is_rectified: bool,
    /// Whether they could be, and whether they could be left as they are.
    may_rectify: bool,
    may_leave: bool,
}

/// The cameras of a calibration.
#[derive(Debug)]
pub struct Cameras {
    /// What the page shows of them.
    pub told: Told,
    /// What raw pictures are rectified by; none where they are rectified.
    pub rectification: Option<Rectification<f64>>,
}

impl Files {
    /// No files.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// Takes one more file.
    pub fn add(&mut self, name: &str, bytes: &[u8]) {
        let path = PathBuf::from(name);
        hold(&path, bytes);
        self.0.push(path);
    }

    /// Forgets all files.
    pub fn clear(&mut self) {
        self.0.clear();
        release();
    }

    /// The cameras for pictures of a size; `unit` is a place in the page's list. Where `rectify` is neither
    /// told nor forbidden, pictures are rectified by a file that says nothing of rectified ones. A line says
    /// what is wrong.
    pub fn cameras(&self, size: ImageSize, unit: usize, rectify: Option<bool>) -> Result<Cameras, String> {
        if self.0.len() > 2 {
            return Err("more than two calibration files: one of both cameras, or one of each".into());
        }
        let unit_m = UNITS_M.get(unit).copied().flatten();
        let rectified = self.rectified(size, unit_m);
        let raw = RawCalibration::open(&self.0, Some(size), unit_m);
        let (may_rectify, may_leave) = (raw.is_ok(), rectified.is_ok());
        let told = |rig: &RectifiedRig, format, is_rectified| Told {
            format,
            focal_px: rig.focal_px(),
            baseline_mm: millimetres(rig.baseline_m()),
            offset_px: rig.disparity_offset_px(),
            centre_px: rig.principal_point(),
            is_rectified,
            may_rectify,
            may_leave,
        };
        if rectify.unwrap_or(rectified.is_err()) {
            let raw = raw.map_err(|raw| best(raw, rectified.err()))?;
            let name = raw.path.display();
            let rectification = Rectification::new(&raw.rig, Crop::Natural, size);
            let rectification = rectification.map_err(|e| format!("{name}: {e}"))?;
            if !rectification.axis().is_horizontal() {
                let below = Fault::Below;
                return Err(format!("{name}: {below}"));
            }
            let rig = rectification.rig().map_err(|e| format!("{name}: {e}"))?;
            let told = told(&rig, raw.format, true);
            return Ok(Cameras { told, rectification: Some(rectification) });
        }
        let found = rectified.map_err(|e| e.to_string())?;
        Ok(Cameras { told: told(&found.rig, found.format, false), rectification: None })
    }

    fn rectified(&self, size: ImageSize, unit_m: Option<f64>) -> Result<Calibration, CalibrationError> {
        let found = Calibration::open_all(&self.0, Path::new(""), unit_m)?;
        found.check_size(size.width, size.height)?;
        Ok(found)
    }
}

/// Of the faults of both readings the one that says more: a file of rectified pictures of another size is no
/// unknown one.
fn best(raw: CalibrationError, rectified: Option<CalibrationError>) -> String {
    match (&raw.fault, rectified) {
        (Fault::UnknownRaw, Some(other)) if !matches!(other.fault, Fault::Unknown) => other.to_string(),
        _ => raw.to_string(),
    }
}

/// A length in mm with the digits that an `f32` of metres has.
fn millimetres(metres: f32) -> f64 {
    let metres: f64 = metres.to_string().parse().unwrap_or(f64::from(metres));
    (metres * 1e12).round() / 1e9
}
