//! Gets the tools that the tests need: targets and components by rustup, QEMU, Verilator and what C
//! needs by apt-get.

use crate::packages;
use crate::steps::{Failure, Outcome, command, output_of, root, run};
use std::fs;

/// The targets that the core is built for.
pub const TARGETS: [&str; 6] = [
    "thumbv6m-none-eabi",
    "thumbv7m-none-eabi",
    "thumbv7em-none-eabihf",
    "thumbv8m.main-none-eabihf",
    "riscv32imc-unknown-none-elf",
    "aarch64-unknown-none",
];

/// The targets that the core is checked for, beside those.
pub const CHECKED: [&str; 5] = [
    "riscv32imac-unknown-none-elf",
    "riscv32i-unknown-none-elf",
    "riscv64gc-unknown-none-elf",
    "wasm32-unknown-unknown",
    "x86_64-unknown-linux-gnu",
];
/// Those for which rustup may have no compiled `core`: its source is compiled for them.
pub const FROM_SOURCE: [&str; 2] = ["thumbv8m.base-none-eabi", "armv7r-none-eabihf"];

/// The targets of the examples in C.
const C_TARGETS: [&str; 3] =
    ["thumbv7em-none-eabihf", "riscv32imc-unknown-none-elf", "riscv32imac-unknown-none-elf"];

/// The emulators of the boards.
pub const QEMU_ARM: &str = "qemu-system-arm";
pub const QEMU_RISCV: &str = "qemu-system-riscv32";

/// The emulator of a target's boards.
pub fn qemu_of(target: &str) -> &'static str {
    if target.starts_with("riscv") { QEMU_RISCV } else { QEMU_ARM }
}

/// What simulates the gates of `examples/fpga`.
pub const GATES: [&str; 3] = ["verilator", "make", "g++"];
/// What compiles, runs and watches the examples in C.
pub const C: [&str; 9] = [
    "arm-none-eabi-gcc",
    "riscv64-unknown-elf-gcc",
    "cmake",
    "make",
    "gcc",
    "g++",
    QEMU_ARM,
    QEMU_RISCV,
    "valgrind",
];

/// Adds the targets and components that are missing.
pub fn toolchains() -> Outcome {
    targets(&[TARGETS.as_slice(), &C_TARGETS].concat())?;
    components()
}

/// Adds what is missing of the targets that are only checked, and of the oldest toolchain.
pub fn before_a_release() -> Outcome {
    targets(&CHECKED)?;
    toolchain(&rust_version()?)
}

/// Adds what simulates the gates of `examples/fpga`.
pub fn gates() -> Outcome {
    packages::install(&GATES)
}

/// Adds what the examples in C need, and the watch over memory that was never written.
pub fn c() -> Outcome {
    targets(&C_TARGETS)?;
    packages::install(&C)
}

/// What firmware for these targets needs.
pub fn firmware(of: &[&str]) -> Outcome {
    targets(of)?;
    of.iter().try_for_each(|target| packages::install(&[qemu_of(target)]))
}

/// What rustup has installed of a kind.
fn installed(kind: &str) -> Outcome<String> {
    output_of(&mut command("rustup", &[kind, "list", "--installed"]))
        .map_err(|e| Failure::new(format!("{e}; install rustup: it adds the targets that are built for")))
}

/// Adds the targets that are missing.
pub fn targets(needed: &[&str]) -> Outcome {
    let there = installed("target")?;
    let mut missing: Vec<_> =
        needed.iter().copied().filter(|target| !there.lines().any(|line| line == *target)).collect();
    missing.sort();
    missing.dedup();
    if missing.is_empty() {
        return Ok(());
    }
    run(&mut command("rustup", &[&["target", "add"], missing.as_slice()].concat()))
}

/// Adds rustfmt, clippy and the source of `core`.
pub fn components() -> Outcome {
    let components = installed("component")?;
    for component in ["rustfmt", "clippy", "rust-src"] {
        if !components.lines().any(|line| line.starts_with(component)) {
            run(&mut command("rustup", &["component", "add", component]))?;
        }
    }
    Ok(())
}

/// The toolchain of the stated rust-version.
fn toolchain(version: &str) -> Outcome {
    let list = output_of(&mut command("rustup", &["toolchain", "list"]))?;
    if list.lines().any(|line| line.starts_with(&format!("{version}-"))) {
        return Ok(());
    }
    run(&mut command(
        "rustup",
        &["toolchain", "install", version, "--profile", "minimal", "--no-self-update"],
    ))
}

/// The target of this machine's own programs.
pub fn host() -> Outcome<String> {
    let rustc = output_of(&mut command("rustc", &["-vV"]))?;
    let host = rustc.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| Failure::new("rustc -vV names no host"))
}

/// The workspace's rust-version with its patch number, as toolchains are named.
pub fn rust_version() -> Outcome<String> {
    let manifest = fs::read_to_string(root().join("Cargo.toml"))
        .map_err(|e| Failure::new(format!("Cargo.toml: {e}")))?;
    let stated = manifest.lines().find_map(|line| line.strip_prefix("rust-version = "));
    let version =
        stated.ok_or_else(|| Failure::new("Cargo.toml states no rust-version"))?.trim().trim_matches('"');
    Ok(if version.matches('.').count() == 1 { format!("{version}.0") } else { version.to_owned() })
}
