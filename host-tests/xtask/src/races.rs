//! `cargo xtask races`: what threads share, under ThreadSanitizer, which sees accesses that nothing orders as
//! they happen on this machine: Miri interprets the queue, this runs all who use threads at their speed.
//!
//! The standard library is built with it too, for else what it orders is not seen. Stable compilers have both
//! behind a variable.

use crate::setup;
use crate::steps::{Failure, Outcome, cargo, command, output_of, root, run as run_command, target_dir};

/// Tests of the crate's own: the queue.
const OF_THE_CRATE: &[&str] = &["-p", "stereopsis", "--lib", "--", "camera::queue"];
/// Lines and wakes between two threads, the same in C, bands of a picture, and the cameras that are read
/// beside the matcher.
const OF_THE_HOST: &[&str] = &[
    "-p",
    "stereopsis-host",
    "--test",
    "camera",
    "--test",
    "ffi",
    "--test",
    "matching",
    "--test",
    "pipeline",
    "--",
    "threads",
    "thread_wake",
];

/// Builds and runs all of it.
pub fn run() -> Outcome {
    setup::components()?;
    let rustc = output_of(&mut command("rustc", &["-vV"]))?;
    let host = rustc.lines().find_map(|line| line.strip_prefix("host: "));
    let host = host.ok_or_else(|| Failure::new("rustc -vV names no host"))?;
    for words in [OF_THE_CRATE, OF_THE_HOST] {
        let mut test = cargo(&["test", "--locked", "-Zbuild-std", "--target", host]);
        test.args(words).env("CARGO_TARGET_DIR", root().join(target_dir()).join("races"));
        run_command(test.env("RUSTC_BOOTSTRAP", "1").env("RUSTFLAGS", "-Zsanitizer=thread"))?;
    }
    Ok(())
}
