//! `cargo xtask readme`: the generated parts of docs/performance.md.
//!
//! The test `readme` of the host package makes them and compares; told to by a variable, it writes them.

use crate::steps::{Outcome, cargo, run as run_command};

/// Writes the parts, or compares them only.
pub fn run(check: bool) -> Outcome {
    let mut test = cargo(&[
        "test",
        "--locked",
        "--quiet",
        "-p",
        "stereopsis-host",
        "--test",
        "repo",
        "readme::generated",
    ]);
    if !check {
        test.env("STEREOPSIS_README", "write");
    }
    run_command(&mut test)
}
