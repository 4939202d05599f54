//! `stereo match`: a pair, rectified or raw, into a folder of results.

use crate::failure::Failure;
use crate::frame::{Matched, matched};
use crate::input::Pair;
use crate::look::{Look, MaskArgs, SearchArgs, look};
use crate::many;
use crate::place::{json, png};
use crate::rectified::{self, RectifiedCameras};
use crate::results::{self, DepthArgs, DepthFiles, figures, place};
use crate::scale::{camera, scale};
use crate::settings::{self, Setting, setting};
use crate::shared::{BalanceArgs, MethodArgs, RectifyOptions, colour_range, length, print};
use crate::sources::{SourceArgs, Sources};
use clap::Args;
use image::{RgbImage, imageops};
use std::fmt::Display;
use std::io::Write as _;
use std::path::PathBuf;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::ImageSize;
use stereopsis_host::colour::ColourScale;
use stereopsis_host::command_line::one_line;
use stereopsis_host::masked::MaskedPair;
use stereopsis_host::output::Staging;
use stereopsis_host::pair::PairCheck;
use stereopsis_host::rectify::{rectify, rectify_colours, with_rectified};
use stereopsis_host::report::{Report, Summary};
use stereopsis_host::rows::Rows;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo match --left left.png --right right.png --disparities 64 --calib calib.txt --out out/scene
  stereo match --left 'left*.png' --right 'right*.png' --disparities 64 --out out/all
  ffmpeg -i pair.mp4 -f rawvideo -pix_fmt gray - | stereo match --raw 1280x480 --side-by-side - --disparities 64 \
                           --out out/frames
  stereo match --left raw_left.png --right raw_right.png --disparities 64 --rectify --calib stereo.yml --out \
                           out/raw

Written into the folder: disparity.pfm (px, infinity where there is no answer), disparity.png (16 bit, px x \
                           256, 0 where there is none), disparity_colour.png (near is bright), flags.png (a \
                           byte a pixel: 1 outside, 2 ceiling, 4 untextured, 8 ambiguous, 16 mismatch, 32 \
                           speckle, 64 filled), confidence.png (a byte a pixel: surer is more, 0 is no \
                           answer), summary.json and report.html; with --calib also depth.pfm (metres), \
                           depth.png (16 bit, millimetres) and cloud.ply; with --rectify also \
                           rectified_left.png, rectified_right.png and rectified.json, the cameras of all \
                           the others. The files appear together when all of them are complete. Of several pairs \
                           each has a numbered folder with these files, and frames.csv has a line for each; \
                           what is finished is not done again.";

#[derive(Clone, Debug, Args)]
pub struct MatchArgs {
    #[command(flatten)]
    pub source: SourceArgs,
    #[command(flatten)]
    pub search: SearchArgs,
    #[command(flatten)]
    pub method: MethodArgs,
    #[command(flatten)]
    pub balance: BalanceArgs,
    /// Calibration of the pair, for depths: a Middlebury or KITTI calib.txt, what OpenCV or ROS (twice) say
    /// of rectified images, or rectified.json; with --rectify how the cameras are mounted, as for the
    /// command rectify
    #[arg(long, value_name = "FILE")]
    pub calib: Vec<PathBuf>,
    /// Take the images raw, as the cameras give them, and rectify them line by line before they are matched
    #[arg(long)]
    pub rectify: bool,
    #[command(flatten)]
    pub masks: MaskArgs,
    #[command(flatten)]
    pub options: RectifyOptions,
    /// Focal length of the rectified cameras, px, where there is no file: their centre is taken to be that of
    /// the images
    #[arg(long, value_name = "PX", conflicts_with = "calib", requires = "baseline_mm", value_parser = length,
        allow_negative_numbers = true)]
    pub focal_px: Option<f32>,
    /// Distance of the two cameras, mm
    #[arg(long, value_name = "MM", requires = "focal_px", value_parser = length, allow_negative_numbers =
        true)]
    pub baseline_mm: Option<f32>,
    #[command(flatten)]
    pub depth: DepthArgs,
    /// Disparities from the darkest to the brightest colour of disparity_colour.png, px, as 0:64: those
    /// searched where none are given
    #[arg(long, value_name = "A:B", value_parser = colour_range, allow_negative_numbers = true)]
    pub colour_range: Option<ColourScale>,
    /// Match one pair with each of several settings, METHOD, METHOD:FILTER or METHOD:FILTER:NOISE with commas
    /// between them: a folder for each, a table, and settings.png, which shows all side by side
    #[arg(long, value_name = "SETTINGS", value_delimiter = ',', value_parser = setting, conflicts_with_all =
        ["method", "filter", "noise"])]
    pub settings: Vec<Setting>,
    /// Print summary.json in place of the figures
    #[arg(long, conflicts_with = "quiet")]
    pub json: bool,
    /// Print no figures; warnings and notes are on standard error
    #[arg(long)]
    pub quiet: bool,
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// What is written only of raw images.
const RECTIFIED: [&str; 3] = ["rectified_left.png", "rectified_right.png", "rectified.json"];

/// What is matched, and what its depths are.
struct Scene {
    left: RgbImage,
    right: RgbImage,
    scale: Option<DepthScale>,
    rectified: Option<RectifiedCameras>,
    rows: Option<Rows>,
    check: Option<PairCheck>,
}

/// What a folder that is finished says of its images and settings, of which there are many.
pub const FINISHED: &str = "finished.json";

pub fn run(args: &MatchArgs) -> Result<(), Failure> {
    let mut notes = Vec::new();
    let sources = args.source.open(&mut notes)?;
    if !args.settings.is_empty() {
        let Sources::One(input) = &sources else {
            return Err(Failure::new("--settings: is for one pair; give one, or one setting to many pairs"));
        };
        return settings::run(args, input);
    }
    for note in notes {
        let _ = writeln!(std::io::stderr(), "stereo: note: {}", one_line(&note));
    }
    match sources {
        Sources::Many(inputs) => {
            let count = inputs.len();
            many::run(args, inputs.into_iter().map(Ok), Some(count))
        }
        Sources::Raw(frames) => many::run(args, frames, None),
        Sources::One(input) => {
            let (summary, rectified) = solve(args, input.open()?, None, "")?;
            tell(args, &summary, rectified.as_ref())
        }
    }
}

/// Matches a pair and writes its results, and `mark` where there is one; warnings begin with `label`.
pub fn solve(
    args: &MatchArgs,
    mut pair: Pair,
    mark: Option<&str>,
    label: &str,
) -> Result<(Summary, Option<RectifiedCameras>), Failure> {
    args.search.check(&args.method, pair.width, pair.height)?;
    let (scene, matched) = if args.rectify {
        raw(args, &mut pair)?
    } else {
        let scale = scale(args, &pair)?;
        Staging::probe(&args.out)?;
        let [left, right] = [&pair.left, &pair.right].map(imageops::grayscale);
        let camera = scale.as_ref().and_then(|scale| camera(scale.rig()));
        let masks = args.masks.read(&args.calib, left.dimensions())?;
        let valid = masks.as_ref().map(|masks| masks.each_ref());
        let Look { config, check, rows } =
            look(&args.search, &args.method, [&left, &right], valid, camera.as_ref())?;
        let matched = match masks {
            Some(masks) => {
                matched(&args.method, &args.balance, config, &mut MaskedPair::new(&mut pair.camera, masks))?
            }
            None => matched(&args.method, &args.balance, config, &mut pair.camera)?,
        };
        (Scene { left: pair.left, right: pair.right, scale, rectified: None, rows, check }, matched)
    };

    let Matched { config, meter, balance, outcome } = matched;
    let scale = scene.scale.as_ref();
    let summary = Summary::new(args.method.method, args.method.filter.name(), &config, &outcome, scale, None);
    let summary = summary.with_noise(meter.as_ref()).with_balance(balance).with_rows(scene.rows);
    let masks = if args.rectify { None } else { args.masks.files(&args.calib) };
    let inputs = pair.inputs.iter().chain(&args.calib);
    let inputs = inputs.chain(masks.iter().flatten()).map(PathBuf::as_path);
    let mut summary = summary.with_pair(scene.check.clone()).with_inputs(inputs);
    let depth = scale.map(|s| DepthFiles::new(&args.depth, &outcome.map, s, &scene.left, &mut summary));
    let report = Report {
        left_name: &pair.names[0],
        right_name: &pair.names[1],
        left: &scene.left,
        right: &scene.right,
        map: &outcome.map,
        summary: &summary,
        rig: scale.map(DepthScale::rig),
        truth: None,
        colours: args.colour_range,
    };
    let mut staging = Staging::new(&args.out)?;
    results::write(&mut staging, &report, depth.as_ref())?;
    let [left, right, cameras] = RECTIFIED;
    if let Some(rectified) = &scene.rectified {
        staging.write(left, |out| png(out, &scene.left))?;
        staging.write(right, |out| png(out, &scene.right))?;
        staging.write(cameras, |out| json(out, rectified))?;
    }
    if let Some(mark) = mark {
        staging.write(FINISHED, |out| out.write_all(mark.as_bytes()))?;
    }
    let stale: Vec<_> = results::WITH_DEPTH.into_iter().chain(RECTIFIED).chain([FINISHED]).collect();
    staging.commit(&stale)?;

    let warnings = [
        scene.check.as_ref().and_then(|check| check.fault).map(|fault| fault.to_string()),
        scene.check.as_ref().and_then(|check| check.search_warning(&config)),
        scene.rows.as_ref().and_then(Rows::warning),
        summary.few_answers(),
    ];
    let notes = pair.notes.iter().map(|note| format!("note: {}", one_line(note)));
    let warnings = warnings.into_iter().flatten().map(|warning| format!("warning: {warning}"));
    for line in notes.chain(warnings) {
        // Nobody is left to tell when standard error is closed.
        let _ = writeln!(std::io::stderr(), "stereo: {label}{line}");
    }
    Ok((summary, scene.rectified))
}

/// Prints the figures of one pair as the options ask for.
fn tell(args: &MatchArgs, summary: &Summary, rectified: Option<&RectifiedCameras>) -> Result<(), Failure> {
    if args.quiet {
        return Ok(());
    }
    if args.json {
        return print(&(serde_json::to_string_pretty(summary)? + "\n"));
    }
    let mut text = figures(summary);
    if let Some(rectified) = rectified {
        text += &rectified.figures();
    }
    text += &place(&args.out);
    print(&text)
}

/// Matches a raw pair: remap, census and matching in one loop over the rows.
fn raw(args: &MatchArgs, pair: &mut Pair) -> Result<(Scene, Matched), Failure> {
    if args.calib.is_empty() {
        return Err(Failure::new("--rectify: --calib is missing; give the calibration of the two cameras"));
    }
    let size = ImageSize { width: pair.width, height: pair.height };
    let (calibration, rectification) = rectified::open(&args.calib, &args.options, size)?;
    let named = |e: &dyn Display| Failure::new(format!("{}: {e}", calibration.path.display()));
    if !rectification.axis().is_horizontal() {
        return Err(named(&"the cameras stand below each other; match takes cameras beside each other"));
    }
    let rig = rectification.rig().map_err(|e| named(&e))?;
    let scale = DepthScale::new(&rig).map_err(|e| named(&e))?;
    Staging::probe(&args.out)?;
    let (left, right) = rectify_colours(&rectification, &pair.left, &pair.right).map_err(|e| named(&e))?;
    let grey = rectify(&rectification, &mut pair.camera).map_err(|e| named(&e))?;
    let (valid, camera) = (grey.valid.each_ref(), rectification.camera());
    let seen = look(&args.search, &args.method, grey.pictures.each_ref(), Some(valid), Some(camera))?;
    let Look { config, check, rows: aligned } = seen;
    let (rows, matched) = with_rectified(&rectification, &mut pair.camera, |source| {
        (
            source.remaps().map(|remap| remap.table().rows()),
            matched(&args.method, &args.balance, config, source),
        )
    })
    .map_err(|e| named(&e))?;
    let cameras = RectifiedCameras::new(calibration.format, &rectification, rows, &rectification.report());
    let scene = Scene { left, right, scale: Some(scale), rectified: Some(cameras), rows: aligned, check };
    Ok((scene, matched?))
}
