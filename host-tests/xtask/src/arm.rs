//! The kernels for Arm beside their naive twins, and the features of pictures beside their definitions, in
//! emulators of programs: the vectors of 64 bits, and, in the assembler of 32 bits, the instructions that
//! Cortex-M4, M7 and M33 have on four bytes.

use crate::kernels;
use crate::packages;
use crate::parallel;
use crate::setup;
use crate::steps::{Outcome, cargo, run as run_command, target_dir};
use std::process::Command;
use std::time::Instant;

/// Tests that are long and see nothing on 64-bit Arm that the other tests do not: the rows of the block
/// methods are the same safe code as on the host.
const SAME_AS_HOST: &[&str] = &["fast_equals_its_twin_at_all_sizes", "block_equals_its_twin_at_all_sizes"];

/// A processor that the tests are built for.
#[derive(Clone, Copy)]
pub struct Arm {
    name: &'static str,
    target: &'static str,
    linker: &'static str,
    emulator: &'static str,
    /// Where the linker's package has the libraries that programs load.
    libraries: &'static str,
    /// For the compiler.
    flags: &'static str,
    /// Tests that are left out.
    skipped: &'static [&'static str],
}

const ARM64: Arm = Arm {
    name: "64-bit Arm",
    target: "aarch64-unknown-linux-gnu",
    linker: "aarch64-linux-gnu-gcc",
    emulator: "qemu-aarch64",
    libraries: "/usr/aarch64-linux-gnu",
    flags: "",
    skipped: SAME_AS_HOST,
};

const ARM32: Arm = Arm {
    name: "32-bit Arm",
    target: "thumbv7neon-unknown-linux-gnueabihf",
    linker: "arm-linux-gnueabihf-gcc",
    emulator: "qemu-arm",
    libraries: "/usr/arm-linux-gnueabihf",
    // One that divides, as the Cortex-M do.
    flags: "--cfg stereopsis_dsp -C target-cpu=cortex-a15",
    skipped: &[],
};

/// Those that the tests do not run on anyway.
fn others() -> impl Iterator<Item = Arm> {
    [ARM64, ARM32].into_iter().filter(|arm| !(cfg!(target_arch = "aarch64") && arm.target == ARM64.target))
}

/// Adds their targets, linkers and emulators.
pub fn set_up() -> Outcome {
    setup::targets(&others().map(|arm| arm.target).collect::<Vec<_>>())?;
    packages::install(&others().flat_map(|arm| [arm.linker, arm.emulator]).collect::<Vec<_>>())
}

/// Builds the tests for all of them at once, then runs them side by side.
pub fn run() -> Outcome {
    set_up()?;
    let arms: Vec<_> = others().collect();
    for tests in [kernels::emulated(), features()] {
        run_command(&mut on(tests, &arms, &["--no-run"]))?;
    }
    parallel::work(arms, |arm| arm.run()).map(drop)
}

/// Cargo with the crate's own tests of features.
fn features() -> Command {
    cargo(&["test", "--locked", "-p", "stereopsis", "--lib", "features"])
}

/// Cargo's tests on these processors.
fn on(mut tests: Command, arms: &[Arm], arguments: &[&str]) -> Command {
    tests.args(arms.iter().flat_map(|arm| ["--target", arm.target])).args(arguments);
    for arm in arms {
        let variable =
            |what: &str| format!("CARGO_TARGET_{}_{what}", arm.target.replace('-', "_").to_uppercase());
        tests.env(variable("LINKER"), arm.linker);
        tests.env(variable("RUNNER"), format!("{} -L {}", arm.emulator, arm.libraries));
        tests.env(variable("RUSTFLAGS"), arm.flags);
    }
    // Other steps build at the same time.
    tests.env("CARGO_TARGET_DIR", target_dir().join("arm"));
    tests
}

impl Arm {
    /// Runs the tests, which are built.
    fn run(&self) -> Outcome {
        let skip = self.skipped.iter().flat_map(|test| ["--skip", test]);
        // Each has a processor.
        let arguments: Vec<_> = ["--", "--test-threads", "1"].into_iter().chain(skip).collect();
        let started = Instant::now();
        for tests in [kernels::emulated(), features()] {
            run_command(&mut on(tests, &[*self], &arguments))?;
        }
        println!("{} took {:.1} s", self.name, started.elapsed().as_secs_f64());
        Ok(())
    }
}
