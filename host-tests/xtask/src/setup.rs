//! Gets the tools that the tests need: targets and components by rustup, QEMU and what C needs by apt-get.

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

/// Programs that have to run, and the packages that have them.
const PROGRAMS: [(&str, &str); 6] = [
    (QEMU, QEMU),
    ("arm-none-eabi-gcc", "gcc-arm-none-eabi"),
    ("cmake", "cmake"),
    ("make", "make"),
    ("gcc", "gcc"),
    ("g++", "g++"),
];

/// The package with the C library of bare Arm boards, which is no program.
const ARM_LIBRARY: &str = "libnewlib-arm-none-eabi";

/// Adds the targets, components and toolchain that are missing, then the packages.
pub fn run_all() -> Outcome {
    rustup_parts()?;
    toolchain(&rust_version()?)?;
    packages()
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

/// The packages that are missing, by apt-get where that is possible.
fn packages() -> Outcome {
    let wanted = missing_packages();
    if wanted.is_empty() {
        return Ok(());
    }
    let list = wanted.join(" ");
    let advice = || Failure::new(format!("not installed: {list}: install it (Debian, Ubuntu: apt-get install {list})"));
    let is_root = output_of(&mut command("id", &["-u"])).is_ok_and(|id| id.trim() == "0");
    let install = [&["install", "-y", "--no-install-recommends"], wanted.as_slice()].concat();
    for arguments in [["update"].as_slice(), &install] {
        let mut words = vec!["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"];
        words.extend(arguments);
        if !is_root {
            words.splice(0..0, ["sudo", "-n"]);
        }
        run(&mut command(words[0], &words[1..])).map_err(|_| advice())?;
    }
    if missing_packages().is_empty() { Ok(()) } else { Err(advice()) }
}

/// Packages whose programs or files are not there.
fn missing_packages() -> Vec<&'static str> {
    let runs = |program: &str| output_of(&mut command(program, &["--version"])).is_ok();
    let mut missing: Vec<_> = PROGRAMS.into_iter().filter(|(p, _)| !runs(p)).map(|(_, package)| package).collect();
    // The compiler says the path of a file that it has, and the mere name of one that it has not.
    let library = output_of(&mut command("arm-none-eabi-gcc", &["-print-file-name=libc.a"]));
    if !library.is_ok_and(|path| path.contains('/')) {
        missing.push(ARM_LIBRARY);
    }
    missing
}
