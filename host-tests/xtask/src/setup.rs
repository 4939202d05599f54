//! Gets the tools that the tests need: targets and components by rustup, QEMU by apt-get.

use crate::steps::{Failure, Outcome, command, output_of, root, run};
use std::fs;

/// The targets that the core is built for.
pub const TARGETS: [&str; 6] = [
    "thumbv6m-none-eabi",
    "thumbv7m-none-eabi",
    "thumbv7em-none-eabihf",
    "thumbv8m.main-none-eabihf",
    "riscv32imac-unknown-none-elf",
    "aarch64-unknown-none",
];

/// An emulator, and the packages that have it: one or the other, as the distribution's version goes.
struct Qemu {
    program: &'static str,
    packages: &'static [&'static str],
}

const ARM: Qemu = Qemu { program: "qemu-system-arm", packages: &["qemu-system-arm"] };
const RISCV: Qemu = Qemu { program: "qemu-system-riscv32", packages: &["qemu-system-misc", "qemu-system-riscv"] };

/// The emulator of a target's boards.
fn emulator(target: &str) -> &'static Qemu {
    if target.starts_with("riscv") { &RISCV } else { &ARM }
}

/// The name of the emulator of a target's boards.
pub fn qemu_of(target: &str) -> &'static str {
    emulator(target).program
}

/// Adds the targets, components and toolchain that are missing, then QEMU.
pub fn run_all() -> Outcome {
    targets(&TARGETS)?;
    components()?;
    toolchain(&rust_version()?)?;
    qemu(&ARM)?;
    qemu(&RISCV)
}

/// What firmware for these targets needs.
pub fn firmware(of: &[&str]) -> Outcome {
    targets(of)?;
    of.iter().try_for_each(|target| qemu(emulator(target)))
}

/// What rustup has installed of a kind.
fn installed(kind: &str) -> Outcome<String> {
    output_of(&mut command("rustup", &[kind, "list", "--installed"]))
        .map_err(|e| Failure::new(format!("{e}; install rustup: it adds the targets that are built for")))
}

/// Adds the targets that are missing.
fn targets(needed: &[&str]) -> Outcome {
    let there = installed("target")?;
    let mut missing: Vec<_> =
        needed.iter().copied().filter(|target| !there.lines().any(|line| line == *target)).collect();
    missing.dedup();
    if missing.is_empty() {
        return Ok(());
    }
    run(&mut command("rustup", &[&["target", "add"], missing.as_slice()].concat()))
}

/// Adds rustfmt and clippy.
fn components() -> Outcome {
    let components = installed("component")?;
    for component in ["rustfmt", "clippy"] {
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
    run(&mut command("rustup", &["toolchain", "install", version, "--profile", "minimal", "--no-self-update"]))
}

/// The workspace's rust-version with its patch number, as toolchains are named.
pub fn rust_version() -> Outcome<String> {
    let manifest =
        fs::read_to_string(root().join("Cargo.toml")).map_err(|e| Failure::new(format!("Cargo.toml: {e}")))?;
    let stated = manifest.lines().find_map(|line| line.strip_prefix("rust-version = "));
    let version = stated.ok_or_else(|| Failure::new("Cargo.toml states no rust-version"))?.trim().trim_matches('"');
    Ok(if version.matches('.').count() == 1 { format!("{version}.0") } else { version.to_owned() })
}

/// An emulator, by apt-get where that is possible.
fn qemu(Qemu { program, packages }: &Qemu) -> Outcome {
    let is_there = || output_of(&mut command(program, &["--version"])).is_ok();
    if is_there() {
        return Ok(());
    }
    let is_root = output_of(&mut command("id", &["-u"])).is_ok_and(|id| id.trim() == "0");
    let apt = |arguments: &[&str]| {
        let sudo = if is_root { [].as_slice() } else { &["sudo", "-n"] };
        let words = [sudo, &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"], arguments].concat();
        run(&mut command(words[0], &words[1..]))
    };
    // What fails here is told below, in one line.
    let updated = apt(&["update"]).is_ok();
    let install = |package: &&str| apt(&["install", "-y", "--no-install-recommends", package]).is_ok() && is_there();
    if updated && packages.iter().any(install) {
        return Ok(());
    }
    let names = packages.join(" or ");
    Err(Failure::new(format!("{program} is not installed: install it (Debian, Ubuntu: apt-get install {names})")))
}
