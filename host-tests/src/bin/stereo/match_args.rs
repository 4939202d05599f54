//! The options of `match`.

use crate::look::{MaskArgs, SearchArgs};
use crate::results::DepthArgs;
use crate::shared::{BalanceArgs, MethodArgs, RectifyOptions, colour_range, filter, method, noise};
use crate::sources::SourceArgs;
use crate::typed_rig::TypedRig;
use crate::watch::ObstacleArgs;
use clap::Args;
use std::path::PathBuf;
use stereopsis::matching::Filter;
use stereopsis_host::colour::ColourScale;
use stereopsis_host::run::{MethodName, NoiseChoice};

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
    /// of rectified images, or rectified.json (which has masks alone where matches made it); with --rectify
    /// how the cameras are mounted, as for the command rectify
    #[arg(long, value_name = "FILE")]
    pub calib: Vec<PathBuf>,
    /// Take the images raw, as the cameras give them, and rectify them line by line before they are matched
    #[arg(long)]
    pub rectify: bool,
    #[command(flatten)]
    pub masks: MaskArgs,
    #[command(flatten)]
    pub options: RectifyOptions,
    #[command(flatten)]
    pub typed: TypedRig,
    #[command(flatten)]
    pub depth: DepthArgs,
    /// Disparities from the darkest to the brightest colour of disparity_colour.png, px, as 0:64: those
    /// searched where none are given
    #[arg(long, value_name = "A:B", value_parser = colour_range, allow_hyphen_values = true)]
    pub colour_range: Option<ColourScale>,
    #[command(flatten)]
    pub watch: ObstacleArgs,
    /// Match one pair with each of several settings, METHOD, METHOD:FILTER or METHOD:FILTER:NOISE with commas
    /// between them: a folder for each, a table, and settings.png, which shows all side by side
    #[arg(long, value_name = "SETTINGS", value_delimiter = ',', value_parser = setting, conflicts_with_all =
        ["method", "filter", "noise", "obstacles"])]
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

/// A method, and where they are given its filter and its noise.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    pub method: MethodName,
    pub filter: Option<Filter>,
    pub noise: Option<NoiseChoice>,
}

/// Reads METHOD, METHOD:FILTER or METHOD:FILTER:NOISE.
fn setting(text: &str) -> Result<Setting, String> {
    let mut words = text.split(':');
    let method = method(words.next().unwrap_or_default())?;
    let filter = words.next().map(filter).transpose()?;
    let noise = words.next().map(noise).transpose()?;
    match words.next() {
        Some(_) => Err("METHOD, METHOD:FILTER or METHOD:FILTER:NOISE is needed, as sgm:strict".to_owned()),
        None => Ok(Setting { method, filter, noise }),
    }
}
