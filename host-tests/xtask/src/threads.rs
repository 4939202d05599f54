//! `cargo xtask threads`: the hand-off between two threads under ThreadSanitizer, which sees two accesses to
//! one place without an order between them, however they fell out.
//!
//! The standard library is built with it, from its source: what it orders is seen as well. The stable
//! compiler's flags for that are unlocked by `RUSTC_BOOTSTRAP`.

use crate::setup;
use crate::steps::{Failure, Outcome, cargo, command, output_of, root, run as run_command, target_dir};

/// The tests with two threads: the queue, slots in Rust and in C, a task that is woken.
const TESTS: [&str; 3] = ["two_threads", "lines_of_another_thread_wake", "lines_between_two_threads"];

/// Builds and runs all of it.
pub fn run() -> Outcome {
    setup::components()?;
    let rustc = output_of(&mut command("rustc", &["-vV"]))?;
    let host = rustc.lines().find_map(|line| line.strip_prefix("host: "));
    let host = host.ok_or_else(|| Failure::new("rustc -vV names no host"))?;
    test(host, &["-p", "stereopsis", "--lib"])?;
    test(host, &["-p", "stereopsis-host", "--test", "camera", "--test", "ffi", "--test", "pipeline"])
}

fn test(host: &str, of: &[&str]) -> Outcome {
    let mut test = cargo(&["test", "--locked", "-Zbuild-std=std,panic_unwind,test", "--target", host]);
    test.args(of).arg("--").args(TESTS);
    test.env("RUSTFLAGS", "-Zsanitizer=thread").env("RUSTC_BOOTSTRAP", "1");
    run_command(test.env("CARGO_TARGET_DIR", root().join(target_dir()).join("threads")))
}
