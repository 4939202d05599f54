//! The command line: options, their limits, help.

mod calib;
mod calibrate;
mod rectify;

pub use calib::{CalibArgs, CalibCommand, CheckArgs, ConvertArgs, FileArgs, Format};
pub use calibrate::CalibrateArgs;
pub use rectify::{RectifyArgs, RectifyOptions, Unit};

use crate::bundle::{self, BundleArgs};
use crate::failure::Failure;
use crate::focus::{self, FocusArgs};
use crate::odometry::{self, OdometryArgs};
use crate::record::{self, RecordArgs};
use crate::replay::{self, ReplayArgs};
use crate::structure::{self, StructureArgs};
use crate::two_view::{
    FEATURES_EXAMPLE, FUNDAMENTAL_EXAMPLE, FeaturesArgs, FundamentalArgs, POSE_EXAMPLE, PoseArgs,
};
use crate::walk::{self, WalkArgs};
use clap::error::ErrorKind;
use clap::{Args, Parser, Subcommand};
use std::ffi::OsString;
use std::path::PathBuf;
use stereopsis::matching::{Config, Filter, Kernel};
use stereopsis_host::command_line::usage_line;
use stereopsis_host::run::{MethodName, NoiseChoice, UnknownMethod, UnknownNoise, Way};

/// What is told to one who names another command.
const COMMANDS: &str = "the commands are demo, match, bench, calibrate, calib, rectify, features, focus, fundamental, pose, bundle, \
                        odometry, structure, walk, record and replay";

const EXAMPLES: &str = "Examples:
  stereo demo --out demo-out
  stereo match --left left.png --right right.png --disparities 64 --calib calib.txt --out out/scene
  stereo bench --left left.png --right right.png --disparities 64 --method fast
  stereo features --left first.png --right second.png --out matches.csv

The images of match and bench are a rectified pair; all are PNG, JPEG, PGM/PPM or TIFF, 8 or 16 bit, grey or colour, up to 4096 x 4096.";

const MATCH_EXAMPLE: &str = "Example:
  stereo match --left left.png --right right.png --disparities 64 --calib calib.txt --out out/scene
  stereo match --left raw_left.png --right raw_right.png --disparities 64 --rectify --calib stereo.yml --out out/raw

Written into the folder: disparity.pfm (px, infinity where there is no answer), disparity.png (16 bit, px x 256, 0 where \
there is none), disparity_colour.png (near is bright), flags.png (a byte a pixel: 1 outside, 2 ceiling, 4 untextured, \
8 ambiguous, 16 mismatch, 32 speckle, 64 filled), confidence.png (a byte a pixel: surer is more, 0 is no answer), summary.json and report.html; with --calib also depth.pfm (metres), depth.png \
(16 bit, millimetres) and cloud.ply; with --rectify also rectified_left.png, rectified_right.png and rectified.json, the \
cameras of all the others. The files appear together when all of them are complete.";

const BENCH_EXAMPLE: &str = "Example:
  stereo bench --left left.png --right right.png --disparities 64 --method fast --repeat 9

Printed is one JSON object: frame_ms (a time for each frame, after one that is left out; files and start-up left out, one \
thread), kernel, width, height, disparities, state_bytes, noise.";

#[derive(Debug, Parser)]
#[command(
    name = "stereo",
    version,
    about = "Depth from two images, by the code that runs on the microcontroller"
)]
#[command(after_help = EXAMPLES, arg_required_else_help = false)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Match a built-in ray-traced scene and compare the answers with its true depth
    Demo(DemoArgs),
    /// Match a rectified pair of images: disparity, depth, a point cloud and a report
    #[command(after_help = MATCH_EXAMPLE)]
    Match(MatchArgs),
    /// Time the matching of a rectified pair of images
    #[command(after_help = BENCH_EXAMPLE)]
    Bench(BenchArgs),
    /// Align the rows of an unrectified pair of images, by a calibration of the two cameras
    #[command(after_help = rectify::EXAMPLE)]
    Rectify(RectifyArgs),
    /// Find two cameras, their lenses and where they stand from images of a chessboard
    #[command(after_help = calibrate::EXAMPLE)]
    Calibrate(CalibrateArgs),
    /// Check a calibration file, or write it in another format
    #[command(after_help = calib::EXAMPLE, arg_required_else_help = false, subcommand_required = true)]
    Calib(CalibArgs),
    /// Estimate the fundamental matrix of two images from matches, some of them wrong
    #[command(after_help = FUNDAMENTAL_EXAMPLE)]
    Fundamental(FundamentalArgs),
    /// Estimate where the second of two known cameras stands from matches, and the points they show
    #[command(after_help = POSE_EXAMPLE)]
    Pose(PoseArgs),
    /// Find points of one image in another: corners, matched by what they look like
    #[command(after_help = FEATURES_EXAMPLE)]
    Features(FeaturesArgs),
    /// Tell depth by focus: frames of one scene with the lens in different positions
    #[command(after_help = focus::EXAMPLE)]
    Focus(FocusArgs),
    /// Refine cameras and points until they agree best with what was seen: bundle adjustment of a problem in
    /// BAL's format
    #[command(after_help = bundle::EXAMPLE)]
    Bundle(BundleArgs),
    /// Make a recording of a camera from images, with faults if they are wanted
    #[command(after_help = record::EXAMPLE)]
    Record(RecordArgs),
    /// Play recorded lines, with the faults that they had, through the code that runs on the device
    #[command(after_help = replay::EXAMPLE)]
    Replay(ReplayArgs),
    /// Tell where a camera, or a pair, went: a sequence of frames into a trajectory
    #[command(after_help = odometry::EXAMPLE)]
    Odometry(OdometryArgs),
    /// Tell where a camera stood and what it saw: pictures from several places into poses and points
    #[command(after_help = structure::EXAMPLE)]
    Structure(StructureArgs),
    /// Drive through a built-in street: a sequence of frames with true poses, for odometry
    #[command(after_help = walk::EXAMPLE)]
    Walk(WalkArgs),
}

#[derive(Debug, Args)]
pub struct DemoArgs {
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR", default_value = "demo-out")]
    pub out: PathBuf,
    #[command(flatten)]
    pub way: WayArgs,
}

#[derive(Debug, Args)]
pub struct MatchArgs {
    #[command(flatten)]
    pub pair: PairArgs,
    #[command(flatten)]
    pub range: RangeArgs,
    #[command(flatten)]
    pub way: WayArgs,
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
    pub options: RectifyOptions,
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

#[derive(Debug, Args)]
pub struct BenchArgs {
    #[command(flatten)]
    pub pair: PairArgs,
    #[command(flatten)]
    pub range: RangeArgs,
    #[command(flatten)]
    pub way: WayArgs,
    /// How many frames are timed, 1 to 10000
    #[arg(long, value_name = "K", default_value_t = 5, value_parser = repeat, allow_negative_numbers = true)]
    pub repeat: u16,
}

#[derive(Debug, Args)]
pub struct PairArgs {
    /// The left image
    #[arg(long, value_name = "FILE")]
    pub left: PathBuf,
    /// The right image
    #[arg(long, value_name = "FILE")]
    pub right: PathBuf,
}

#[derive(Debug, Args)]
pub struct RangeArgs {
    /// How many whole disparities are searched: 16 to 256, at most the images' width
    #[arg(long, value_name = "N", value_parser = disparities, allow_negative_numbers = true)]
    pub disparities: u16,
    /// The smallest disparity searched, px
    #[arg(long, value_name = "M", default_value_t = 0, value_parser = min_disparity, allow_negative_numbers = true)]
    pub min_disparity: u16,
}

#[derive(Debug, Args)]
pub struct WayArgs {
    /// fast (4-bit census, 9x7 window), block (8-bit census, 9x9 window), or along paths sgm-lean, sgm and
    /// sgm-edge
    #[arg(long, value_name = "METHOD", default_value = "block", value_parser = method)]
    pub method: MethodName,
    /// dense (an answer wherever there is a candidate), default, or strict (sure answers only)
    #[arg(long, value_name = "FILTER", default_value = "default", value_parser = filter)]
    pub filter: Filter,
    /// How noisy the images are: none, low (a deviation of about 2 grey levels), high (3 and more), or auto,
    /// which measures it
    #[arg(long, value_name = "NOISE", default_value = "auto", value_parser = noise)]
    pub noise: NoiseChoice,
    /// The kernel that does the work, by default the fastest of this processor; all give the same bits
    #[arg(long, value_name = "KERNEL", env = "STEREO_KERNEL", value_parser = kernel)]
    pub kernel: Option<Kernel>,
    /// How many threads share a frame, 1 to 64, each a band of rows; fast and block give the same bits
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = threads, allow_negative_numbers = true)]
    pub threads: u16,
}

impl WayArgs {
    /// The method, on the kernel, in the threads.
    pub fn way(&self) -> Way {
        Way { method: self.method, kernel: self.kernel, threads: self.threads }
    }
}

#[derive(Debug, Args)]
pub struct BalanceArgs {
    /// Whether the right image is brought to the left one's exposure: auto, where they clearly differ and
    /// the method compares brightness (sgm-lean, sgm, sgm-edge), or none
    #[arg(long, value_name = "BALANCE", default_value = "auto", value_parser = balance)]
    balance: BalanceChoice,
}

impl BalanceArgs {
    /// Whether exposures are balanced for that method.
    pub fn is_for(&self, method: MethodName) -> bool {
        self.balance == BalanceChoice::Auto && method.compares_brightness()
    }
}

/// Whether exposures are balanced.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum BalanceChoice {
    Auto,
    None,
}

fn balance(text: &str) -> Result<BalanceChoice, &'static str> {
    match text {
        "auto" => Ok(BalanceChoice::Auto),
        "none" => Ok(BalanceChoice::None),
        _ => Err("the balance is auto or none"),
    }
}

pub fn noise(text: &str) -> Result<NoiseChoice, String> {
    text.parse().map_err(|unknown: UnknownNoise| unknown.to_string())
}

pub fn filter(text: &str) -> Result<Filter, &'static str> {
    Filter::ALL
        .into_iter()
        .find(|filter| filter.name() == text)
        .ok_or("the filters are dense, default and strict")
}

fn kernel(text: &str) -> Result<Kernel, String> {
    Kernel::available().find(|kernel| kernel.name() == text).ok_or_else(|| {
        let names: Vec<_> = Kernel::available().map(Kernel::name).collect();
        format!("this processor's are {}; STEREO_KERNEL names one too", names.join(", "))
    })
}

pub fn method(text: &str) -> Result<MethodName, String> {
    text.parse().map_err(|unknown: UnknownMethod| unknown.to_string())
}

fn disparities(text: &str) -> Result<u16, String> {
    whole(text, Config::FEWEST_DISPARITIES, Config::MOST_DISPARITIES)
}

fn threads(text: &str) -> Result<u16, String> {
    whole(text, 1, 64)
}

fn min_disparity(text: &str) -> Result<u16, String> {
    whole(text, 0, Config::END - Config::FEWEST_DISPARITIES)
}

fn repeat(text: &str) -> Result<u16, String> {
    whole(text, 1, 10_000)
}

/// A whole number within limits, or what is needed.
pub fn whole(text: &str, least: u16, most: u16) -> Result<u16, String> {
    let value = text.parse().ok().filter(|value| (least..=most).contains(value));
    value.ok_or_else(|| format!("a whole number from {least} to {most} is needed"))
}

/// Why there is no command to run.
#[derive(Debug)]
pub enum Stop {
    /// Help or the version was asked for: what to print.
    Help(String),
    /// The command line is wrong.
    Usage(Failure),
}

/// Reads the command line.
pub fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Command, Stop> {
    Cli::try_parse_from(args).map(|cli| cli.command).map_err(|error| match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => Stop::Help(error.render().to_string()),
        _ => Stop::Usage(Failure::new(usage_line(&error, COMMANDS))),
    })
}
