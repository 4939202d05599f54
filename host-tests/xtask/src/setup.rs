//! Gets the tools that the tests need: targets and components by rustup, QEMU by apt-get.

use crate::steps::{Failure, Outcome, command, output_of, root, run};
use std::fs;

/// The targets that the core is built for.
pub const TARGETS: [&str; 5] = [
    "thumbv6m-none-eabi",
    "thumbv7em-none-eabihf",
    "thumbv8m.main-none-eabihf",
    "riscv32imac-unknown-none-elf",
    "aarch64-unknown-none",
];

/// The emulator of the firmware's board, and the package that has it.
pub const QEMU: &str = "qemu-system-arm";

/// Adds the targets, components and toolchain that are missing, then QEMU.
pub fn run_all() -> Outcome {
    rustup_parts()?;
    toolchain(&rust_version()?)?;
    qemu()
}

/// Targets of the cross builds; rustfmt and clippy.
fn rustup_parts() -> Outcome {
    let installed = |kind: &str| {
        output_of(&mut command("rustup", &[kind, "list", "--installed"]))
            .map_err(|e| Failure::new(format!("{e}; install rustup: the tests need targets that it adds")))
    };
    let targets = installed("target")?;
    let missing: Vec<_> = TARGETS.into_iter().filter(|target| !targets.lines().any(|line| line == *target)).collect();
    if !missing.is_empty() {
        run(&mut command("rustup", &[&["target", "add"], missing.as_slice()].concat()))?;
    }
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

/// QEMU for the firmware, by apt-get where that is possible.
fn qemu() -> Outcome {
    if output_of(&mut command(QEMU, &["--version"])).is_ok() {
        return Ok(());
    }
    let advice =
        || Failure::new(format!("{QEMU} is not installed: install it (Debian, Ubuntu: apt-get install {QEMU})"));
    let is_root = output_of(&mut command("id", &["-u"])).is_ok_and(|id| id.trim() == "0");
    for arguments in [["update"].as_slice(), &["install", "-y", "--no-install-recommends", QEMU]] {
        let mut words = vec!["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"];
        words.extend(arguments);
        if !is_root {
            words.splice(0..0, ["sudo", "-n"]);
        }
        run(&mut command(words[0], &words[1..])).map_err(|_| advice())?;
    }
    output_of(&mut command(QEMU, &["--version"])).map(drop).map_err(|_| advice())
}
