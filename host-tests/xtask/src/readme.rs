//! `cargo xtask readme`: what is made of the code alone. The tables of memory, accuracy and false surfaces in
//! docs/performance.md, the figures of README.md, and two pictures; other commands make the other tables.
//!
//! The test `readme` of the host package makes them and compares; told to by a variable, it writes them.

use crate::named;
use crate::steps::{Outcome, cargo};

/// Tells the test to write.
const VARIABLE: &str = "STEREOPSIS_README";

/// Writes the parts, or compares them only.
pub fn run(check: bool) -> Outcome {
    let words = ["test", "--locked", "--quiet", "-p", "stereopsis-host", "--test", "repo", "--"];
    let test = || {
        let mut test = cargo(&words);
        if check {
            test.env_remove(VARIABLE);
        } else {
            test.env(VARIABLE, "write");
        }
        test
    };
    named::run(test, &["readme::generated"])
}
