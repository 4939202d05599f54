//! The tests that hold every kernel to its naive twin, for a processor that is emulated.

use crate::steps::cargo;
use std::process::Command;

/// Cargo with those tests, their long lists cut to a share: this machine's processor runs all of them.
pub fn emulated() -> Command {
    let mut tests = cargo(&["test", "--locked", "-p", "stereopsis-model", "--test", "kernels"]);
    // They read no picture, so what reads pictures is not made faster.
    tests.args(["--config", "profile.dev.package.image.opt-level=0"]).env("STEREOPSIS_EMULATED", "1");
    tests
}
