//! `stereo calib`: calibration files, checked and converted.

use crate::failure::Failure;
use crate::place::Place;
use crate::plan::{percent, range};
use crate::shared::{Unit, disparities, image_size, length, print};
use clap::{Args, Subcommand, ValueEnum};
use std::path::{Path, PathBuf};
use stereopsis::geometry::camera::ImageSize;
use stereopsis_host::calibration::{
    Asked, Calibration, RawCalibration, describe, describe_rectified, write_c, write_opencv, write_rust,
};
use stereopsis_host::command_line::one_line;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Examples:
  stereo calib check --calib stereo.yml
  stereo calib check --calib stereo.yml --nearest 0.4 --farthest 5
  stereo calib convert --calib camchain.yaml --to opencv --out stereo.yml
  stereo calib convert --calib left.yaml --calib right.yaml --to rust --out rig.rs

Read are OpenCV's YAML, XML or JSON (K1, D1, K2, D2, R, T), ROS's camera_info (twice), Kalibr's camchain, \
                           Middlebury's and KITTI's calib.txt, and the record that convert writes. Written \
                           are record (328 bytes for flash, with a checksum), rust and c (the same as a \
                           constant and as a header), or opencv (YAML, metres).";

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
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = image_size)]
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
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = disparities, allow_negative_numbers =
        true)]
    pub disparities: u16,
    /// The nearest depth that is wanted, m: the search is planned for it, as by stereo plan
    #[arg(long, value_name = "M", requires = "farthest", conflicts_with = "disparities",
        value_parser = length, allow_negative_numbers = true)]
    pub nearest: Option<f32>,
    /// The farthest, m
    #[arg(long, value_name = "M", requires = "nearest", value_parser = length, allow_negative_numbers = true)]
    pub farthest: Option<f32>,
    /// The standard deviation of a far depth that is wanted, percent of it
    #[arg(long, value_name = "PERCENT", default_value = "5", value_parser = percent, allow_negative_numbers =
        true)]
    pub accuracy: f64,
}

impl CheckArgs {
    /// What the rig is asked.
    fn asked(&self) -> Result<Asked, Failure> {
        let range_m = self.nearest.zip(self.farthest).map(|(near, far)| range(near, far)).transpose()?;
        Ok(Asked { disparities: self.disparities, range_m, accuracy: self.accuracy / 100.0 })
    }
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

pub fn run(args: &CalibArgs) -> Result<(), Failure> {
    match &args.command {
        CalibCommand::Check(args) => check(args),
        CalibCommand::Convert(args) => convert(args),
    }
}

fn open(args: &FileArgs) -> Result<RawCalibration, Failure> {
    if args.calib.len() > 2 {
        return Err(Failure::usage(
            "--calib: is given more than twice; a file of both cameras or one of each is needed",
        ));
    }
    Ok(RawCalibration::open(&args.calib, args.size, args.unit.map(Unit::metres))?)
}

fn check(args: &CheckArgs) -> Result<(), Failure> {
    let (file, asked) = (&args.file, args.asked()?);
    // What says of rectified images how they are is said of them: a shift of the columns is no mounting.
    let rectified = Calibration::open_all(&file.calib, Path::new(""), file.unit.map(Unit::metres));
    let raw = open(file);
    if let Ok(rectified) = rectified
        && (raw.is_err() || rectified.rig.disparity_offset_px() != 0.0)
    {
        if let Some(ImageSize { width, height }) = file.size {
            rectified.check_size(width, height)?;
        }
        let size = file.size.or(rectified.size());
        if let (None, Some(_)) = (size, asked.range_m) {
            return Err(Failure::usage("--size: is missing; the search for a range of depths takes it"));
        }
        return print(&describe_rectified(&rectified, size, &asked));
    }
    let calibration = raw?;
    let text = describe(&calibration, &asked);
    print(&text.map_err(|e| Failure::new(format!("{}: {e}", calibration.path.display())))?)
}

fn convert(args: &ConvertArgs) -> Result<(), Failure> {
    let place = Place::of("--out", &args.out)?;
    let is_xml = args.out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xml"));
    if is_xml && matches!(args.to, Format::Opencv) {
        return Err(Failure::usage("--out: --to opencv writes YAML, not XML; name another"));
    }
    let calibration = open(&args.file)?;
    let rig = &calibration.rig;
    let name = calibration.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let notes = [format!(
        "A stereo rig, from {} ({}), by stereo calib convert.",
        one_line(&name),
        calibration.format
    )];
    let bytes = match args.to {
        Format::Record => rig.to_record().to_vec(),
        Format::Rust => write_rust(rig, &notes).into_bytes(),
        Format::C => write_c(rig, &notes).into_bytes(),
        Format::Opencv => write_opencv(rig, &notes).into_bytes(),
    };
    place.write(|out| out.write_all(&bytes), None)?;
    let format = format!("{:?}", args.to).to_lowercase();
    print(&format!(
        "{} calibration, baseline {:.4} m, as {format} in {}\n",
        calibration.format,
        rig.baseline_m(),
        one_line(&args.out.display().to_string())
    ))
}
