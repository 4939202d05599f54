//! `stereo rectify`: a raw pair and a calibration into a rectified pair.

use crate::failure::Failure;
use crate::input::Pair;
use crate::place::{json, png};
use crate::rectified::{CAMERAS, MASKS, RectifiedCameras, open};
use crate::shared::{PairArgs, RectifyOptions, print, remark};
use crate::uncalibrated;
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;
use stereopsis::geometry::camera::ImageSize;
use stereopsis_host::calibration::warnings;
use stereopsis_host::command_line::one_line;
use stereopsis_host::output::Staging;
use stereopsis_host::rectify::rectify;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo rectify --left left.png --right right.png --calib stereo.yml --out rectified
  stereo rectify --left left.png --right right.png --matches matches.csv --out aligned

Written into the folder: left.png and right.png (grey, rows aligned), valid_left.png and valid_right.png \
                           (255 where the raw image was seen, 0 elsewhere), and rectified.json (the new \
                           cameras, Q, the rows of input that the remap holds at once). Cameras below each \
                           other get their columns aligned.

Without a calibration matches of the command features align the rows (--matches): the same files, but \
                           rectified.json has two homographies instead of cameras, for nothing in metres is \
                           known then, and lenses are not straightened.";

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

pub fn run(args: &RectifyArgs) -> Result<(), Failure> {
    let pair = Pair::open(&args.pair.left, &args.pair.right)?;
    if let Some(matches) = &args.matches {
        return uncalibrated::run(&pair, matches, &args.out);
    }
    let size = ImageSize { width: pair.width, height: pair.height };
    let (calibration, rectification) = open(&args.calib, &args.rectify, size)?;
    let named = |e: &dyn std::fmt::Display| Failure::new(format!("{}: {e}", calibration.path.display()));
    Staging::probe(&args.out)?;
    let result = rectify(&rectification, pair.camera).map_err(|e| named(&e))?;
    let report = rectification.report();

    let mut staging = Staging::new(&args.out)?;
    let [left, right] = &result.pictures;
    let [valid_left, valid_right] = &result.valid;
    for (name, picture) in
        [("left.png", left), ("right.png", right), (MASKS[0], valid_left), (MASKS[1], valid_right)]
    {
        staging.write(name, |out| png(out, picture))?;
    }
    let summary = RectifiedCameras::new(calibration.format, &rectification, result.rows, &report);
    staging.write(CAMERAS, |out| json(out, &summary))?;
    staging.commit(&[])?;

    for warning in warnings(&calibration.rig, &rectification) {
        remark(&format!("warning: {warning}"));
    }
    for note in &pair.notes {
        remark(&format!("note: {note}"));
    }
    let mut text = format!(
        "{} x {} px, {}, {} calibration\n",
        size.width, size.height, summary.axis, calibration.format
    );
    text += &summary.figures();
    let _ = writeln!(text, "results are in {}", one_line(&args.out.display().to_string()));
    print(&text)
}
