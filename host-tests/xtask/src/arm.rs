//! The kernels for Arm beside their naive twins, in emulators of programs: the vectors of 64 bits, and, in
//! the assembler of 32 bits, the instructions that Cortex-M4, M7 and M33 have on four bytes.

use crate::packages;
use crate::setup;
use crate::steps::{Outcome, cargo, run as run_command};

/// Tests that are long and see nothing on 64-bit Arm that the other tests do not: the rows of the block
/// methods are the same safe code as on the host.
const SAME_AS_HOST: &[&str] = &["fast_equals_its_twin_at_all_sizes", "block_equals_its_twin_at_all_sizes"];

/// A processor that the tests are built for.
pub struct Arm {
    /// Its name in the list of steps.
    pub name: &'static str,
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
pub fn others() -> impl Iterator<Item = Arm> {
    [ARM64, ARM32].into_iter().filter(|arm| !(cfg!(target_arch = "aarch64") && arm.target == ARM64.target))
}

impl Arm {
    /// Adds the target and the programs that are missing.
    pub fn set_up(&self) -> Outcome {
        setup::targets(&[self.target])?;
        packages::install(&[self.linker, self.emulator])
    }

    /// Runs the tests that hold every kernel to the twins.
    pub fn run(&self) -> Outcome {
        let mut tests = cargo(&[
            "test",
            "--locked",
            "--target",
            self.target,
            "-p",
            "stereopsis-host",
            "--test",
            "matching",
        ]);
        tests.args(["--", "twin::"]);
        tests.args(self.skipped.iter().flat_map(|test| ["--skip", test]));
        let variable =
            |what: &str| format!("CARGO_TARGET_{}_{what}", self.target.replace('-', "_").to_uppercase());
        tests.env(variable("LINKER"), self.linker);
        tests.env(variable("RUNNER"), format!("{} -L {}", self.emulator, self.libraries));
        tests.env(variable("RUSTFLAGS"), self.flags);
        // The long lists take their share: the host has run all of them.
        tests.env("STEREOPSIS_EMULATED", "1");
        run_command(&mut tests)
    }
}
