//! `examples/boards`: the programs for real boards are built, and hold the instructions that their cores
//! have; their matchers run under their memory maps in QEMU, where every row is that of one pipeline on
//! this machine.
//!
//! [`emulated`] runs them.

mod emulated;

use crate::elf;
use crate::setup;
use crate::steps::{Failure, Outcome, command, root, run as run_command, target_dir};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// A folder of `examples/boards`.
struct Board {
    /// The folder's name, which is its program's too.
    name: &'static str,
    target: &'static str,
    /// The module of the kernel that the core has instructions for.
    kernel: &'static str,
}

const DSP: &str = "::backend::armv7em::";
const PLAIN: &str = "::backend::portable::";

const BOARDS: [Board; 4] = [
    Board { name: "rp2350", target: "thumbv8m.main-none-eabihf", kernel: DSP },
    Board { name: "nrf5340", target: "thumbv8m.main-none-eabihf", kernel: DSP },
    Board { name: "stm32h743", target: "thumbv7em-none-eabihf", kernel: DSP },
    Board { name: "esp32c3", target: "riscv32imc-unknown-none-elf", kernel: PLAIN },
];

/// How far a README's bytes may be from what is linked: compilers differ.
const MOST_OFF: f64 = 0.05;

/// The test step.
pub fn run() -> Outcome {
    setup::targets(&BOARDS.map(|board| board.target))?;
    for folder in ["spi-cameras", "matchers", "emulated"] {
        run_command(&mut cargo(folder, "fmt --check"))?;
    }
    BOARDS.iter().try_for_each(Board::run)?;
    emulated::run()
}

/// Cargo in a folder of the boards, where its own configuration has the flags. What they share is built once
/// in one folder of products.
fn cargo(folder: &str, words: &str) -> Command {
    let mut cargo = command("cargo", &words.split_whitespace().collect::<Vec<_>>());
    cargo.current_dir(root().join("examples/boards").join(folder));
    // Flags of the caller's would take the place of the folder's.
    cargo.env_remove("CARGO_ENCODED_RUSTFLAGS").env_remove("RUSTFLAGS");
    cargo.env("CARGO_TARGET_DIR", products());
    cargo
}

/// The folder of products.
fn products() -> PathBuf {
    root().join(target_dir()).join("boards")
}

impl Board {
    fn run(&self) -> Outcome {
        run_command(&mut cargo(self.name, "fmt --check"))?;
        // No debugger looks at these.
        let mut build = cargo(self.name, &format!("build --locked --release --target {}", self.target));
        run_command(build.env("CARGO_PROFILE_RELEASE_DEBUG", "false"))?;
        let program = products().join(self.target).join("release").join(self.name);
        let functions = elf::functions_of_the_library(&program)?;
        if !functions.iter().any(|function| function.name.contains(self.kernel)) {
            return Err(self.failed(format!("no function of {} is in the program", self.kernel)));
        }
        let (linked, said) = (elf::Sizes::of_any(&program)?.flash() as f64, self.flash_of_readme()?);
        println!("{}: {linked} bytes of flash", self.name);
        if (linked / said - 1.0).abs() > MOST_OFF {
            return Err(self.failed(format!("its README says {said} bytes of flash, linked are {linked}")));
        }
        Ok(())
    }

    /// The bytes of flash in the table of its README.
    fn flash_of_readme(&self) -> Outcome<f64> {
        let path = root().join("examples/boards").join(self.name).join("README.md");
        let text = fs::read_to_string(&path).map_err(|e| Failure::new(format!("{}: {e}", path.display())))?;
        let row = text.lines().find(|line| line.starts_with("| flash |"));
        let cell = row.and_then(|row| row.split('|').nth(2)).unwrap_or_default().replace(' ', "");
        cell.parse().map_err(|_| self.failed("its README has no row \"| flash | bytes |\"".to_owned()))
    }

    fn failed(&self, what: String) -> Failure {
        Failure::new(format!("examples/boards/{}: {what}", self.name))
    }
}
