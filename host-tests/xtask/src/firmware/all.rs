//! `cargo xtask firmware --all`: every core, method and size, two at a time.

use super::call_graph::CallGraph;
use super::checksums;
use super::frame::{self, MOST_STACK};
use super::measured::{Measured, spread};
use super::program::{Built, Program};
use super::{awkward, refusals, tables};
use crate::c;
use crate::parallel;
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::{Failure, Outcome, root};
use firmware_boards::{self as board, Board, M0, M4, M7, M55};
use firmware_scenes::scene::Scene;
use std::collections::BTreeMap;
use std::fs;
use stereopsis_host::run::MethodName;

/// Width, height and disparities that everything is measured at.
const SIZES: [(u16, u16, u16); 2] = [(160, 120, 32), (320, 240, 64)];
/// What fits the smallest board.
const SMALLEST: [(u16, u16, u16); 1] = [(96, 64, 16)];
/// The size at which the instructions over different pictures are compared.
const SPREAD_WIDTH: u16 = 160;
/// The most that they may differ, of their mean.
const MOST_SPREAD: f64 = 0.05;

/// Runs all of it and prints it; writes the tables into docs/performance.md, or compares them.
pub fn run(readme: tables::Readme) -> Outcome {
    setup::firmware(&board::ALL.map(|board| board.target))?;
    let real = checksums::pairs()?;
    if !real.is_empty() {
        // Their checksums are compared with those of the example in C.
        setup::c()?;
    }
    refusals::check()?;
    awkward::check()?;
    let results = parallel::work(in_turn(programs(readme)?), |(at, program)| Ok((at, one(program, &real)?)))?;
    let results: BTreeMap<_, _> = results.into_iter().collect();
    let results: Vec<_> = results.into_values().collect();
    let part = tables::part(&results)?;
    println!("{part}");
    for result in &results {
        held(result)?;
    }
    tables::into_readme(&tables::FIRMWARE, &part, readme)?;
    if real.is_empty() {
        println!("checksums on real pairs: NOT RUN, set STEREO_DATA to the folder that holds stereo/");
        return Ok(());
    }
    let is_sample = readme == tables::Readme::Sample;
    checksums::compare(&results, &real, if is_sample { c::Scope::Sample } else { c::Scope::All })
}

/// What is built, in the order of the tables.
fn programs(readme: tables::Readme) -> Outcome<Vec<Program>> {
    let sizes = |board: Board| if board == M0 { SMALLEST.as_slice() } else { SIZES.as_slice() };
    let is_built = |board: Board, method: MethodName, size: (u16, u16, u16)| {
        readme != tables::Readme::Sample || is_sampled(board, method, size == SIZES[1])
    };
    let all = board::ALL.into_iter().flat_map(|board| {
        MethodName::ALL
            .into_iter()
            .flat_map(move |method| sizes(board).iter().map(move |&size| (board, method, size)))
    });
    all.filter(|&(board, method, size)| is_built(board, method, size))
        .map(|(board, method, (width, height, disparities))| {
            Program::new(board, method, width, height, disparities)
        })
        .collect()
}

/// What `cargo xtask test` builds. Every method is on a core that works in words, the ones for windows and
/// along paths there in the larger size too, and those on one that works in vectors; each other core has one.
/// A Cortex-M4 runs the M7's code, so it has another method. The smallest has room for windows.
fn is_sampled(board: Board, method: MethodName, is_large: bool) -> bool {
    let is_one_of_a_kind = matches!(method, MethodName::Block | MethodName::Sgm);
    match board {
        M7 => !is_large || is_one_of_a_kind,
        M55 => !is_large && is_one_of_a_kind,
        M4 => !is_large && method == MethodName::Fast,
        M0 => method == MethodName::Block,
        _ => !is_large && method == MethodName::Sgm,
    }
}

/// The programs with their places, those of the one folder and those of the other in turn: two are built at a
/// time.
fn in_turn(programs: Vec<Program>) -> Vec<(usize, Program)> {
    let mut built = [0; 2];
    let mut jobs: Vec<_> = programs
        .into_iter()
        .enumerate()
        .map(|(at, program)| {
            let turn = built[program.folder()];
            built[program.folder()] += 1;
            (turn, at, program)
        })
        .collect();
    jobs.sort_by_key(|&(turn, at, _)| (turn, at));
    jobs.into_iter().map(|(_, at, program)| (at, program)).collect()
}

/// One program, on all the pictures of its size.
fn one(program: Program, real: &[(String, Pictures)]) -> Outcome<Measured> {
    let built = program.build()?;
    let scene = Pictures::of_scene(Scene { width: program.width, height: program.height })?;
    let frame = frame::run(&built, &scene, true)?;
    println!("{}", frame.summary());
    if [M4, M7].contains(&program.board) {
        hold_stack(&built, frame.stack)?;
    }
    let mut spread = Vec::new();
    if program.width == SPREAD_WIDTH {
        spread = spread_over(&built, real)?;
        spread.push(("scene", frame.instructions));
    }
    let checksums = if program.board == M0 { Vec::new() } else { checksums::on_core(&built, real)? };
    Ok(Measured { frame, spread, checksums })
}

/// Holds the stack that a program's calls can take to the limit; less than what was in use it cannot be.
fn hold_stack(Built { program, elf }: &Built, used: u64) -> Outcome {
    let deepest = CallGraph::of(elf)?.deepest("Reset")?;
    let (bytes, names) = (deepest.bytes, deepest.names());
    if (used..=MOST_STACK).contains(&bytes) {
        println!("{program}: its calls take {bytes} bytes of stack at most");
        return Ok(());
    }
    Err(Failure::new(format!(
        "{program}: its calls take {bytes} bytes of stack, {used} were in use, at most {MOST_STACK} may be: \
         {names}"
    )))
}

/// Instructions of a frame of nothing, of noise, of stripes and of a real picture where there is one.
fn spread_over(built: &Built, real: &[(String, Pictures)]) -> Outcome<Vec<(&'static str, u64)>> {
    let (width, height) = (built.program.width, built.program.height);
    // A well-mixed byte for each pixel, another one in each camera.
    let noise = |u: u32, v: u32, right: bool| {
        let mut h = u.wrapping_mul(0x9E37_79B1) ^ v.wrapping_mul(0x85EB_CA77) ^ u32::from(right);
        h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
        (h >> 24) as u8
    };
    let mut pictures = vec![
        ("blank", Pictures::drawn(width, height, |_, _, _| 128)),
        ("noise", Pictures::drawn(width, height, noise)),
        (
            "stripes",
            Pictures::drawn(
                width,
                height,
                |u, _, right| if (u + u32::from(right)) & 4 == 0 { 40 } else { 215 },
            ),
        ),
    ];
    if let Some((_, pair)) = real.first() {
        pictures.push(("real", pair.scaled(width, height)?));
    }
    let count =
        |(name, pictures): (_, Pictures)| Ok((name, frame::run(built, &pictures, false)?.instructions));
    pictures.into_iter().map(count).collect()
}

/// What is promised of every program.
fn held(result: &Measured) -> Outcome {
    let Measured { frame, spread: counts, .. } = result;
    let failed = |what: String| Err(Failure::new(format!("{}: {what}", frame.program)));
    if !counts.is_empty() && spread(counts) > MOST_SPREAD {
        let (found, most) = (100.0 * spread(counts), 100.0 * MOST_SPREAD);
        return failed(format!(
            "instructions over the pictures {counts:?} differ by {found:.1} %, {most} % at most"
        ));
    }
    let beside = frame.sizes.static_ram.saturating_sub(frame.pipeline);
    if beside > budget("the camera")? {
        return failed(format!(
            "{beside} bytes of RAM beside the pipeline are more than the comment of memory.x says"
        ));
    }
    if budget("the stack")? != MOST_STACK {
        return failed(format!("memory.x does not leave {MOST_STACK} bytes to the stack"));
    }
    Ok(())
}

/// The number of memory.x that stands before what it is for.
fn budget(what: &str) -> Outcome<u64> {
    let text =
        fs::read_to_string(root().join("memory.x")).map_err(|e| Failure::new(format!("memory.x: {e}")))?;
    let mut lines = text.lines().filter(|line| line.contains(what));
    let number = lines.find_map(|line| line.split_whitespace().find_map(|word| word.parse().ok()));
    number.ok_or_else(|| Failure::new(format!("memory.x has no number for {what}")))
}
