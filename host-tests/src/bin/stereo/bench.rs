//! `stereo bench`: how long the matching of a frame takes.

use crate::cli::BenchArgs;
use crate::failure::Failure;
use crate::input::{self, Pair};
use crate::print;
use serde::Serialize;
use stereopsis_host::run::{MemoryPair, time_frames};

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
    let mut pair = Pair::open(&args.pair)?;
    let config = input::config(&args.range, &args.way, pair.width, pair.height)?;
    // Files and the conversion to grey are left out of the times.
    let mut camera = MemoryPair::record(&mut pair.camera)?;
    let (config, _) = input::with_noise(&args.way, config, &mut camera)?;
    let (frame_ms, kernel) = time_frames(args.way.way(), &config, &mut camera, usize::from(args.repeat))?;
    let times = Times {
        frame_ms,
        kernel: kernel.name(),
        width: config.width,
        height: config.height,
        disparities: config.disparities,
        state_bytes: args.way.method.state_bytes(config.width, config.disparities),
        noise: config.noise.name(),
    };
    print(&(serde_json::to_string(&times)? + "\n"))
}
