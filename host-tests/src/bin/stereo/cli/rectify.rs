//! The options of `stereo rectify`.

use super::PairArgs;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

pub const EXAMPLE: &str = "Example:
  stereo rectify --left left.png --right right.png --calib stereo.yml --out rectified
  stereo rectify --left left.png --right right.png --matches matches.csv --out aligned

Written into the folder: left.png and right.png (grey, rows aligned), valid_left.png and valid_right.png (255 where the \
raw image was seen, 0 elsewhere), and rectified.json (the new cameras, Q, the rows of input that the remap holds at \
once). Cameras below each other get their columns aligned.

Without a calibration matches of the command features align the rows (--matches): the same files, but rectified.json has two homographies instead of cameras, for nothing in metres is known then, and lenses are not straightened.";

#[derive(Debug, Args)]
pub struct RectifyArgs {
    #[command(flatten)]
    pub pair: PairArgs,
    /// Calibration of the two cameras: OpenCV's YAML or XML, Kalibr's camchain, a Middlebury or KITTI
    /// calib.txt; twice for ROS's camera_info, the left camera's and the right one's, or for OpenCV's
    /// intrinsics and extrinsics
    #[arg(long, value_name = "FILE", required_unless_present = "matches")]
    pub calib: Vec<PathBuf>,
    #[command(flatten)]
    pub rectify: RectifyOptions,
    /// Instead of a calibration: matches of the two images, lines of x1,y1,x2,y2 in px under that header,
    /// some of them wrong
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["calib", "alpha", "unit"])]
    pub matches: Option<PathBuf>,
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// How rigs are rectified.
#[derive(Debug, Args)]
pub struct RectifyOptions {
    /// What is shown: from 0, nothing but what both cameras see, to 1, all of both images; by default at
    /// their own scale
    #[arg(long, value_name = "ALPHA", value_parser = alpha, allow_negative_numbers = true)]
    pub alpha: Option<f64>,
    /// The unit of lengths in OpenCV's files, which do not say it: m where none is given
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
}

/// A unit of length.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum Unit {
    M,
    Cm,
    Mm,
}

impl Unit {
    /// The unit's length, m.
    pub fn metres(self) -> f64 {
        match self {
            Self::M => 1.0,
            Self::Cm => 0.01,
            Self::Mm => 0.001,
        }
    }
}

fn alpha(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.0..=1.0).contains(value));
    value.ok_or("a number from 0 to 1 is needed")
}
