//! The vectors of 64-bit Arm: the core beside its naive twins, in an emulator.

use crate::steps::{Outcome, cargo, run as run_command};

/// The target that the tests are built for.
pub const TARGET: &str = "aarch64-unknown-linux-gnu";
/// Its linker and the emulator of its programs.
pub const PROGRAMS: [&str; 2] = ["aarch64-linux-gnu-gcc", "qemu-aarch64"];
/// Where the linker's package has the libraries that programs load.
const LIBRARIES: &str = "/usr/aarch64-linux-gnu";

/// Whether the tests ran on such a processor anyway.
pub const IS_HOST: bool = cfg!(target_arch = "aarch64");

/// Runs the tests that hold every kernel to the twins.
pub fn run() -> Outcome {
    let [linker, emulator] = PROGRAMS;
    let mut tests = cargo(&["test", "--locked", "--target", TARGET, "-p", "stereopsis-host", "--test", "twin"]);
    tests.env("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER", linker);
    tests.env("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER", format!("{emulator} -L {LIBRARIES}"));
    run_command(&mut tests)
}
