//! The command line: options, their limits, help.

mod rectify;

pub use rectify::{RectifyArgs, Unit};

use crate::failure::Failure;
use clap::error::ErrorKind;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;
use stereopsis::matching::{Config, Filter, Kernel};
use stereopsis_host::command_line::usage_line;
use stereopsis_host::correspond::Plan;
use stereopsis_host::run::{Method, NoiseChoice, UnknownMethod, UnknownNoise, Way};

/// What is told to one who names another command.
const COMMANDS: &str = "the commands are demo, match, bench, rectify, features, fundamental and pose";

const EXAMPLES: &str = "Examples:
  stereo demo --out demo-out
  stereo match --left left.png --right right.png --disparities 64 --calib calib.txt --out out/scene
  stereo bench --left left.png --right right.png --disparities 64 --method fast
  stereo features --left first.png --right second.png --out matches.csv

The images of match and bench are a rectified pair; all are PNG, JPEG, PGM/PPM or TIFF, 8 or 16 bit, grey or colour, up to 4096 x 4096.";

const MATCH_EXAMPLE: &str = "Example:
  stereo match --left left.png --right right.png --disparities 64 --calib calib.txt --out out/scene

Written into the folder: disparity.pfm (px, infinity where there is no answer), disparity.png (16 bit, px x 256, 0 where \
there is none), disparity_colour.png (near is bright), flags.png (a byte a pixel: 1 outside, 2 ceiling, 4 untextured, \
8 ambiguous, 16 mismatch, 32 speckle, 64 filled), confidence.png (a byte a pixel: surer is more, 0 is no answer), summary.json and report.html; with --calib also depth.pfm (metres), depth.png \
(16 bit, millimetres) and cloud.ply. The files appear together when all of them are complete.";

const BENCH_EXAMPLE: &str = "Example:
  stereo bench --left left.png --right right.png --disparities 64 --method fast --repeat 9

Printed is one JSON object: frame_ms (a time for each frame, after one that is left out; files and start-up left out, one \
thread), kernel, width, height, disparities, state_bytes, noise.";

const FUNDAMENTAL_EXAMPLE: &str = "Example:
  stereo fundamental --matches matches.csv --out fundamental.json

Written is one JSON object: fundamental (3x3 in rows, p1^T F p2 = 0 for a point p1 of the first image and p2 of the second), \
inliers (whether each match is within the threshold), time_us (the estimate alone, the best of five); with ransac also \
samples and miss_probability, the probability that a better estimate was missed.";

const POSE_EXAMPLE: &str = "Example:
  stereo pose --matches matches.csv --calib calib.txt --out pose.json

Written is one JSON object: essential (3x3 in rows), rotation and translation (a point P' of the second camera is \
R P' + t in the first; t has length one, for the scale is not in the matches), points (in the first camera, the baseline is \
one; null where a match is wrong or its sights are parallel), inliers, and model: fundamental, or homography when what \
was seen is on a plane.";

const FEATURES_EXAMPLE: &str = "Example:
  stereo features --left first.png --right second.png --out matches.csv --picture matches.png

Written is a line x1,y1,x2,y2 for every match, under that header: column and row in the left image, column and row in the \
right one, in px. The images need not be rectified or of one size.";

#[derive(Debug, Parser)]
#[command(name = "stereo", version, about = "Depth from two images, by the code that runs on the microcontroller")]
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
    /// Estimate the fundamental matrix of two images from matches, some of them wrong
    #[command(after_help = FUNDAMENTAL_EXAMPLE)]
    Fundamental(FundamentalArgs),
    /// Estimate where the second of two known cameras stands from matches, and the points they show
    #[command(after_help = POSE_EXAMPLE)]
    Pose(PoseArgs),
    /// Find points of one image in another: corners, matched by what they look like
    #[command(after_help = FEATURES_EXAMPLE)]
    Features(FeaturesArgs),
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
    /// Calibration of the pair, for depths: a Middlebury or KITTI calib.txt
    #[arg(long, value_name = "FILE")]
    pub calib: Option<PathBuf>,
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
    #[arg(long, value_name = "N", default_value_t = 3200, value_parser = corners, allow_negative_numbers = true)]
    pub corners: u16,
    /// Grey levels by which a corner differs from its surroundings, 1 to 254
    #[arg(long, value_name = "G", default_value_t = 12, value_parser = contrast, allow_negative_numbers = true)]
    pub contrast: u16,
    /// How many sizes of the images are searched, 1 to 8, each two thirds of the one before
    #[arg(long, value_name = "L", default_value_t = 3, value_parser = levels, allow_negative_numbers = true)]
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
    /// The images are turned against each other by more than some 15 degrees
    #[arg(long)]
    pub turned: bool,
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
    /// fast (4-bit census, 9x7 window), block (8-bit census, 9x9 window), or along paths sgm-lean, sgm and sgm-edge
    #[arg(long, value_name = "METHOD", default_value = "block", value_parser = method)]
    pub method: Method,
    /// dense (an answer wherever there is a candidate), default, or strict (sure answers only)
    #[arg(long, value_name = "FILTER", default_value = "default", value_parser = filter)]
    pub filter: Filter,
    /// How noisy the images are: none, low (a deviation of about 2 grey levels), high (3 and more), or auto, which measures it
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

fn noise(text: &str) -> Result<NoiseChoice, String> {
    text.parse().map_err(|unknown: UnknownNoise| unknown.to_string())
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
}

#[derive(Debug, Args)]
pub struct PoseArgs {
    /// The matches: lines of x1,y1,x2,y2 in px under that header
    #[arg(long, value_name = "FILE")]
    pub matches: PathBuf,
    /// Calibration of the two cameras, which need not be rectified: a Middlebury or KITTI calib.txt
    #[arg(long, value_name = "FILE")]
    pub calib: PathBuf,
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

fn filter(text: &str) -> Result<Filter, &'static str> {
    Filter::ALL.into_iter().find(|filter| filter.name() == text).ok_or("the filters are dense, default and strict")
}

fn kernel(text: &str) -> Result<Kernel, String> {
    Kernel::available().find(|kernel| kernel.name() == text).ok_or_else(|| {
        let names: Vec<_> = Kernel::available().map(Kernel::name).collect();
        format!("this processor's are {}; STEREO_KERNEL names one too", names.join(", "))
    })
}

fn method(text: &str) -> Result<Method, String> {
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

fn repeat(text: &str) -> Result<u16, String> {
    whole(text, 1, 10_000)
}

fn whole(text: &str, least: u16, most: u16) -> Result<u16, String> {
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
