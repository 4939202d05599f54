//! `cargo xtask view`: the core for browsers, and the live page with it.
//!
//! * [`run`]: builds the module and runs `stereo view`. [`kernels`]: the kernel of WebAssembly beside its
//!   twin.
//! * [`browser`]: a browser without a window. [`page`]: the live page in it. [`check`]: what the page has to
//!   do, a step of the tests; [`faults`]: what it has to refuse; [`openings`]: which of several counts.
//!   [`program`]: what the program says to the page's command line; [`copied`]: what compilers say to its
//!   other texts; [`plan`], [`cameras`], [`video`]: parts of the page; [`report`], [`wide`], [`focus`]: the
//!   reports of a run, of one with large images, and of a focus stack.

pub mod browser;
mod cameras;
mod check;
mod copied;
mod faults;
mod focus;
mod openings;
mod page;
mod plan;
mod program;
mod report;
mod video;
mod wide;

pub use check::sample;

use crate::packages;
use crate::setup;
use crate::steps::{Failure, Outcome, cargo, root, run as run_command, target_dir};
use clap::Args;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use stereopsis_host::live::MODULE_FILE;

/// The instructions that the module is compiled for.
const SIMD: &str = "-C target-feature=+simd128";
/// Of the module, and of the tests of its kernel.
pub const TARGETS: [&str; 2] = ["wasm32-unknown-unknown", "wasm32-wasip1"];
/// What runs the tests, and what the page is tested in.
pub const PROGRAMS: [&str; 3] = [NODE, CHROMIUM, copied::GCC];
const NODE: &str = "node";
pub const CHROMIUM: &str = "chromium";

/// The options of `view`.
#[derive(Args)]
pub struct Arguments {
    /// Options of `stereo view`, which `stereo view --help` lists
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

/// Adds the targets and the programs that are missing.
fn set_up() -> Outcome {
    setup::targets(&TARGETS)?;
    packages::install(&PROGRAMS)
}

/// Builds the module, puts it beside the program, and runs that.
pub fn run(arguments: &Arguments) -> Outcome {
    let module = module()?;
    run_command(&mut cargo(&["build", "--locked", "--release", "-p", "stereopsis-host", "--bin", "stereo"]))?;
    let folder = root().join(target_dir()).join("release");
    let beside = folder.join(MODULE_FILE);
    fs::copy(&module, &beside).map_err(|e| Failure::new(format!("{}: {e}", beside.display())))?;
    let stereo = folder.join("stereo").with_extension(std::env::consts::EXE_EXTENSION);
    let mut view = Command::new(stereo);
    run_command(view.arg("view").args(&arguments.words))
}

/// Cargo on the module.
fn cargo_on_module(verb: &str) -> Command {
    let [target, _] = TARGETS;
    let mut cargo = cargo(&[verb, "--locked", "--release", "-p", "stereopsis-live", "--target", target]);
    // Other steps build at the same time.
    cargo.env("RUSTFLAGS", SIMD).env("CARGO_TARGET_DIR", target_dir().join("view"));
    cargo
}

/// The part of the test step of clippy that is the module and its kernel.
pub fn clippy() -> Outcome {
    run_command(cargo_on_module("clippy").args(["--", "-D", "warnings"]))
}

/// The core as a module for browsers, built.
fn module() -> Outcome<PathBuf> {
    let [target, _] = TARGETS;
    setup::targets(&[target])?;
    let mut build = cargo_on_module("build");
    for (option, value) in [("LTO", "fat"), ("STRIP", "true"), ("PANIC", "abort"), ("CODEGEN_UNITS", "1")] {
        build.env(format!("CARGO_PROFILE_RELEASE_{option}"), value);
    }
    run_command(&mut build)?;
    Ok(root().join(target_dir()).join("view").join(target).join("release").join(MODULE_FILE))
}

/// The test step of the kernel: SIMD128 beside its naive twin, to the bit.
pub fn kernels() -> Outcome {
    let [_, target] = TARGETS;
    let mut tests = crate::kernels::emulated();
    tests.args(["--target", target]).env("RUSTFLAGS", SIMD);
    let script = root().join("host-tests/live/wasi.mjs");
    // Versions before 20 have the interface behind an option.
    let runner = format!("{NODE} --no-warnings --experimental-wasi-unstable-preview1 {}", script.display());
    tests.env("CARGO_TARGET_WASM32_WASIP1_RUNNER", runner);
    run_command(tests.env("CARGO_TARGET_DIR", target_dir().join("view")))
}
