//! `stereo focus`: depth from a stack of frames with the lens in different positions.

use crate::failure::Failure;
use crate::place::png;
use crate::shared::{length, print, remark};
use clap::Args;
use image::RgbImage;
use std::fmt::Write as _;
use std::path::PathBuf;
use stereopsis::focus::{FocusScale, ThinLens};
use stereopsis_host::command_line::one_line;
use stereopsis_host::focus::breathing::Agreement;
use stereopsis_host::focus::order::{Look, Order, order};
use stereopsis_host::focus::positions::read_positions;
use stereopsis_host::focus::run::{FocusResult, run as map};
use stereopsis_host::focus::stack::{Stack, StackError};
use stereopsis_host::output::Staging;
use stereopsis_host::pfm;
use stereopsis_host::ply::{self, ColouredPoint};
use stereopsis_host::report::FocusReport;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo focus --frames stack --focal-length-mm 4 --positions positions.csv --out depth

Written into the folder: index.pfm (the frame in which each pixel is sharpest, from 1, with its fraction; \
                           infinity where there is no answer), confidence.pfm (0 to 1), all_in_focus.png \
                           (each pixel as in that frame), index_colour.png, report.html; with the lens's \
                           data also depth.pfm (metres), with --focal-px cloud.ply.

The positions are lines, one a frame in the order of the frames' names, under the header image_distance_mm \
                           (from lens to sensor) or focus_distance_mm (from lens to what is in focus); \
                           without one of these, the last number of a line counts, in mm, as the distance \
                           to the sensor if no line has more than two focal lengths. Frames that grow with \
                           the sensor's distance are brought to one size.

A frame that is out of order or spoiled is named and left out; the others keep their numbers. Frames whose \
                           sharpness rises and falls again and again, as on a drive, are refused.";

#[derive(Debug, Args)]
pub struct FocusArgs {
    /// Folder with the frames, images of one size; they count in the order of their names
    #[arg(long, value_name = "DIR")]
    pub frames: PathBuf,
    /// Focal length of the lens, mm; with --positions it gives depths
    #[arg(long, value_name = "F", requires = "positions", value_parser = focal_length,
        allow_negative_numbers = true)]
    pub focal_length_mm: Option<f64>,
    /// Where the lens stood in each frame; with --focal-length-mm it gives depths
    #[arg(long, value_name = "FILE.csv", requires = "focal_length_mm")]
    pub positions: Option<PathBuf>,
    /// Focal length of the camera in pixels, from a calibration or focal length / pixel pitch; with depths it
    /// gives cloud.ply
    #[arg(long, value_name = "PX", requires = "positions", value_parser = length, allow_negative_numbers =
        true)]
    pub focal_px: Option<f32>,
    /// Take all frames in the order of their names, whatever they show
    #[arg(long)]
    pub force: bool,
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

fn focal_length(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.1..=10_000.0).contains(value));
    value.ok_or("a number of millimetres from 0.1 to 10000 is needed")
}

/// What is written only with lens data. A run without them takes the files of an earlier run away.
const WITH_DEPTH: [&str; 2] = ["depth.pfm", "cloud.ply"];

pub fn run(args: &FocusArgs) -> Result<(), Failure> {
    let stack = Stack::open(&args.frames)?;
    let positions = positions(args, stack.len())?;
    let kept = kept(args, &stack)?;
    let positions = positions.map(|(lens, all)| (lens, kept.iter().map(|&i| all[i]).collect::<Vec<_>>()));
    let scale = match (&positions, &args.positions) {
        (Some((lens, images)), Some(path)) => {
            let named = |error| Failure::new(format!("{}: {error}", path.display()));
            Some(FocusScale::new(*lens, images).map_err(named)?)
        }
        _ => None,
    };
    Staging::probe(&args.out)?;
    let (width, height) = stack.size();
    // Images have at most 4096 columns and rows.
    let size = (width as u16, height as u16);
    let breathing = match &scale {
        Some(scale) => breathes(&stack, &kept, scale)?,
        None => false,
    };
    let result = map(size, kept.iter().map(|&index| stack.frame(index)), scale.as_ref(), breathing)?;
    let numbers: Vec<usize> = kept.iter().map(|index| index + 1).collect();

    let mut staging = Staging::new(&args.out)?;
    staging.write("index.pfm", |out| pfm::write(out, result.width, &result.index_in(&numbers)))?;
    staging.write("confidence.pfm", |out| pfm::write(out, result.width, &result.confidence()))?;
    staging.write("all_in_focus.png", |out| png(out, &result.picture))?;
    let (index, confidence) = (result.index_in(&numbers), result.confidence());
    let depth_m = scale.as_ref().map(|scale| result.depth_m(scale));
    let name = args.frames.display().to_string();
    let report = FocusReport {
        name: &name,
        frames: stack.len(),
        picture: &result.picture,
        index: &index,
        confidence: &confidence,
        depth_m: depth_m.as_deref(),
        focal_px: args.focal_px,
    };
    staging.write("index_colour.png", |out| png(out, &report.index_colour()))?;
    staging.write("report.html", |out| report.write(out))?;
    if let Some(depth_m) = &depth_m {
        staging.write(WITH_DEPTH[0], |out| pfm::write(out, result.width, depth_m))?;
    }
    if let Some((depth_m, focal_px)) = depth_m.as_ref().zip(args.focal_px) {
        let points = points(depth_m, &result.picture, focal_px);
        staging.write(WITH_DEPTH[1], |out| ply::write(out, &points))?;
    }
    staging.commit(&WITH_DEPTH)?;

    if result.answers() == 0 {
        remark(
            "warning: nothing is sharper in one frame than in the others; give frames of one scene with \
             texture, each focused at another distance",
        );
    }
    warn_of_doubt(&result);
    let share = 100.0 * result.answers() as f64 / result.peaks.len().max(1) as f64;
    let mut text =
        format!("{} frames of {width} x {height} pixels, {share:.1} % in focus in one of them\n", kept.len());
    if scale.is_some() {
        let grow = if breathing {
            "grow as the lens says: corrected"
        } else {
            "do not grow as the lens says: left as they are"
        };
        let _ = writeln!(text, "the frames {grow}");
    }
    let _ = writeln!(text, "results are in {}", one_line(&args.out.display().to_string()));
    print(&text)
}

/// The middle confidence below which frames are hardly a stack: stacks of real lenses have over half, frames
/// of a camera that moves a quarter.
const LEAST_CONFIDENCE: f32 = 0.35;

/// Warns where few pixels have a peak, or their peaks are none to rely on.
fn warn_of_doubt(result: &FocusResult) {
    let mut sure: Vec<_> = result.confidence().into_iter().filter(|&sure| sure > 0.0).collect();
    sure.sort_unstable_by(f32::total_cmp);
    let Some(&middle) = sure.get(sure.len() / 2) else { return };
    if 2 * result.answers() < result.textured() || middle < LEAST_CONFIDENCE {
        remark(&format!(
            "warning: {:.0} % of the pixels with texture are in focus in one of the frames, with a middle \
             confidence of {middle:.2}: is it a focus stack? give frames of one scene from one place, each \
             focused at another distance",
            100.0 * result.answers() as f64 / result.textured().max(1) as f64
        ));
    }
}

/// The pixels with a depth in space, with the picture's colours: the centre of the view is the picture's.
fn points(depth_m: &[f32], picture: &RgbImage, focal_px: f32) -> Vec<ColouredPoint> {
    let (width, height) = picture.dimensions();
    let [cx, cy] = [width, height].map(|side| (side - 1) as f32 / 2.0);
    let seen = depth_m.iter().zip(picture.enumerate_pixels()).filter(|(z, _)| z.is_finite());
    let point = |(&z, (u, v, colour)): (&f32, (u32, u32, &image::Rgb<u8>))| ColouredPoint {
        position_m: [(u as f32 - cx) * z / focal_px, (v as f32 - cy) * z / focal_px, z],
        colour: colour.0,
    };
    seen.map(point).collect()
}

/// A lens, and for each frame its distance from the sensor, m.
type Positions = (ThinLens<f32>, Vec<f32>);

/// Those of the options, if both are told of.
fn positions(args: &FocusArgs, frames: usize) -> Result<Option<Positions>, Failure> {
    let (Some(focal_mm), Some(path)) = (args.focal_length_mm, &args.positions) else { return Ok(None) };
    let named = |error| Failure::new(format!("--focal-length-mm {focal_mm}: {error}"));
    let lens = ThinLens::new(focal_mm / 1000.0).map_err(named)?;
    let single = ThinLens::new((focal_mm / 1000.0) as f32).map_err(named)?;
    Ok(Some((single, read_positions(path, lens, frames)?)))
}

/// The frames that are a stack, counted from 0; the others are named.
fn kept(args: &FocusArgs, stack: &Stack) -> Result<Vec<usize>, Failure> {
    let all = 0..stack.len();
    if args.force {
        return Ok(all.collect());
    }
    let looks = all.clone().map(|index| Ok(Look::new(&stack.frame(index)?.grey)));
    let looks = looks.collect::<Result<Vec<_>, StackError>>()?;
    let Order::Stack(out) = order(&looks) else {
        return Err(Failure::new(format!(
            "{}: is no focus stack: sharpness rises and falls over and over again, as when a camera moves; \
             give frames of one scene in the order of the lens's positions, or --force",
            args.frames.display()
        )));
    };
    for &index in &out {
        remark(&format!(
            "warning: {}: is out of order or spoiled, for its neighbours are alike; left out",
            stack.file(index).display()
        ));
    }
    Ok(all.filter(|index| !out.contains(index)).collect())
}

/// Whether frames agree better with each other at the sizes that the lens gives them.
fn breathes(stack: &Stack, kept: &[usize], scale: &FocusScale<'_>) -> Result<bool, Failure> {
    let mut agreement = Agreement::default();
    let Some((&first, others)) = kept.split_first() else { return Ok(false) };
    let mut before = stack.frame(first)?;
    let mut ratio = 1.0;
    for (index, &number) in (1..).zip(others) {
        ratio *= scale.growth(index).unwrap_or(1.0);
        // The next frame by itself may hardly differ.
        if Agreement::is_telling(stack.size(), ratio) {
            let after = stack.frame(number)?;
            agreement.add(&before.grey, &after.grey, ratio);
            (before, ratio) = (after, 1.0);
        }
    }
    Ok(agreement.is_breathing())
}
