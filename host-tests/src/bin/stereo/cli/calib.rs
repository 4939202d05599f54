//! The options of `stereo calib`.

use super::rectify::Unit;
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;
use stereopsis::geometry::camera::ImageSize;

pub const EXAMPLE: &str = "Examples:
  stereo calib check --calib stereo.yml
  stereo calib convert --calib camchain.yaml --to opencv --out stereo.yml
  stereo calib convert --calib left.yaml --calib right.yaml --to rust --out rig.rs

Read are OpenCV's YAML, XML or JSON (K1, D1, K2, D2, R, T), ROS's camera_info (twice), Kalibr's camchain, Middlebury's and \
KITTI's calib.txt, and the record that convert writes. Written are record (328 bytes for flash, with a checksum), rust and c \
(the same as a constant and as a header), or opencv (YAML, metres).";

#[derive(Debug, Args)]
pub struct CalibArgs {
    #[command(subcommand)]
    pub command: CalibCommand,
}

#[derive(Debug, Subcommand)]
pub enum CalibCommand {
    /// Say in words what a calibration is worth: the cameras, the depths they can tell, what looks wrong
    Check(CheckArgs),
    /// Write a calibration in another format
    Convert(ConvertArgs),
}

#[derive(Debug, Args)]
pub struct FileArgs {
    /// Calibration of the two cameras, as for the command rectify; twice for ROS's camera_info
    #[arg(long, value_name = "FILE", required = true)]
    pub calib: Vec<PathBuf>,
    /// Columns and rows of the images, where the file does not say them
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = size)]
    pub size: Option<ImageSize>,
    /// The unit of lengths in OpenCV's files, which may not say it: m where none is given
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
}

#[derive(Debug, Args)]
pub struct CheckArgs {
    #[command(flatten)]
    pub file: FileArgs,
    /// How many whole disparities are searched, for the nearest depth: 16 to 256
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = super::disparities, allow_negative_numbers = true)]
    pub disparities: u16,
}

#[derive(Debug, Args)]
pub struct ConvertArgs {
    #[command(flatten)]
    pub file: FileArgs,
    /// What is written
    #[arg(long, value_name = "FORMAT")]
    pub to: Format,
    /// The file
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// What a calibration is written as.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum Format {
    /// Bytes for flash
    Record,
    /// A constant of Rust that holds them
    Rust,
    /// A header of C that holds them
    C,
    /// OpenCV's YAML
    Opencv,
}

fn size(text: &str) -> Result<ImageSize, &'static str> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let size = sides.map(|(width, height)| ImageSize { width, height }).filter(|size| size.is_possible());
    size.ok_or("columns and rows from 2 to 4096 are needed, as 640x480")
}
