//! `cargo xtask races`: what threads share, under ThreadSanitizer, which sees accesses that nothing orders as
//! they happen on this machine: Miri interprets the queue, this runs all who use threads at their speed.
//!
//! The standard library is built with it too, for else what it orders is not seen. Stable compilers have both
//! behind a variable.

use crate::named;
use crate::setup;
use crate::steps::{Outcome, cargo, root, target_dir};

/// What has tests, and which of them are run.
type Tests = (&'static [&'static str], &'static [&'static str]);

/// Tests of the crate's own: the queue.
const OF_THE_CRATE: Tests = (&["-p", "stereopsis", "--lib"], &["camera::queue"]);
/// Lines and wakes between two threads, the same in C, bands of a picture, and a task that another thread
/// wakes. docs/assurance.md has their names, which a test holds to the tests that there are.
const OF_THE_HOST: Tests = (
    &[
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
    ],
    &[
        "two_threads_lose_no_line_that_is_not_counted",
        "no_wake_is_lost_between_two_threads",
        "lines_between_two_threads_are_whole_and_in_order",
        "bands_give_the_same_rows",
        "lines_of_another_thread_wake_the_task",
    ],
);

/// Builds and runs all of it.
pub fn run() -> Outcome {
    setup::components()?;
    let host = setup::host()?;
    for (of, names) in [OF_THE_CRATE, OF_THE_HOST] {
        let tests = || {
            let mut test = cargo(&["test", "--locked", "-Zbuild-std", "--target", &host]);
            test.args(of).arg("--").env("CARGO_TARGET_DIR", root().join(target_dir()).join("races"));
            test.env("RUSTC_BOOTSTRAP", "1").env("RUSTFLAGS", "-Zsanitizer=thread");
            test
        };
        named::run(tests, names)?;
    }
    Ok(())
}
