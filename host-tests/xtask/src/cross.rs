//! `cargo xtask cross`: the core for all targets, as generic as it was written, and its features.
//!
//! Machine code for the targets is made elsewhere: by the firmware's programs for boards, the C interface,
//! the live page and, for 64-bit Arm, by the tests of kernels.

use crate::setup::{self, CHECKED, FROM_SOURCE, TARGETS};
use crate::steps::{Failure, Outcome, cargo, root, run as run_command, target_dir};
use std::path::PathBuf;
use std::process::Command;

/// The library's features.
const FEATURES: [&str; 6] = ["async", "defmt", "embedded-graphics", "ffi", "serde", "trace"];

/// The targets that nothing else of the test builds for: the smallest Arm, a core without compare-and-swap,
/// and one of 64 bits without an operating system.
pub const NOT_BUILT: [&str; 3] =
    ["thumbv6m-none-eabi", "riscv32i-unknown-none-elf", "riscv64gc-unknown-none-elf"];

/// The core on which combinations of features are checked.
const SMALL: &str = "riscv32imc-unknown-none-elf";

/// What cargo is refused with in one line that says what to do: instructions that a core lacks.
const REFUSED: [(&str, &str, &str); 3] = [
    ("thumbv7m-none-eabi", "dsp", "thumbv7m-none-eabi with these flags has no DSP instructions"),
    ("thumbv7m-none-eabi", "vectors", "thumbv7m-none-eabi with these flags has no vectors"),
    ("thumbv6m-none-eabi", "thumb2", "thumbv6m-none-eabi has no Thumb-2 instructions"),
];

/// All targets with all features, then the features one by one.
pub fn run() -> Outcome {
    let all = FEATURES.join(",");
    let targets = [TARGETS.as_slice(), &CHECKED].concat();
    setup::targets(&targets)?;
    check_targets(&targets)?;
    setup::components()?;
    for target in FROM_SOURCE {
        let mut check = check(&all, &["-Z", "build-std=core", "--target", target]);
        // The stable compiler takes the option as a nightly one does.
        run_command(check.env("RUSTC_BOOTSTRAP", "1"))?;
    }
    // Features add code and take none away, and no condition names two of them (a test holds that). What
    // stands behind one builds with every other if it builds with that one alone, as here on one small
    // core, and if all build together, as above.
    for features in [""].iter().chain(&FEATURES) {
        run_command(&mut check(features, &["--target", SMALL]))?;
    }
    refusals()
}

/// The targets that nothing else of the test builds for.
pub fn sample() -> Outcome {
    check_targets(&NOT_BUILT)?;
    refusals()
}

fn check_targets(targets: &[&str]) -> Outcome {
    let targets: Vec<_> = targets.iter().flat_map(|target| ["--target", target]).collect();
    run_command(&mut check(&FEATURES.join(","), &targets))
}

fn check(features: &str, more: &[&str]) -> Command {
    let mut check = cargo(&["check", "--locked", "-p", "stereopsis", "--features", features]);
    check.args(more).env("RUSTFLAGS", "-D warnings");
    check.env("CARGO_TARGET_DIR", folder());
    check
}

/// Where the checks are made.
pub fn folder() -> PathBuf {
    root().join(target_dir()).join("cross")
}

fn refusals() -> Outcome {
    for (target, name, said) in REFUSED {
        let mut check = check("", &["--target", target]);
        let output = check.env("RUSTFLAGS", format!("--cfg stereopsis_{name}")).output();
        let output = output.map_err(|e| Failure::new(format!("cargo: {e}")))?;
        let said = format!("stereopsis_{name}: {said}");
        if output.status.success() || !String::from_utf8_lossy(&output.stderr).contains(&said) {
            return Err(Failure::new(format!("stereopsis_{name} for {target} is not refused as \"{said}\"")));
        }
    }
    Ok(())
}
