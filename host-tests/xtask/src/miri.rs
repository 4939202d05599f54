//! `cargo xtask miri`: what is `unsafe` and no assembly, under an interpreter that sees undefined behaviour:
//! accesses outside of memory or in spite of a borrow, values that a type has not, races of threads.
//!
//! Miri comes with nightly compilers alone. `libm` does without its assembly. Of the crate's kernels a 64-bit
//! x86 runs SSE2 and the portable ones, RV64 the portable ones in words of 64 bits, a 32-bit x86 those of
//! cores without vectors; big-endian processors the crate refuses to compile for.

use crate::named;
use crate::steps::{Outcome, command, output_of, root, run as run_command, target_dir};

/// Processors that the tests are interpreted for.
const TARGETS: [&str; 3] =
    ["x86_64-unknown-linux-gnu", "riscv64gc-unknown-linux-gnu", "i686-unknown-linux-gnu"];
/// The crate's own tests: the queue of two threads, rows in their memory. Tests of sums over all bytes take
/// an interpreter hours, and have nothing `unsafe` in them.
const OF_THE_CRATE: [&str; 2] = ["camera::queue", "matching::stages"];
/// Short forms of campaigns: sessions in C, lines through slots, frames beside their twin, with faults.
const OF_CAMPAIGNS: [&str; 5] = ["calls", "lines", "matching", "guarded", "remap"];

/// Gets Miri and runs all of it.
pub fn run() -> Outcome {
    let installed = output_of(&mut command("rustup", &["run", "nightly", "cargo", "miri", "--version"]));
    if installed.is_err() {
        let words = ["toolchain", "install", "nightly", "--profile", "minimal", "--no-self-update"];
        let mut install = command("rustup", &words);
        run_command(install.args(["--component", "miri", "--component", "rust-src"]))?;
    }
    for target in TARGETS {
        println!("{target}:");
        test(target, &["--lib", "--features", "ffi"], &OF_THE_CRATE)?;
        test(target, &["-p", "stereopsis-fuzz", "--test", "short"], &OF_CAMPAIGNS)?;
    }
    Ok(())
}

/// Interprets the tests with one of the words in their names.
fn test(target: &str, of: &[&str], words: &[&str]) -> Outcome {
    let begin = ["run", "nightly", "cargo", "miri", "test", "--locked", "--target", target];
    let tests = || {
        let mut miri = command("rustup", &begin);
        miri.args(["-p", "stereopsis", "--features", "libm/force-soft-floats"]).args(of).arg("--");
        // Seeds are read from files.
        miri.env("MIRIFLAGS", "-Zmiri-disable-isolation");
        miri.env("CARGO_TARGET_DIR", root().join(target_dir()).join("miri"));
        miri
    };
    named::run(tests, words)
}
