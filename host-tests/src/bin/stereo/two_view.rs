//! The options of the commands on two views: `features`, `fundamental`, `pose`.

use crate::cli::{PairArgs, whole};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use stereopsis_host::correspond::Plan;

pub const FUNDAMENTAL_EXAMPLE: &str = "Example:
  stereo fundamental --matches matches.csv --out fundamental.json --left first.png --right second.png --picture lines.png

Written is one JSON object: fundamental (3x3 in rows, p1^T F p2 = 0 for a point p1 of the first image and p2 of the second), \
inliers (whether each match is within the threshold), time_us (the estimate alone, the best of five); with ransac also \
samples and miss_probability, the probability that a better estimate was missed. The picture has both images with the points \
of all matches, red where one does not agree, and for some of the others the lines on which they must lie.";

pub const POSE_EXAMPLE: &str = "Example:
  stereo pose --matches matches.csv --calib calib.txt --out pose.json

Written is one JSON object: essential (3x3 in rows), rotation and translation (a point P' of the second camera is \
R P' + t in the first; t has length one, for the scale is not in the matches), points (in the first camera, the baseline is \
one; null where a match is wrong or its sights are parallel), inliers, and model: fundamental, or homography when what \
was seen is on a plane.";

pub const FEATURES_EXAMPLE: &str = "Example:
  stereo features --left first.png --right second.png --out matches.csv --picture matches.png

Written is a line x1,y1,x2,y2 for every match, under that header: column and row in the left image, column and row in the \
right one, in px. The images need not be rectified or of one size.";

#[derive(Debug, Args)]
pub struct FeaturesArgs {
    #[command(flatten)]
    pub pair: PairArgs,
    /// File for the matches
    #[arg(long, value_name = "FILE.csv")]
    pub out: PathBuf,
    /// File for a picture of the matches over the images
    #[arg(long, value_name = "FILE.png")]
    pub picture: Option<PathBuf>,
    /// About how many corners are kept of each image, 50 to 12000, spread over it
    #[arg(long, value_name = "N", default_value_t = 4000, value_parser = corners, allow_negative_numbers = true)]
    pub corners: u16,
    /// Grey levels by which a corner differs from its surroundings, 1 to 254
    #[arg(long, value_name = "G", default_value_t = 8, value_parser = contrast, allow_negative_numbers = true)]
    pub contrast: u16,
    /// How many sizes of the images are searched, 1 to 8, each three quarters of the one before
    #[arg(long, value_name = "L", default_value_t = 4, value_parser = levels, allow_negative_numbers = true)]
    pub levels: u16,
    /// A match differs in fewer bits than so many percent of the second best, 1 to 100
    #[arg(long, value_name = "PERCENT", default_value_t = 80, value_parser = percent, allow_negative_numbers = true)]
    pub ratio: u16,
    /// How many columns partners may lie apart, px; anywhere by default
    #[arg(long, value_name = "PX", value_parser = apart, allow_negative_numbers = true)]
    pub columns_apart: Option<u16>,
    /// How many rows partners may lie apart, px; anywhere by default
    #[arg(long, value_name = "PX", value_parser = apart, allow_negative_numbers = true)]
    pub rows_apart: Option<u16>,
    /// upright, turned (the images may be turned against each other by any angle), or auto, which tries
    /// turned when few corners match upright
    #[arg(long, value_name = "WAY", default_value = "auto")]
    pub orientation: OrientationChoice,
}

/// How corners are described.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum OrientationChoice {
    Auto,
    Upright,
    Turned,
}

#[derive(Debug, Args)]
pub struct FundamentalArgs {
    /// The matches: lines of x1,y1,x2,y2 in px under that header
    #[arg(long, value_name = "FILE")]
    pub matches: PathBuf,
    #[command(flatten)]
    pub robust: RobustArgs,
    /// File for the result; its folder is made when it is missing
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// File for a picture of the epipolar lines over both images
    #[arg(long, value_name = "FILE.png", requires_all = ["left", "right"])]
    pub picture: Option<PathBuf>,
    /// The image of x1,y1, for the picture
    #[arg(long, value_name = "FILE", requires_all = ["right", "picture"])]
    pub left: Option<PathBuf>,
    /// The image of x2,y2, for the picture
    #[arg(long, value_name = "FILE", requires_all = ["left", "picture"])]
    pub right: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct PoseArgs {
    /// The matches: lines of x1,y1,x2,y2 in px under that header
    #[arg(long, value_name = "FILE")]
    pub matches: PathBuf,
    /// Calibration of the two cameras, which need not be rectified, or of the one that took both images:
    /// OpenCV's YAML, XML or JSON, ROS's camera_info (twice for two cameras), Kalibr's camchain, a
    /// Middlebury or KITTI calib.txt
    #[arg(long, value_name = "FILE", required = true)]
    pub calib: Vec<PathBuf>,
    #[command(flatten)]
    pub robust: RobustArgs,
    /// File for the result; its folder is made when it is missing
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

#[derive(Debug, Args)]
pub struct RobustArgs {
    /// eight-point (all matches are right) or ransac (some are wrong)
    #[arg(long, value_name = "METHOD", default_value = "ransac")]
    pub method: TwoViewMethod,
    /// Sampson distance up to which a match counts as right, px, 0.001 to 1000
    #[arg(long, value_name = "PX", default_value_t = 1.0, value_parser = threshold, allow_negative_numbers = true)]
    pub threshold: f64,
    /// What ransac's random choices begin with
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = seed, allow_negative_numbers = true)]
    pub seed: u64,
}

/// How a fundamental matrix is estimated.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum TwoViewMethod {
    EightPoint,
    Ransac,
}

fn threshold(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.001..=1000.0).contains(value));
    value.ok_or("a number from 0.001 to 1000 is needed")
}

fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("a whole number from 0 to {} is needed", u64::MAX))
}

fn corners(text: &str) -> Result<u16, String> {
    whole(text, Plan::FEWEST, Plan::MOST)
}

fn contrast(text: &str) -> Result<u16, String> {
    whole(text, 1, 254)
}

fn levels(text: &str) -> Result<u16, String> {
    whole(text, 1, 8)
}

fn percent(text: &str) -> Result<u16, String> {
    whole(text, 1, 100)
}

fn apart(text: &str) -> Result<u16, String> {
    whole(text, 0, 4096)
}
