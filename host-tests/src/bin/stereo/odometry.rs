//! `stereo odometry`: where a camera, or a pair, went, from what it saw.

mod summary;

use crate::failure::Failure;
use crate::image_files::gap;
use crate::input::fits;
use crate::look::{Looked, are_same, rows_of_pair};
use crate::place::{Content, Place};
use crate::progress::Progress;
use crate::rig::warn_of;
use crate::scale::camera;
use crate::shared::{Unit, print, remark, whole};
use clap::{Args, ValueEnum};
use image::GrayImage;
use std::io;
use std::path::{Path, PathBuf};
use stereopsis::geometry::{
    camera::ImageSize,
    rectify::{Crop, Rectification},
};
use stereopsis::motion::odometry::State;
use stereopsis_host::calibration::{Calibration, Cameras, Fault, RawCalibration};
use stereopsis_host::odometry::picture::svg;
use stereopsis_host::odometry::poses;
use stereopsis_host::odometry::run::{MOST_VIEWS, Rig, RunConfig, VIEWS, run as follow};
use stereopsis_host::odometry::sequence::{Sequence, SequenceError};
use stereopsis_host::odometry::trajectory::Trajectory;
use stereopsis_host::rectify::{RectifiedPictures, RectifyPicturesError, rectify};
use stereopsis_host::rows::Rows;
use stereopsis_host::scene::SceneCamera;
use summary::{beside, summary, true_poses};

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo odometry --sequence street --calib street/calib.txt --out poses.txt --picture way.svg

The frames are the images in street/left and street/right, in the order of their names; without \
                           street/right it is one camera. Written is a line for each frame, as KITTI does: \
                           12 numbers, the rows of [R | t], which carries a point of that frame's camera \
                           into the first one's; metres for a pair, of one camera units of its first \
                           baseline. With --format tum it is a time, that camera's place and its \
                           quaternion: t x y z qx qy qz qw. What is not known of a frame is laid between \
                           those that are, and counted in what is printed. Places that come back are not \
                           recognised: errors add up along the way.

A pair that is not rectified (OpenCV's, Kalibr's and ROS's calibrations) is rectified first; its poses are \
                           those of the rectified left camera.";

/// How poses are written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum PoseFormat {
    /// 12 numbers, the rows of [R | t]
    Kitti,
    /// A time, a place and a quaternion: t x y z qx qy qz qw
    Tum,
}

#[derive(Debug, Args)]
pub struct OdometryArgs {
    /// Folder with the frames: left and right, or left alone
    #[arg(long, value_name = "DIR")]
    pub sequence: PathBuf,
    /// Calibration: KITTI's or Middlebury's calib.txt, or OpenCV's, Kalibr's, ROS's (twice, a file for each
    /// camera)
    #[arg(long, value_name = "FILE", required = true)]
    pub calib: Vec<PathBuf>,
    /// The unit of lengths in OpenCV's files, which do not say it: m where none is given
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
    /// Frames that are adjusted together, the last of them, 0 to 12; with 0 or 1 every pose stays as it was
    /// told when its frame came
    #[arg(long, value_name = "N", default_value_t = VIEWS as u16, value_parser = window,
        allow_negative_numbers = true)]
    pub window: u16,
    /// Leave a pair as calibrated also where its points show that it is off
    #[arg(long)]
    pub keep_rig: bool,
    /// File for the poses
    #[arg(long, value_name = "poses.txt")]
    pub out: PathBuf,
    /// How poses are written
    #[arg(long, value_name = "FORM", default_value = "kitti")]
    pub format: PoseFormat,
    /// Times of the frames, seconds, a line each, for --format tum and for a truth with times; without them
    /// the frames' numbers from 0
    #[arg(long, value_name = "FILE")]
    pub times: Option<PathBuf>,
    /// Follow a pair even if its cameras seem to be swapped
    #[arg(long)]
    pub force: bool,
    /// Also draw the way, from above and from the side
    #[arg(long, value_name = "FILE.svg")]
    pub picture: Option<PathBuf>,
    /// Also write what is known of each frame: its state, points, and how sure turn and step are, lines of
    /// CSV
    #[arg(long, value_name = "FILE.csv")]
    pub states: Option<PathBuf>,
    /// True poses in either form: errors are printed, and they are drawn. A line for each frame; with --times
    /// lines of t x y z qx qy qz qw may have other times, and are interpolated at those of the frames
    #[arg(long, value_name = "FILE")]
    pub truth: Option<PathBuf>,
}

fn window(text: &str) -> Result<u16, String> {
    whole(text, 0, MOST_VIEWS as u16)
}

/// Why a frame did not come.
#[derive(Debug, thiserror::Error)]
enum SourceError {
    #[error(transparent)]
    Sequence(#[from] SequenceError),
    #[error(transparent)]
    Rectify(#[from] RectifyPicturesError),
}

/// The cameras, and what aligns their rows where they are not.
struct Cams {
    rig: Rig,
    rectification: Option<Rectification<f64>>,
    format: &'static str,
}

pub fn run(args: &OdometryArgs) -> Result<(), Failure> {
    let sequence = Sequence::open(&args.sequence)?;
    let cameras = cameras(args, &sequence)?;
    let times = times(args, sequence.len())?;
    let files: Vec<_> = (0..sequence.len()).map(|i| sequence.file(i)).collect();
    let missing = gap(&files);
    let truth = true_poses(args, &times, missing.as_ref())?;
    let (place, picture) = Place::with_picture(&args.out, args.picture.as_deref())?;
    let states = args.states.as_deref().map(|path| Place::of("--states", path)).transpose()?;
    if states
        .as_ref()
        .is_some_and(|states| states.is(&place) || picture.as_ref().is_some_and(|p| p.is(states)))
    {
        let what = args.states.as_deref().unwrap_or(Path::new("")).display().to_string();
        return Err(Failure::usage(format!("--states: {what} is the file of another option; name another")));
    }

    let rows = first_rows(args, &sequence, &cameras)?;
    let rows_warning = rows.as_ref().and_then(Rows::warning);
    if let Some(warning) = &rows_warning {
        remark(&format!("warning: {}: {warning}", args.sequence.display()));
    }
    if let Some([before, after]) = &missing {
        remark(&format!(
            "warning: frames seem to be missing, the first of them between {} and {}: the way between them \
             is guessed",
            before.display(),
            after.display()
        ));
    }
    let progress = Progress::over_frames(sequence.len());
    let frames = (0..sequence.len()).map(|i| frame(&sequence, cameras.rectification.as_ref(), i));
    let config = RunConfig {
        views: args.window.into(),
        corrects_rig: !args.keep_rig,
        rows: rows.filter(|_| rows_warning.is_some()).map(|rows| rows.alignment),
    };
    let trajectory = follow(&cameras.rig, frames, config, |_| progress.one_more())?;
    drop(progress);

    let unit = if sequence.is_stereo() { "m" } else { "first baselines" };
    let draw = |out: &mut dyn io::Write| {
        let aligned = truth.as_ref().map(|truth| beside(&trajectory, truth, sequence.is_stereo()));
        out.write_all(svg(&trajectory, aligned.as_deref(), unit).as_bytes())
    };
    let mut others: Vec<(&Place, Content<'_>)> = Vec::new();
    others.extend(picture.as_ref().map(|place| (place, Box::new(draw) as Content<'_>)));
    let list = |out: &mut dyn io::Write| poses::write_states(out, &trajectory.steps, &trajectory.rigs);
    others.extend(states.as_ref().map(|place| (place, Box::new(list) as Content<'_>)));
    let found = |out: &mut dyn io::Write| match args.format {
        PoseFormat::Kitti => poses::write(out, &trajectory.poses),
        PoseFormat::Tum => poses::write_tum(out, &trajectory.poses, &times),
    };
    place.write_all(found, others)?;
    let calib = args.calib.first().map_or(Path::new(""), PathBuf::as_path);
    warn_of(trajectory.rigs.last(), calib, rows_warning.is_none().then(|| sequence.size()));
    print(&summary(args, &sequence, &cameras, &trajectory, truth.as_ref()))?;
    judge(&trajectory, &args.sequence)
}

/// How the rows of the first frame lie, where it is a pair that shows enough. Swapped cameras are an error.
fn first_rows(args: &OdometryArgs, sequence: &Sequence, cameras: &Cams) -> Result<Option<Rows>, Failure> {
    let rectification = cameras.rectification.as_ref();
    let (left, Some(right)) = frame(sequence, rectification, 0)? else { return Ok(None) };
    let is_given_twice = rectification.is_some()
        && matches!(frame(sequence, None, 0)?, (left, Some(right)) if are_same(&left, &right));
    let Rig::Stereo(rig) = &cameras.rig else { return Ok(None) };
    let (camera, offset_px) = (camera(rig), rig.disparity_offset_px().into());
    let looked = Looked { is_given_twice, camera: camera.as_ref(), offset_px, ..Looked::of([&left, &right]) };
    rows_of_pair(&looked, args.force, || exchanged(sequence, rectification?))
}

/// Warns where most frames are lost, and fails where all are: what is written of them is then a guess.
fn judge(trajectory: &Trajectory, sequence: &Path) -> Result<(), Failure> {
    let frames = trajectory.steps.len().saturating_sub(1);
    let lost = trajectory.count(State::Lost) + trajectory.count(State::Restarted);
    let what = format!(
        "{}: {lost} of {frames} frames are lost, and their poses are guessed: frames need texture and light, \
         points in common with the one before, and a right image that is not turned or mirrored",
        sequence.display()
    );
    if lost > 0 && lost == frames {
        return Err(Failure::new(what));
    }
    if 2 * lost > frames {
        remark(&format!("warning: {what}"));
    }
    Ok(())
}

/// Why there is nothing that times could be for.
const NO_TIMES: &str =
    "--times: only --format tum has times, and a --truth of that form; give --format tum too";

/// The time of each frame, or its number.
fn times(args: &OdometryArgs, frames: usize) -> Result<Vec<f64>, Failure> {
    match &args.times {
        Some(_) if args.format != PoseFormat::Tum && args.truth.is_none() => Err(Failure::usage(NO_TIMES)),
        Some(path) => Ok(poses::read_times(path, frames)?),
        None => Ok((0..frames).map(|frame| frame as f64).collect()),
    }
}

fn cameras(args: &OdometryArgs, sequence: &Sequence) -> Result<Cams, Failure> {
    // Images have at most 4096 columns and rows.
    let size = ImageSize { width: sequence.size().0 as u16, height: sequence.size().1 as u16 };
    let [path, ..] = args.calib.as_slice() else { return Err(Failure::usage("--calib: a file is needed")) };
    if args.calib.len() > 2 {
        return Err(Failure::usage(
            "--calib: is given more than twice; a file of both cameras or one of each is needed",
        ));
    }
    if !sequence.is_stereo() {
        // The first camera of whatever the file describes.
        let camera = Cameras::open_first(&args.calib)?;
        fits(path, camera.principal_point(), size)?;
        return Ok(Cams { rig: Rig::Mono(camera), rectification: None, format: "one camera of the" });
    }
    // KITTI's files have a grey and a colour pair: the pictures say which.
    let unit_m = args.unit.map(Unit::metres);
    let pair = if sequence.is_grey() { "image_0" } else { "image_2" };
    match RawCalibration::open(&args.calib, Some(size), unit_m) {
        Ok(raw) if !matches!(raw.format, "KITTI" | "Middlebury") => {
            let named = |e: &dyn std::fmt::Display| Failure::new(format!("{}: {e}", path.display()));
            let rectification = Rectification::new(&raw.rig, Crop::Natural, size).map_err(|e| named(&e))?;
            if !rectification.axis().is_horizontal() {
                return Err(named(
                    &"the cameras are one above the other; an odometry needs them side by side",
                ));
            }
            let rig = rectification.rig().map_err(|e| named(&e))?;
            Ok(Cams { rig: Rig::Stereo(rig), rectification: Some(rectification), format: raw.format })
        }
        raw => {
            let calibration = match (Calibration::open_all(&args.calib, Path::new(pair), unit_m), raw) {
                // What is wrong with the cameras as they are mounted says more.
                (Err(error), Err(raw)) if matches!(error.fault, Fault::NotRectified | Fault::Unknown) => {
                    Err(raw)?
                }
                (found, _) => found?,
            };
            calibration.check_size(size.width, size.height)?;
            let (cx, cy) = calibration.rig.principal_point();
            fits(path, (cx.into(), cy.into()), size)?;
            Ok(Cams { rig: Rig::Stereo(calibration.rig), rectification: None, format: calibration.format })
        }
    }
}

/// The first frame as it would be if the cameras were exchanged.
fn exchanged(sequence: &Sequence, rectification: &Rectification<f64>) -> Option<RectifiedPictures> {
    let (left, right) = sequence.frame(0).ok()?;
    rectify(rectification, SceneCamera::new(right?, left)).ok()
}

/// A frame, its rows aligned.
fn frame(
    sequence: &Sequence,
    rectification: Option<&Rectification<f64>>,
    index: usize,
) -> Result<(GrayImage, Option<GrayImage>), SourceError> {
    let (left, right) = sequence.frame(index)?;
    match (rectification, right) {
        (Some(rectification), Some(right)) => {
            let [left, right] = rectify(rectification, SceneCamera::new(left, right))?.pictures;
            Ok((left, Some(right)))
        }
        (_, right) => Ok((left, right)),
    }
}
