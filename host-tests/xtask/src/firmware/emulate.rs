//! QEMU, an instruction a nanosecond.

use super::board::Board;
use super::program::Built;
use crate::setup;
use crate::steps::{Failure, Outcome, command};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// How long a small frame may take: a second is usual, a firmware that hangs never ends.
const LIMIT: Duration = Duration::from_secs(120);
/// Evaluations a second that the slowest machine emulates, for large frames.
const SLOWEST: u64 = 100_000;

/// The program and its arguments for a board, up to the file to run.
fn qemu(board: Board) -> Command {
    let program = setup::qemu_of(board.target);
    let mut qemu = command(program, &["-machine", board.machine, "-display", "none", "-monitor", "none"]);
    if board.target.starts_with("riscv") {
        qemu.args(["-bios", "none"]);
    }
    qemu.args(["-serial", "none", "-icount", "shift=0,align=off,sleep=off"]);
    qemu.args(["-semihosting-config", "enable=on,target=native", "-kernel"]);
    qemu
}

/// Runs a program in `folder`, where its files are and go; what it prints.
pub fn run(built: &Built, folder: &Path) -> Outcome<String> {
    let program = &built.program;
    let failed = |what: String| Failure::new(format!("{program} in QEMU: {what}"));
    let mut child = qemu(program.board)
        .arg(&built.elf)
        .current_dir(folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|e| failed(e.to_string()))?;
    let limit = LIMIT + Duration::from_secs(program.evaluations() / SLOWEST);
    let start = Instant::now();
    // The text is far shorter than a pipe holds, so it can be read once the program is done.
    let status = loop {
        match child.try_wait().map_err(|e| failed(e.to_string()))? {
            Some(status) => break status,
            None if start.elapsed() < limit => std::thread::sleep(Duration::from_millis(5)),
            None => {
                // It may have ended just now.
                let _ = child.kill();
                let _ = child.wait();
                return Err(failed(format!("it did not end within {} s", limit.as_secs())));
            }
        }
    };
    let (mut printed, mut told) = (String::new(), String::new());
    let read = |from: Option<&mut dyn Read>, text: &mut String| from.map_or(Ok(0), |from| from.read_to_string(text));
    read(child.stdout.as_mut().map(|out| out as _), &mut printed).map_err(|e| failed(e.to_string()))?;
    read(child.stderr.as_mut().map(|err| err as _), &mut told).map_err(|e| failed(e.to_string()))?;
    if !status.success() {
        let lines = super::log::read(built, folder).unwrap_or_default();
        let last = lines.last().map_or(told.trim(), String::as_str);
        return Err(failed(format!("{status}: {last}")));
    }
    Ok(printed)
}
