//! The kernels for Arm beside their naive twins, and the features of pictures beside their definitions, in
//! emulators of programs: the vectors of 64 bits, and, in the assembler of 32 bits, the instructions that
//! Cortex-M4, M7 and M33 have on four bytes and those that a Cortex-M3 has.

use crate::kernels;
use crate::named;
use crate::packages;
use crate::parallel;
use crate::setup;
use crate::steps::{Outcome, cargo, run as run_command, target_dir};
use std::process::Command;
use std::time::Instant;

/// Tests that are long and see nothing on 64-bit Arm, and in a Cortex-M3's instructions, that the other tests
/// do not: the rows of the block methods are the same safe code as on the host.
const SAME_AS_HOST: &[&str] = &["fast_equals_its_twin_at_all_sizes", "block_equals_its_twin_at_all_sizes"];

/// The crate's own tests that every one of them runs: of features, and of what is done to each word along
/// paths. 32-bit Arm has assembly beside plain Rust too.
const OWN: [&str; 2] = ["features", "rounds"];

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
    /// Where it is built: flags belong to a target.
    folder: &'static str,
    /// Which of the crate's own tests are run.
    own: &'static [&'static str],
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
    folder: "arm",
    own: &OWN,
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
    folder: "arm",
    own: &[OWN[0], OWN[1], "armv7em"],
    skipped: &[],
};

const ARM32_WORDS: Arm = Arm {
    name: "32-bit Arm without instructions on bytes",
    flags: "--cfg stereopsis_thumb2 -C target-cpu=cortex-a15",
    folder: "arm-words",
    own: &OWN,
    skipped: SAME_AS_HOST,
    ..ARM32
};

/// Those that the tests do not run on anyway.
fn others() -> impl Iterator<Item = Arm> {
    let is_this = |arm: &Arm| cfg!(target_arch = "aarch64") && arm.target == ARM64.target;
    [ARM64, ARM32, ARM32_WORDS].into_iter().filter(move |arm| !is_this(arm))
}

/// Adds their targets, linkers and emulators.
pub fn set_up() -> Outcome {
    setup::targets(&others().map(|arm| arm.target).collect::<Vec<_>>())?;
    packages::install(&others().flat_map(|arm| [arm.linker, arm.emulator]).collect::<Vec<_>>())
}

/// Builds the tests for each of them, then runs them side by side.
pub fn run() -> Outcome {
    set_up()?;
    let arms: Vec<_> = others().collect();
    for arm in &arms {
        run_command(arm.kernels().arg("--no-run"))?;
        run_command(arm.own().arg("--no-run"))?;
    }
    parallel::work(arms, |arm| arm.run()).map(drop)
}

impl Arm {
    /// The tests of kernels.
    fn kernels(&self) -> Command {
        self.with(kernels::emulated())
    }

    /// The crate's own tests.
    fn own(&self) -> Command {
        self.with(cargo(&["test", "--locked", "-p", "stereopsis", "--lib"]))
    }

    /// Tests for this processor, in its emulator.
    fn with(&self, mut tests: Command) -> Command {
        let variable =
            |what: &str| format!("CARGO_TARGET_{}_{what}", self.target.replace('-', "_").to_uppercase());
        tests.env(variable("LINKER"), self.linker);
        tests.env(variable("RUNNER"), format!("{} -L {}", self.emulator, self.libraries));
        tests.env(variable("RUSTFLAGS"), self.flags);
        // Other steps build at the same time.
        tests.env("CARGO_TARGET_DIR", target_dir().join(self.folder));
        tests.args(["--target", self.target]);
        tests
    }

    /// What the tests themselves are told.
    fn told(&self, mut tests: Command) -> Command {
        tests.args(["--", "--test-threads", "1"]);
        tests.args(self.skipped.iter().flat_map(|test| ["--skip", test]));
        tests
    }

    /// Runs the tests, which are built.
    fn run(&self) -> Outcome {
        let started = Instant::now();
        run_command(&mut self.told(self.kernels()))?;
        named::run(|| self.told(self.own()), self.own)?;
        println!("{} took {:.1} s", self.name, started.elapsed().as_secs_f64());
        Ok(())
    }
}
