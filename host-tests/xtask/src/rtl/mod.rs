//! `cargo xtask rtl`: the block of `examples/fpga` in a simulation, before the library's second half.
//!
//! * [`block`]: the block's parameters, and its simulation, built with Verilator.
//! * [`simulation`]: that program as registers and streams.
//! * [`frame`]: pictures through both halves, held to the host.
//! * [`one_pair`]: one pair of pictures, with its results in a folder.
//! * [`check`]: random frames and faults; a part of them is a step of the tests.
//! * [`system`]: firmware on emulated cores with the simulated block before it.
//! * [`synthesis`]: what the block takes in an FPGA, by Yosys and nextpnr.

mod block;
mod check;
mod frame;
mod one_pair;
mod simulation;
mod synthesis;
mod system;

use crate::setup;
use crate::steps::{Failure, Outcome};
use clap::Args;
use std::path::PathBuf;
use stereopsis::matching::Config;
use stereopsis_host::run::{MethodName, NoiseChoice, UnknownNoise};

/// The options of `rtl`.
#[derive(Args)]
pub struct Arguments {
    /// The left image, PNG, JPEG, PGM/PPM, TIFF, BMP or WebP
    #[arg(long, value_name = "FILE", required_unless_present_any = ["all", "system", "synthesis"])]
    left: Option<PathBuf>,
    /// The right image, of the same size
    #[arg(long, value_name = "FILE", required_unless_present_any = ["all", "system", "synthesis"])]
    right: Option<PathBuf>,
    /// How many whole disparities are searched: 16 to 128
    #[arg(long, value_name = "N", value_parser = disparities, allow_negative_numbers = true,
        required_unless_present_any = ["all", "system", "synthesis"])]
    disparities: Option<u16>,
    /// The smallest disparity searched, px: 0 to 255
    #[arg(long, value_name = "M", default_value_t = 0, value_parser = clap::value_parser!(u16).range(..=255))]
    min_disparity: u16,
    /// The matching method: fast, block or sgm
    #[arg(long, default_value = "block", value_parser = method)]
    method: MethodName,
    /// How many disparities are worked on in a clock: all where none is given
    #[arg(long, value_name = "P")]
    parallel: Option<u16>,
    /// How noisy the images are: none, low, high, or auto, which measures it
    #[arg(long, default_value = "auto", value_parser = noise)]
    noise: NoiseChoice,
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR", required_unless_present_any = ["all", "system", "synthesis"])]
    out: Option<PathBuf>,
    /// At least 1000 rows of every kind of picture through blocks of many sizes, and every fault
    #[arg(long, conflicts_with_all = ["left", "right", "disparities", "parallel", "out", "synthesis"])]
    all: bool,
    /// Firmware on emulated cores with the simulated block before it: rows with the host's checksum
    #[arg(long, conflicts_with_all = ["left", "right", "disparities", "parallel", "out", "synthesis", "all"])]
    system: bool,
    /// What the block takes in an FPGA: writes the table of docs/performance.md
    #[arg(long, conflicts_with_all = ["left", "right", "disparities", "parallel", "out"])]
    synthesis: bool,
}

/// Does what the command line asks for.
pub fn run(arguments: &Arguments) -> Outcome {
    if arguments.all {
        setup::gates()?;
        check::all()?;
        return system::run();
    }
    if arguments.system {
        return system::run();
    }
    if arguments.synthesis {
        return synthesis::run();
    }
    let Arguments { left, right, disparities, out, .. } = arguments;
    let (Some(left), Some(right), Some(disparities), Some(out)) = (left, right, disparities, out) else {
        return Err(Failure::new("--left, --right, --disparities and --out belong together"));
    };
    let pair = one_pair::OnePair {
        pair: [left, right],
        disparities: *disparities,
        min_disparity: arguments.min_disparity,
        method: arguments.method,
        parallel: arguments.parallel,
        noise: arguments.noise,
        out,
    };
    pair.run()
}

/// The step of the tests: few frames of every kind, in a minute.
pub fn sample() -> Outcome {
    setup::gates()?;
    check::sample()
}

fn disparities(text: &str) -> Result<u16, String> {
    let (least, most) = (Config::FEWEST_DISPARITIES, block::MOST_DISPARITIES);
    let value = text.parse().ok().filter(|value| (least..=most).contains(value));
    value.ok_or_else(|| format!("a whole number from {least} to {most} is needed"))
}

fn method(text: &str) -> Result<MethodName, &'static str> {
    let method = text.parse().ok().filter(|method| block::METHODS.contains(method));
    method.ok_or("the methods of the block are fast, block and sgm")
}

fn noise(text: &str) -> Result<NoiseChoice, String> {
    text.parse().map_err(|unknown: UnknownNoise| unknown.to_string())
}
