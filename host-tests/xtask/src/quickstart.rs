//! `examples/quickstart`: the smallest firmware, linted, built as its reader builds it, and run in QEMU.

use crate::setup;
use crate::steps::{Failure, Outcome, command, output_within, root, run as run_command, target_dir};
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

const TARGET: &str = "thumbv7em-none-eabihf";
/// What it prints: f b / d of the box, 140 px x 60 mm / 16 px, by its sub-pixel disparities.
const PRINTED: &str = "nearest: 524 mm";

/// Cargo in the example's folder, where its own configuration has the flags.
fn cargo(words: &str) -> Command {
    let mut cargo = command("cargo", &words.split_whitespace().collect::<Vec<_>>());
    cargo.current_dir(root().join("examples/quickstart")).env("CARGO_TARGET_DIR", folder());
    cargo
}

fn folder() -> PathBuf {
    target_dir().join("quickstart")
}

/// The test step.
pub fn run() -> Outcome {
    run_command(&mut cargo("fmt --check"))?;
    run_command(&mut cargo(&format!("clippy --locked --release --target {TARGET} -- -D warnings")))?;
    run_command(&mut cargo(&format!("build --locked --release --target {TARGET}")))?;
    let mut qemu = command(setup::qemu_of(TARGET), &["-machine", "mps2-an386", "-nographic"]);
    qemu.args(["-semihosting-config", "enable=on,target=native", "-kernel"]);
    qemu.arg(folder().join(TARGET).join("release/quickstart"));
    let printed = output_within(&mut qemu, Duration::from_secs(60))?;
    println!("{}", printed.trim());
    if printed.trim() == PRINTED {
        return Ok(());
    }
    Err(Failure::new(format!("examples/quickstart printed '{}', not '{PRINTED}'", printed.trim())))
}
