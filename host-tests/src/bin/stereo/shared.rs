//! What several commands have: options, their limits, and how an answer is printed.

use crate::failure::Failure;
use clap::{Args, ValueEnum};
use nalgebra::Matrix3;
use std::fmt::Display;
use std::io::{self, Write};
use std::path::PathBuf;
use std::str::FromStr;
use stereopsis::geometry::camera::ImageSize;
use stereopsis::matching::{Config, Filter, Kernel, Row};
use stereopsis_host::colour::ColourScale;
use stereopsis_host::command_line::one_line;
use stereopsis_host::run::{MethodName, NoiseChoice, RunOptions, UnknownMethod, UnknownNoise};

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
    #[arg(long, value_name = "M", default_value_t = 0, value_parser = min_disparity, allow_negative_numbers =
        true)]
    pub min_disparity: u16,
}

#[derive(Clone, Debug, Args)]
pub struct MethodArgs {
    /// fast (4-bit census, 9x7 window), block (8-bit census, 9x9 window), or along paths sgm-lean, sgm and
    /// sgm-edge
    #[arg(long, value_name = "METHOD", default_value = "sgm", value_parser = method)]
    pub method: MethodName,
    /// dense (an answer wherever there is a candidate), default, or strict (sure answers only)
    #[arg(long, value_name = "FILTER", default_value = "default", value_parser = filter)]
    pub filter: Filter,
    /// How noisy the images are: none, low (a deviation of about 2 grey levels), high (3 and more), or auto,
    /// which measures it
    #[arg(long, value_name = "NOISE", default_value = "auto", value_parser = noise)]
    pub noise: NoiseChoice,
    /// The least confidence that an answer keeps, 0 to 207: one that is less sure is refused as ambiguous
    #[arg(long, value_name = "C", default_value_t = 0, value_parser = min_confidence, allow_negative_numbers =
        true)]
    pub min_confidence: u8,
    /// The kernel that does the work, by default the fastest of this processor; all give the same bits
    #[arg(long, value_name = "KERNEL", env = "STEREO_KERNEL", value_parser = kernel)]
    pub kernel: Option<Kernel>,
    /// How many threads share a frame, 1 to 64, each a band of rows; fast and block give the same bits
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = threads, allow_negative_numbers = true)]
    pub threads: u16,
}

impl MethodArgs {
    /// The method, on the kernel, in the threads.
    pub fn run_options(&self) -> RunOptions {
        RunOptions { method: self.method, kernel: self.kernel, threads: self.threads }
    }
}

#[derive(Clone, Debug, Args)]
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

/// How rigs are rectified.
#[derive(Clone, Debug, Args)]
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

#[derive(Debug, Args)]
pub struct RobustArgs {
    /// eight-point (all matches are right) or ransac (some are wrong)
    #[arg(long, value_name = "METHOD", default_value = "ransac")]
    pub method: TwoViewMethod,
    /// Sampson distance up to which a match counts as right, px, 0.001 to 1000
    #[arg(long, value_name = "PX", default_value_t = 1.0, value_parser = threshold, allow_negative_numbers =
        true)]
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

pub fn kernel(text: &str) -> Result<Kernel, String> {
    Kernel::available().find(|kernel| kernel.name() == text).ok_or_else(|| {
        let names: Vec<_> = Kernel::available().map(Kernel::name).collect();
        format!("this processor's are {}; STEREO_KERNEL names one too", names.join(", "))
    })
}

pub fn method(text: &str) -> Result<MethodName, String> {
    text.parse().map_err(|unknown: UnknownMethod| unknown.to_string())
}

fn alpha(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.0..=1.0).contains(value));
    value.ok_or("a number from 0 to 1 is needed")
}

fn threshold(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.001..=1000.0).contains(value));
    value.ok_or("a number from 0.001 to 1000 is needed")
}

pub fn seed(text: &str) -> Result<u64, String> {
    whole(text, 0, u64::MAX)
}

pub fn disparities(text: &str) -> Result<u16, String> {
    whole(text, Config::FEWEST_DISPARITIES, Config::MOST_DISPARITIES)
}

fn threads(text: &str) -> Result<u16, String> {
    whole(text, 1, 64)
}

fn min_confidence(text: &str) -> Result<u8, String> {
    whole(text, 0, u16::from(Row::MOST_CONFIDENCE)).map(|confidence| confidence as u8)
}

pub fn min_disparity(text: &str) -> Result<u16, String> {
    whole(text, 0, Config::END - Config::FEWEST_DISPARITIES)
}

pub fn rate(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.01..=10_000.0).contains(value));
    value.ok_or("a number from 0.01 to 10000 is needed")
}

pub fn length(text: &str) -> Result<f32, &'static str> {
    let value = text.parse().ok().filter(|value| (0.001..=100_000.0).contains(value));
    value.ok_or("a number from 0.001 to 100000 is needed")
}

pub fn colour_range(text: &str) -> Result<ColourScale, &'static str> {
    let ends = text.split_once(':').and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    let scale = ends.map(|(far_px, near_px)| ColourScale { far_px, near_px });
    let is_range = |s: &ColourScale| s.far_px.is_finite() && s.near_px.is_finite() && s.far_px < s.near_px;
    scale.filter(is_range).ok_or("two disparities are needed, the smaller one first, as 0:64")
}

/// Columns and rows of an image.
pub fn image_size(text: &str) -> Result<ImageSize, &'static str> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let size = sides.map(|(width, height)| ImageSize { width, height }).filter(|size| size.is_possible());
    size.ok_or("columns and rows from 2 to 4096 are needed, as 640x480")
}

/// A whole number within limits, or what is needed.
pub fn whole<T: FromStr + PartialOrd + Display>(text: &str, least: T, most: T) -> Result<T, String> {
    let value = text.parse().ok().filter(|value| (&least..=&most).contains(&value));
    value.ok_or_else(|| format!("a whole number from {least} to {most} is needed"))
}

/// A whole number of 16 bits.
pub fn any_u16(text: &str) -> Result<u16, String> {
    whole(text, 0, u16::MAX)
}

/// Writes to standard output. A reader that closed its end has what it wanted.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(Failure::new(format!("standard output: {e}"))),
        _ => Ok(()),
    }
}

/// Writes a line to standard error: a note, a warning, or what is being done.
pub fn remark(line: &str) {
    // Nobody is left to tell when standard error is closed.
    let _ = writeln!(io::stderr(), "stereo: {}", one_line(line));
}

/// A matrix by its rows.
pub fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    matrix.transpose().into()
}
