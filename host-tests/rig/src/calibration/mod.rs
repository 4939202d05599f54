//! Rectified rigs from calibration files.
//!
//! In: a `calib.txt` of the Middlebury stereo pages (millimetres) or of KITTI (metres), or what OpenCV, ROS
//! or the command `rectify` say of rectified images, told apart by content. Out: a [`RectifiedRig`] in
//! metres, with the image size where the file says it.
//!
//! * [`Cameras`]: the two cameras alone, which need not be rectified.
//! * [`RawCalibration`]: two cameras as they are mounted, also from OpenCV's, ROS's and Kalibr's files.
//! * [`write_opencv`], [`write_rust`], [`write_c`]: a rig as a file.
//! * [`Reach`]: the depths that a rig tells with a search.
//! * `source`: the files' bytes. [`hold`]: those of a file that is in memory.
//! * `middlebury`: `cam0=[f 0 cx; 0 f cy; 0 0 1]`, `cam1`, `doffs`, `baseline`, and optional sizes.
//! * `kitti`: projection matrices of 12 numbers, labelled `P0:` to `P3:` or `P_rect_00:` to `P_rect_03:`, or
//!   two lines without labels for left and right.

mod cameras;
mod error;
mod kitti;
mod middlebury;
mod raw;
mod reach;
mod source;
mod write;

pub use cameras::Cameras;
pub use error::{CalibrationError, Fault};
pub use middlebury::write_middlebury;
pub use raw::RawCalibration;
pub use reach::Reach;
pub use source::{bytes, hold, release};
pub use write::{write_c, write_opencv, write_rust};

use std::path::{Path, PathBuf};
use stereopsis::geometry::camera::{ImageSize, RectifiedRig};

/// What a calibration file says.
#[derive(Clone, PartialEq, Debug)]
pub struct Calibration {
    /// The file.
    pub path: PathBuf,
    /// The format's name: "Middlebury", "KITTI", "OpenCV".
    pub format: &'static str,
    /// The two cameras.
    pub rig: RectifiedRig,
    /// Columns of the calibrated images, where the file says it.
    pub width: Option<u16>,
    /// Rows of the calibrated images, where the file says it.
    pub height: Option<u16>,
    /// The search range that the file recommends, where it does.
    pub disparities: Option<u16>,
}

impl Calibration {
    /// Reads the file at `path`. KITTI's files hold a grey and a colour pair of cameras: the components of
    /// `left_image`'s path choose, `image_0`, `image_1`, `image_00` or `image_01` the grey pair.
    pub fn open(path: impl AsRef<Path>, left_image: &Path) -> Result<Self, CalibrationError> {
        Self::open_all(&[path.as_ref().into()], left_image, None)
    }

    /// The same of one file, or of two of ROS. The unit is as for [`RawCalibration::open`].
    pub fn open_all(
        paths: &[PathBuf],
        left_image: &Path,
        unit_m: Option<f64>,
    ) -> Result<Self, CalibrationError> {
        let path = paths.first().cloned().unwrap_or_default();
        if let Some(record) = raw::recorded(&path) {
            let fault = record.err().unwrap_or(Fault::NotRectified);
            return Err(CalibrationError { path, fault });
        }
        let texts = load_all(paths)?;
        raw::check_two(paths, &texts)?;
        match Self::parse(paths, &texts, left_image, unit_m) {
            Ok(read) => Ok(Self { path, ..read }),
            Err(fault) => Err(CalibrationError { path, fault }),
        }
    }

    fn parse(
        paths: &[PathBuf],
        texts: &[String],
        left_image: &Path,
        unit_m: Option<f64>,
    ) -> Result<Self, Fault> {
        if let Some(found) = raw::rectified_rig(paths, texts, unit_m)? {
            return Ok(found);
        }
        let text = texts.first().map_or("", String::as_str);
        let found = if middlebury::is_one(text) {
            middlebury::read(text)?
        } else if kitti::is_one(text) {
            kitti::read(text, left_image)?
        } else {
            return Err(Fault::Unknown);
        };
        raw::likely(found.format, "the baseline", found.rig.baseline_m().into())?;
        Ok(found)
    }

    /// The size of the images that the file was made for, where it says one.
    pub fn size(&self) -> Option<ImageSize> {
        Some(ImageSize { width: self.width?, height: self.height? })
    }

    /// Whether images of `width` x `height` pixels are those that the file was made for; a size that the file
    /// does not say is right.
    pub fn check_size(&self, width: u16, height: u16) -> Result<(), CalibrationError> {
        for (which, calibrated, image) in [("width", self.width, width), ("height", self.height, height)] {
            if let Some(calibrated) = calibrated.filter(|&calibrated| calibrated != image) {
                return Err(CalibrationError {
                    path: self.path.clone(),
                    fault: Fault::Size { which, calibrated, image },
                });
            }
        }
        Ok(())
    }
}

/// The texts of files that are not empty.
fn load_all(paths: &[PathBuf]) -> Result<Vec<String>, CalibrationError> {
    let one = |path: &PathBuf| {
        let text =
            load(path).and_then(|text| if text.trim().is_empty() { Err(Fault::Empty) } else { Ok(text) });
        text.map_err(|fault| CalibrationError { path: path.clone(), fault })
    };
    paths.iter().map(one).collect()
}

fn load(path: &Path) -> Result<String, Fault> {
    let bytes = source::bytes(path)?;
    if bytes.len() > source::MOST_BYTES || bytes.contains(&0) {
        return Err(Fault::NotText);
    }
    // Some editors begin a file with the mark of its encoding.
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).map(<[u8]>::to_vec).unwrap_or(bytes);
    String::from_utf8(bytes).map_err(|_| Fault::NotText)
}

/// What a camera's line says, before it is checked against the other's.
#[derive(Clone, Copy, Debug)]
struct Intrinsics<'a> {
    key: &'a str,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
}

/// Focal lengths of rectified cameras agree to this share: files round them to three decimals or more.
const FOCAL_TOLERANCE: f64 = 1e-4;
/// Principal points of rectified cameras agree to this in their rows, and with `doffs`, px.
const PIXEL_TOLERANCE: f64 = 0.5;

/// The rig of two cameras, checked.
fn rig(
    left: Intrinsics,
    right: Intrinsics,
    baseline_key: &str,
    baseline_m: f64,
) -> Result<RectifiedRig, Fault> {
    for camera in [left, right] {
        if camera.fx <= 0.0 {
            return Err(Fault::FocalLength { key: camera.key.into(), focal_px: camera.fx });
        }
        if differ(camera.fx, camera.fy) {
            return Err(Fault::FocalLengths { keys: camera.key.into(), focal_px: (camera.fx, camera.fy) });
        }
    }
    let keys = || format!("{} and {}", left.key, right.key);
    if differ(left.fx, right.fx) {
        return Err(Fault::FocalLengths { keys: keys(), focal_px: (left.fx, right.fx) });
    }
    if (left.cy - right.cy).abs() > PIXEL_TOLERANCE {
        return Err(Fault::Rows { keys: keys(), rows: (left.cy, right.cy) });
    }
    if baseline_m <= 0.0 {
        return Err(Fault::Baseline { key: baseline_key.into(), baseline_m });
    }
    let [f, b, cx, cy, cx_right] = [left.fx, baseline_m, left.cx, left.cy, right.cx].map(|v| v as f32);
    RectifiedRig::with_offset(f, b, cx, cy, cx_right).map_err(Fault::Rig)
}

fn differ(a: f64, b: f64) -> bool {
    (a - b).abs() > FOCAL_TOLERANCE * a.abs()
}

/// The finite numbers of a line, `needed` of them.
fn numbers<const N: usize>(key: &str, line: usize, text: &str) -> Result<[f64; N], Fault> {
    let mut values = [0.0; N];
    let mut count = 0;
    for word in text.split_ascii_whitespace() {
        let (key, found) = (key.to_owned(), word.to_owned());
        let Ok(value) = word.parse::<f64>() else { return Err(Fault::NotANumber { key, line, found }) };
        // The rig holds single precision: what overflows there is no number of a camera.
        if !(value as f32).is_finite() {
            return Err(Fault::NotFinite { key, line, found });
        }
        if let Some(slot) = values.get_mut(count) {
            *slot = value;
        }
        count += 1;
    }
    if count == N { Ok(values) } else { Err(Fault::Count { key: key.into(), line, found: count, needed: N }) }
}
