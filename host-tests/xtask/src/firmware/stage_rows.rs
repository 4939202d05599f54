//! Rows of the matcher's stages as a core makes them: those of the naive twins, byte for byte, and the files
//! that `stereo dump` writes of them.

use super::arguments::One;
use super::emulate;
use super::program::Program;
use crate::parallel;
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::{Failure, Outcome};
use firmware_boards::{self as board, Board};
use firmware_scenes::scene::Scene;
use std::fs;
use stereopsis::imaging::Noise;
use stereopsis::matching::{Config, WinnerRecord};
use stereopsis_host::dump::{Dump, Stage};
use stereopsis_host::output::Staging;
use stereopsis_host::run::{MethodName, NoiseChoice};
use stereopsis_host::twin::stages::Stages;

/// What the test runs: every core, and on kinds of them methods of both kinds. The smallest has room for
/// windows.
const SAMPLE: [(Board, MethodName); 9] = [
    (board::M0, MethodName::Block),
    (board::M3, MethodName::Block),
    (board::M4, MethodName::Sgm),
    (board::M7, MethodName::Fast),
    (board::M33, MethodName::Sgm),
    (board::M55, MethodName::Sgm),
    (board::M55, MethodName::Block),
    (board::RV32, MethodName::Fast),
    (board::RV32, MethodName::Sgm),
];

/// One frame on one core; its rows into a folder.
pub fn run(one: &One) -> Outcome {
    let mut pictures = match &one.pair {
        Some((left, right)) => Pictures::open(left, right)?,
        None => Pictures::of_scene(one.scene())?,
    };
    let size = [pictures.width, pictures.height];
    let mut program = program(one.board, one.method, size, one.disparities)?;
    if one.pair.is_some() && one.method.compares_brightness() {
        pictures.balance()?;
    }
    program.noise = match one.noise {
        NoiseChoice::Auto if one.pair.is_none() => Noise::None,
        choice => pictures.noise(choice)?,
    };
    Staging::probe(&one.out).map_err(|e| Failure::new(format!("--out: {e}")))?;
    setup::firmware(&[one.board.target])?;
    let (config, dumps) = rows(program, &pictures)?;
    let write = || {
        let mut staging = Staging::new(&one.out)?;
        for dump in &dumps {
            let name = dump.stage().name();
            staging.write(&format!("{name}.bin"), |file| dump.write(file))?;
            staging.write(&format!("{name}.mem"), |file| dump.write_mem(file))?;
            let manifest = dump.manifest(&config, one.method.name());
            staging.write(&format!("{name}.json"), |file| {
                serde_json::to_writer_pretty(&mut *file, &manifest)?;
                file.write_all(b"\n")
            })?;
        }
        staging.commit(&[])
    };
    write().map_err(|e| Failure::new(format!("--out: {e}")))?;
    println!("rows of the stages are in {}, equal to the twins' to the bit", one.out.display());
    Ok(())
}

/// Every core on a small scene, the smallest on a smaller one.
pub fn check() -> Outcome {
    let one = |(board, method)| {
        let (width, height, disparities) = if board == board::M0 { (64, 48, 16) } else { (96, 64, 32) };
        let program = program(board, method, [width, height], disparities)?;
        rows(program, &Pictures::of_scene(Scene { width, height })?).map(|_| ())
    };
    parallel::work(SAMPLE.to_vec(), one).map(|_| ())
}

/// The program for frames of that size, with room for the sums that are worked out beside the matcher.
fn program(
    board: Board,
    method: MethodName,
    [width, height]: [u16; 2],
    disparities: u16,
) -> Outcome<Program> {
    let (pixels, candidates) = (usize::from(width), usize::from(width) * usize::from(disparities));
    let paths = usize::from(method.compares_brightness());
    let more = 25 * pixels + (1 + 2 * paths) * candidates;
    Program::with_more(board, method, width, height, disparities, more)
}

/// The rows of all stages in their order, as the core made them; and what was searched for.
fn rows(program: Program, pictures: &Pictures) -> Outcome<(Config, Vec<Dump>)> {
    let name = format!("{program}-dump");
    let failed = |what: String| Failure::new(format!("{name}: {what}"));
    let elf = program.build_other("dump", "trace")?;
    let folder = tempfile::tempdir().map_err(|e| failed(e.to_string()))?;
    pictures.write(folder.path())?;
    emulate::run_elf(program.board, &elf, &name, folder.path())?;

    let Program { method, height, disparities, noise, .. } = program;
    let config = pictures.search(method, disparities, noise);
    let [left, right] = pictures.camera()?.pictures();
    let stages = Stages::of(&method.twin(), &config, &left, &right);
    let mut dumps = Vec::new();
    for stage in stages_of(method) {
        let file = format!("{}.bin", stage.name());
        let found = fs::read(folder.path().join(&file)).map_err(|e| failed(format!("{file}: {e}")))?;
        let expected: Vec<_> = (0..usize::from(height)).flat_map(|y| expected(stage, &stages, y)).collect();
        if found.len() != expected.len() {
            return Err(failed(format!("{file} has {} bytes, the twin's {}", found.len(), expected.len())));
        }
        if let Some(at) = found.iter().zip(&expected).position(|(found, expected)| found != expected) {
            return Err(failed(format!("byte {at} of {file} is not the twin's")));
        }
        dumps.push(Dump::of_rows(stage, &found, found.len() / usize::from(height)));
    }
    println!("{name}: {height} rows of {} stages, those of the twins", dumps.len());
    Ok((config, dumps))
}

/// The stages that a core makes rows of: all but the sums of the method that looks two rows ahead.
fn stages_of(method: MethodName) -> impl Iterator<Item = Stage> {
    Stage::ALL.into_iter().filter(move |&stage| method != MethodName::SgmEdge || stage != Stage::Aggregated)
}

/// A row as a core has it: it does not tell the second best of a winner.
fn expected(stage: Stage, stages: &Stages, y: usize) -> Vec<u8> {
    let row = stage.row(stages, y);
    if stage != Stage::Winner {
        return row;
    }
    let records = row.as_chunks().0.iter().map(|&bytes| WinnerRecord::from_bytes(bytes));
    records.flat_map(|record| record.with_second(u8::MAX).sealed(y as u16).bytes()).collect()
}
