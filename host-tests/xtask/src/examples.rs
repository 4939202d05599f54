//! `examples/quickstart`, `examples/async` and `examples/rtic`: linted, built as their reader builds them,
//! and run in QEMU.

use crate::c;
use crate::setup;
use crate::steps::{Failure, Outcome, command, ended_within, root, run as run_command};
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

/// An example for an emulated board.
pub struct Example {
    /// Its folder's name, which is its program's too.
    name: &'static str,
    target: &'static str,
    /// The board's name in QEMU.
    machine: &'static str,
    /// What it prints.
    printed: &'static str,
}

/// The smallest firmware. It prints f b / d of the box, 140 px x 60 mm / 16 px, by its sub-pixel disparities.
pub const QUICKSTART: Example = Example {
    name: "quickstart",
    target: "thumbv7em-none-eabihf",
    machine: "mps2-an386",
    printed: "nearest: 524 mm",
};

/// Rows that a task awaits. No line may be lost, and the other task may not starve.
const ASYNC: Example = Example {
    name: "async",
    target: "thumbv7em-none-eabihf",
    machine: "mps2-an386",
    printed: "\
frame 1: nearest mm 524, lines lost 0; the other task had turns
frame 2: nearest mm 524, lines lost 0; the other task had turns
frame 3: nearest mm 524, lines lost 0; the other task had turns",
};

/// The same under RTIC: the depths are those of the blocking calls.
const RTIC: Example = Example {
    name: "rtic",
    target: "thumbv7m-none-eabi",
    machine: "mps2-an385",
    printed: "\
frame 1: nearest mm 524, lines lost 0; depths as blocking
frame 2: nearest mm 524, lines lost 0; depths as blocking
frame 3: nearest mm 524, lines lost 0; depths as blocking",
};

/// The test step of rows that are awaited.
pub fn executors() -> Outcome {
    ASYNC.run()?;
    RTIC.run()
}

/// Where all of them are built: what they share with one another and with the C interface is built once.
fn products() -> PathBuf {
    c::cargo_folder(c::Core::M4)
}

/// What they are linted for: lints do not depend on the core, and dependencies are checked once.
const LINTED: &str = "thumbv7em-none-eabihf";

/// Cargo in a folder of the examples, where its own configuration has the flags.
fn cargo(folder: &str, words: &str) -> Command {
    let mut cargo = command("cargo", &words.split_whitespace().collect::<Vec<_>>());
    cargo.current_dir(root().join("examples").join(folder));
    cargo.env("CARGO_TARGET_DIR", products());
    cargo
}

impl Example {
    /// The test step.
    pub fn run(&self) -> Outcome {
        let target = self.target;
        run_command(&mut cargo(self.name, "fmt --check"))?;
        run_command(&mut cargo(
            self.name,
            &format!("clippy --locked --release --target {LINTED} -- -D warnings"),
        ))?;
        run_command(&mut cargo(self.name, &format!("build --locked --release --target {target}")))?;
        let mut qemu = command(setup::qemu_of(target), &["-machine", self.machine, "-nographic"]);
        // Time is instructions: a slow host loses no line of the timer's.
        qemu.args(["-icount", "shift=0,align=off,sleep=off"]);
        qemu.args(["-semihosting-config", "enable=on,target=native", "-kernel"]);
        qemu.arg(products().join(target).join("release").join(self.name));
        // Text without a file is what QEMU writes on standard error.
        let ended = ended_within(&mut qemu, Duration::from_secs(60))?;
        let printed = format!("{}{}", ended.stdout, ended.stderr);
        let (name, printed) = (self.name, printed.trim());
        println!("{printed}");
        if ended.status.success() && printed == self.printed {
            return Ok(());
        }
        Err(Failure::new(format!("examples/{name} printed '{printed}', not '{}'", self.printed)))
    }
}
