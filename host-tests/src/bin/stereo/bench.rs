//! `stereo bench`: how long the matching of a frame takes.

use crate::failure::Failure;
use crate::input::{self, Pair};
use crate::shared::{MethodArgs, PairArgs, RangeArgs, print, whole};
use clap::Args;
use serde::Serialize;
use stereopsis_host::run::{MemoryPair, time_frames};

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo bench --left left.png --right right.png --disparities 64 --method fast --repeat 9

Printed is one JSON object: frame_ms (a time for each frame, after one that is left out; files and start-up \
                           left out, in as many threads as --threads says), kernel, width, height, \
                           disparities, state_bytes, noise.";

#[derive(Debug, Args)]
pub struct BenchArgs {
    #[command(flatten)]
    pub pair: PairArgs,
    #[command(flatten)]
    pub range: RangeArgs,
    #[command(flatten)]
    pub method: MethodArgs,
    /// How many frames are timed, 1 to 10000
    #[arg(long, value_name = "K", default_value_t = 5, value_parser = repeat, allow_negative_numbers = true)]
    pub repeat: u16,
}

fn repeat(text: &str) -> Result<u16, String> {
    whole(text, 1, 10_000)
}

/// What is printed. Names are a contract with programs that read them.
#[derive(Serialize)]
struct Times {
    frame_ms: Vec<f64>,
    kernel: &'static str,
    width: u16,
    height: u16,
    disparities: u16,
    state_bytes: usize,
    noise: &'static str,
}

pub fn run(args: &BenchArgs) -> Result<(), Failure> {
    let mut pair = Pair::open(&args.pair.left, &args.pair.right)?;
    let config = input::config(&args.range, &args.method, pair.width, pair.height)?;
    // Files and the conversion to grey are left out of the times.
    let mut camera = MemoryPair::record(&mut pair.camera)?;
    let (config, _) = input::with_noise(&args.method, config, &mut camera)?;
    let (frame_ms, kernel) =
        time_frames(args.method.run_options(), &config, &mut camera, usize::from(args.repeat))?;
    let times = Times {
        frame_ms,
        kernel: kernel.name(),
        width: config.width,
        height: config.height,
        disparities: config.disparities,
        state_bytes: args.method.method.state_bytes(config.width, config.disparities),
        noise: config.noise.name(),
    };
    print(&(serde_json::to_string(&times)? + "\n"))
}
