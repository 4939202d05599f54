//! Why a calibration file is none.

use std::io;
use std::path::PathBuf;

/// Why a file gives no rig: one line that names the file, the key or the line, and what would be right.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct CalibrationError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong in it.
    pub fault: Fault,
}

/// What is wrong in a calibration file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The operating system refused to open or read the file.
    #[error("cannot be read ({0}); give a calibration file")]
    Read(io::Error),
    /// Not UTF-8, longer than a calibration can be, or not a file.
    #[error(
        "is no text file (UTF-8) of at most {} bytes; give a calibration file",
        crate::limits::CALIBRATION_BYTES
    )]
    NotText,
    /// The file has no byte or only white space.
    #[error("the file is empty; give a calibration file")]
    Empty,
    /// The content is of no format that is read.
    #[error(
        "is neither a Middlebury calib.txt (cam0=[...]) nor a KITTI one (P0: and P1:, or two lines of 12 \
         numbers), nor of OpenCV, ROS or Kalibr"
    )]
    Unknown,
    /// The content is of no format of a rig that is not rectified.
    #[error(
        "is no calibration of two cameras: OpenCV's YAML or XML, ROS's camera_info, Kalibr's camchain, \
         Middlebury's or KITTI's calib.txt"
    )]
    UnknownRaw,
    /// YAML, JSON or XML that is none.
    #[error("is not well-formed: {0}")]
    Syntax(String),
    /// One camera's file of two.
    #[error("is the camera_info of one camera; give --calib a second time, with the other camera's")]
    OneOfTwo,
    /// A file of both cameras that is given beside another one.
    #[error("describes both cameras by itself; give it without a second --calib")]
    Whole,
    /// A file beside a camera_info of ROS that is none.
    #[error("is no camera_info, as the other file is; give that of the other camera")]
    NotTheOther,
    /// A calibration of raw images where one of rectified ones is needed.
    #[error(
        "says how the cameras are mounted, but not how their rectified images are (P1 and P2, or Q); raw \
         images are rectified by `match --rectify` and by `rectify`"
    )]
    NotRectified,
    /// Rectified cameras below each other.
    #[error("the cameras stand below each other; cameras beside each other are needed")]
    Below,
    /// What a key has is wrong.
    #[error("{key}: {problem}")]
    Key {
        /// The key.
        key: String,
        /// What is wrong, and what would be right.
        problem: String,
    },
    /// The baseline is so long or so short that its unit is suspected.
    #[error("{key}: a baseline of {} m is not likely; {advice}", *baseline_m as f32)]
    Unit {
        /// The key that it comes from.
        key: String,
        /// What follows, m.
        baseline_m: f64,
        /// What would be right in this format.
        advice: &'static str,
    },
    /// The second camera stands on the other side of the first.
    #[error("{0}; exchange them in the file, or --left and --right")]
    Swapped(stereopsis::geometry::rectify::RectifyError),
    /// A record of the core's is refused by it.
    #[error("{0}")]
    Record(stereopsis::geometry::camera::RecordError),
    /// Neither the file nor the caller says how large the images are.
    #[error("does not say how large the images are; give --size, as 640x480")]
    NoSize,
    /// The rig is refused by the core.
    #[error("{0}")]
    StereoRig(stereopsis::geometry::camera::StereoRigError),
    /// A key that is needed is not there.
    #[error("{0} is missing; {1} is needed")]
    Missing(String, &'static str),
    /// A key stands there twice.
    #[error("line {line}: {key} is given a second time; once is right")]
    Twice {
        /// The key.
        key: String,
        /// The second line with it, from 1.
        line: usize,
    },
    /// What should be a number cannot be read as one.
    #[error("line {line}: {key}: '{found}' is not a number")]
    NotANumber {
        /// The key.
        key: String,
        /// The line, from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A number is infinite, not a number, or beyond single precision.
    #[error("line {line}: {key}: '{found}' is not finite; finite numbers are needed")]
    NotFinite {
        /// The key.
        key: String,
        /// The line, from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A matrix has too few or too many numbers.
    #[error("line {line}: {key} has {found} numbers; {needed} are needed")]
    Count {
        /// The key.
        key: String,
        /// The line, from 1.
        line: usize,
        /// How many stand there.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// A whole number is zero, negative, fractional or too large.
    #[error("line {line}: {key}: '{found}' must be a whole number from 1 to 65535")]
    NotASize {
        /// The key.
        key: String,
        /// The line, from 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// The focal length is zero or negative.
    #[error("{key}: the focal length is {focal_px} px; it must be greater than zero")]
    FocalLength {
        /// The camera's key.
        key: String,
        /// What stands there, px.
        focal_px: f64,
    },
    /// A camera's two focal lengths differ, or the two cameras' do.
    #[error("{keys}: the focal lengths {0} px and {1} px differ; rectified cameras have \
        one", focal_px.0, focal_px.1)]
    FocalLengths {
        /// The cameras' keys.
        keys: String,
        /// The two, px.
        focal_px: (f64, f64),
    },
    /// The rows of the two cameras are not aligned.
    #[error("{keys}: the principal points are on the rows {0} and {1}; rectified cameras share the \
        row", rows.0, rows.1)]
    Rows {
        /// The cameras' keys.
        keys: String,
        /// The two, px.
        rows: (f64, f64),
    },
    /// The baseline is zero or negative.
    #[error(
        "{key}: the baseline is {baseline_m} m; it must be greater than zero, with the right camera on the \
         right"
    )]
    Baseline {
        /// Where it comes from.
        key: String,
        /// What stands there or follows, m.
        baseline_m: f64,
    },
    /// `doffs` contradicts the principal points.
    #[error(
        "doffs: {doffs} px contradicts the principal points of cam0 and cam1, which are {between} px apart"
    )]
    Offset {
        /// What `doffs` says, px.
        doffs: f64,
        /// cx of cam1 less cx of cam0, px.
        between: f64,
    },
    /// A camera is refused by the core.
    #[error("{key}: {error}")]
    Camera {
        /// The camera's key.
        key: String,
        /// Why.
        error: stereopsis::geometry::camera::CameraModelError,
    },
    /// The rig is refused by the core.
    #[error("{0}")]
    Rig(stereopsis::geometry::camera::RigError),
    /// The images are not of the calibrated size.
    #[error(
        "{which} says {calibrated}, but the images have {image} pixels; the calibration of these images is \
         needed"
    )]
    Size {
        /// `width` or `height`.
        which: &'static str,
        /// The file's.
        calibrated: u16,
        /// The images'.
        image: u16,
    },
}
