//! QEMU, an instruction a nanosecond.

use super::board::Board;
use super::program::Built;
use crate::setup;
use crate::steps::{Ended, Failure, Outcome, command, ended_within};
use std::path::Path;
use std::process::Command;
use std::time::Duration;

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
    let limit = LIMIT + Duration::from_secs(program.evaluations() / SLOWEST);
    run_within(program.board, &built.elf, &program.to_string(), folder, limit)
}

/// [`run`] for any linked file, by its name in an error.
pub fn run_elf(board: Board, elf: &Path, name: &str, folder: &Path) -> Outcome<String> {
    run_within(board, elf, name, folder, LIMIT)
}

fn run_within(board: Board, elf: &Path, name: &str, folder: &Path, limit: Duration) -> Outcome<String> {
    let Ended { status, printed, told } = ended_within(qemu(board).arg(elf).current_dir(folder), limit)?;
    if status.success() {
        return Ok(printed);
    }
    let lines = super::log::read(elf, name, folder).unwrap_or_default();
    let last = lines.last().map_or(told.trim(), String::as_str);
    Err(Failure::new(format!("{name} in QEMU: {status}: {last}")))
}
