//! The whole system: firmware on an emulated core starts the simulated block, sends it the cameras' lines,
//! takes its winners and makes rows of them. Two pipes join QEMU and the simulation.

use super::block::Block;
use crate::firmware::{emulate, program::Program};
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::{Failure, Outcome, command, run as run_command};
use firmware_boards::{self as board, Board};
use firmware_scenes::scene::Scene;
use std::path::Path;
use std::process::{Child, Command};
use stereopsis_host::run::MethodName;

/// The frame: its size and disparities, and those in a clock.
const WIDTH: u16 = 160;
const HEIGHT: u16 = 120;
const DISPARITIES: u16 = 32;
const PARALLEL: u16 = 16;

/// Each method of the block behind two kinds of cores.
pub fn run() -> Outcome {
    let boards = [board::RV32, board::M4];
    setup::gates()?;
    setup::firmware(&boards.map(|board| board.target))?;
    let pictures = Pictures::of_scene(Scene { width: WIDTH, height: HEIGHT })?;
    for method in super::block::METHODS {
        let block =
            Block { width: WIDTH, disparities: DISPARITIES, parallel: PARALLEL, method, second_best: false };
        let simulation = block.build()?;
        for board in boards {
            one(board, method, &simulation, &pictures)?;
        }
    }
    Ok(())
}

/// A simulation that waits for the other ends of its pipes, and is ended with this.
struct Waiting(Child);

impl Drop for Waiting {
    fn drop(&mut self) {
        // One that has ended already cannot be ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// One frame; its checksum is that of the host's rows.
fn one(board: Board, method: MethodName, simulation: &Path, pictures: &Pictures) -> Outcome {
    let program = Program::new(board, method, WIDTH, HEIGHT, DISPARITIES)?;
    let elf = program.build_other("gates", "")?;
    let name = format!("{method} in gates, the rest on {}", board.core);
    let failed = |what: String| Failure::new(format!("{name}: {what}"));
    let folder = tempfile::tempdir().map_err(|e| failed(e.to_string()))?;
    pictures.write(folder.path())?;
    run_command(command("mkfifo", &["to_block", "from_block"]).current_dir(folder.path()))?;
    // A shell opens the pipes, in the firmware's order: each waits for its other end.
    let mut shell = Command::new("sh");
    shell.args(["-c", "exec \"$0\" <to_block >from_block"]).arg(simulation).current_dir(folder.path());
    let mut waiting = Waiting(shell.spawn().map_err(|e| failed(e.to_string()))?);
    let printed = emulate::run_elf(board, &elf, &name, folder.path())?;
    let ended = waiting.0.wait().map_err(|e| failed(e.to_string()))?;
    if !ended.success() {
        return Err(failed(format!("the simulation ended with {ended}")));
    }
    let figure = |name: &str| {
        let line = printed.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
        line.and_then(|number| number.parse::<u64>().ok()).ok_or_else(|| failed(format!("no {name}")))
    };
    let (found, expected) = (figure("crc32")?, pictures.crc32(method, DISPARITIES)?);
    if found != u64::from(expected) || figure("rows")? != u64::from(HEIGHT) {
        return Err(failed(format!("crc32 {found:08x}, the host's pipeline has {expected:08x}")));
    }
    println!(
        "{name}: {HEIGHT} rows, crc32 {found:08x}, that of the host; {} bytes of state, {} of stack",
        figure("pipeline_bytes")?,
        figure("stack_bytes")?
    );
    Ok(())
}
