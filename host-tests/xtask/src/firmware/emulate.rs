//! QEMU, an instruction a nanosecond.

use super::program::Built;
use crate::elf::Function;
use crate::setup;
use crate::steps::{Ended, Failure, Outcome, command, ended_within};
use firmware_boards::Board;
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
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
    qemu.args(board.cpu.into_iter().flat_map(|cpu| ["-cpu", cpu]));
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

/// How many instructions a program runs of each of these functions, as QEMU logs them, one in a block.
pub fn instructions_of(built: &Built, functions: &[Function]) -> Outcome<Vec<u64>> {
    let failed = |what: String| Failure::new(format!("{} in QEMU: {what}", built.program));
    let ranges: Vec<_> = functions
        .iter()
        .map(|Function { place: (from, bytes), .. }| format!("{from:#x}+{bytes:#x}"))
        .collect();
    let folder = tempfile::tempdir().map_err(|e| failed(e.to_string()))?;
    let mut qemu = qemu(built.program.board);
    qemu.arg(&built.elf).args(["-singlestep", "-d", "exec,nochain", "-dfilter", &ranges.join(",")]);
    let spawned = qemu.current_dir(folder.path()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
    let mut child = spawned.map_err(|e| failed(e.to_string()))?;
    let by_address: BTreeMap<_, _> =
        functions.iter().enumerate().map(|(at, function)| (function.place.0, at)).collect();
    let mut counts = vec![0; functions.len()];
    for line in child.stderr.take().into_iter().flat_map(|log| BufReader::new(log).lines()) {
        let line = line.map_err(|e| failed(e.to_string()))?;
        // `Trace 0: 0x7f0000000000 [00000400/00001a2c/00000110/ff000201] symbol`
        let Some(address) = line.split('/').nth(1).filter(|_| line.starts_with("Trace ")) else { continue };
        let address = u64::from_str_radix(address, 16).map_err(|e| failed(format!("{line}: {e}")))?;
        if let Some((_, &at)) = by_address.range(..=address).next_back() {
            counts[at] += 1;
        }
    }
    let status = child.wait().map_err(|e| failed(e.to_string()))?;
    if status.success() { Ok(counts) } else { Err(failed(status.to_string())) }
}

/// [`run`] for any linked file, by its name in an error.
pub fn run_elf(board: Board, elf: &Path, name: &str, folder: &Path) -> Outcome<String> {
    run_within(board, elf, name, folder, LIMIT)
}

fn run_within(board: Board, elf: &Path, name: &str, folder: &Path, limit: Duration) -> Outcome<String> {
    let Ended { status, stdout: printed, stderr } =
        ended_within(qemu(board).arg(elf).current_dir(folder), limit)?;
    if status.success() {
        return Ok(printed);
    }
    let lines = super::log::read(elf, name, folder).unwrap_or_default();
    let last = lines.last().map_or(stderr.trim(), String::as_str);
    Err(Failure::new(format!("{name} in QEMU: {status}: {last}")))
}
