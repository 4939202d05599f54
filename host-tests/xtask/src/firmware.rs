//! The firmware example: built, run in QEMU, and held to the text that the host gets.

use crate::setup::QEMU;
use crate::steps::{Failure, Outcome, command, root, run as run_command, target_dir};
use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// How long the emulated frame may take: a second is usual, a firmware that hangs never ends.
const LIMIT: Duration = Duration::from_secs(120);

/// Cargo in the example's folder, where its own configuration names the target.
pub fn cargo(words: &str) -> Command {
    let mut cargo = command("cargo", &words.split_whitespace().collect::<Vec<_>>());
    cargo.current_dir(folder()).env("CARGO_TARGET_DIR", target_dir().join("firmware"));
    cargo
}

/// Builds the example and compares what it prints with `expected.txt`.
pub fn run() -> Outcome {
    run_command(&mut cargo("build --locked --release"))?;
    let program = target_dir().join("firmware/thumbv7em-none-eabihf/release/stereopsis-firmware");
    let mut qemu = command(QEMU, &["-machine", "mps2-an386", "-nographic"]);
    qemu.args(["-semihosting-config", "enable=on,target=native", "-kernel"]).arg(&program);
    let printed = output_within(&mut qemu, LIMIT)?;
    print!("{printed}");
    let path = folder().join("expected.txt");
    let expected =
        std::fs::read_to_string(&path).map_err(|e| Failure::new(format!("examples/firmware/expected.txt: {e}")))?;
    if printed == expected {
        println!("the board and the host agree (examples/firmware/expected.txt)");
        return Ok(());
    }
    let differs = || printed.lines().zip(expected.lines()).find(|(a, b)| a != b);
    let (got, wanted) = differs().unwrap_or(("a text of another length", "the whole text"));
    Err(Failure::new(format!("the board says \"{got}\", examples/firmware/expected.txt \"{wanted}\"")))
}

/// The example's folder.
fn folder() -> PathBuf {
    root().join("examples/firmware")
}

/// What a command prints, which it has to have done within `limit`.
fn output_within(command: &mut Command, limit: Duration) -> Outcome<String> {
    let failed = |e: std::io::Error| Failure::new(format!("{QEMU}: {e}"));
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(failed)?;
    let start = Instant::now();
    // The text is far shorter than a pipe holds, so it can be read once the program is done.
    let status = loop {
        match child.try_wait().map_err(failed)? {
            Some(status) => break status,
            None if start.elapsed() < limit => std::thread::sleep(Duration::from_millis(20)),
            None => {
                child.kill().map_err(failed)?;
                child.wait().map_err(failed)?;
                return Err(Failure::new(format!("the firmware did not end within {} s", limit.as_secs())));
            }
        }
    };
    let mut printed = String::new();
    if let Some(mut out) = child.stdout.take() {
        out.read_to_string(&mut printed).map_err(failed)?;
    }
    if !status.success() {
        return Err(Failure::new(format!("the firmware ended with {status}: {}", printed.trim())));
    }
    Ok(printed)
}
