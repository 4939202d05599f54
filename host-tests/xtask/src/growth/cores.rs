//! Instructions on emulated cores: a program for each number of disparities, with frames of all sizes.

use super::sizes::{Column, Series, Size, series};
use super::table;
use crate::firmware::frame::{self, Frame};
use crate::firmware::program::{Built, Program};
use crate::firmware::tables::{self, Readme};
use crate::parallel;
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::Outcome;
use firmware_boards::{Board, M4, M55};
use firmware_scenes::scene::Scene;
use stereopsis_host::run::MethodName;

/// A core that works in words and one that works in vectors.
const CORES: [Board; 2] = [M4, M55];

/// A method over windows and one along paths: others grow as they do.
const METHODS: [MethodName; 2] = [MethodName::Block, MethodName::Sgm];

/// Sizes, an odd width and numbers of disparities that are no power of two among them.
const WIDTHS: [u16; 5] = [80, 160, 319, 320, 640];
const HEIGHTS: [u16; 4] = [30, 60, 120, 240];
const DISPARITIES: [u16; 7] = [16, 32, 48, 64, 96, 128, 256];

/// How many times as much an evaluation may cost as at a smaller size: lines that are no whole words long
/// cost more, and so do more than 64 disparities where sums are no longer kept in registers.
const MOST: f64 = 1.3;
/// The same where the disparities are no multiple of 32: kernels that keep 32 of them in a word work in
/// halves then.
const MOST_IN_HALVES: f64 = 2.0;

/// The part of docs/performance.md.
const PART: tables::Part = tables::Part { name: "growth", command: "cargo xtask growth" };

/// Measures all of it and prints it; writes the table into docs/performance.md, or compares it.
pub fn run(readme: Readme) -> Outcome {
    let text = measured(&CORES, &DISPARITIES)?;
    tables::into_readme(&PART, &tables::with_compiler(&text)?, readme)
}

/// Holds a few sizes on one core to the limits: columns are not lines of docs/performance.md.
pub fn sample() -> Outcome {
    measured(&CORES[..1], &[16, 32, 128]).map(drop)
}

/// Measures all sizes and holds them to the limits; the table.
fn measured(cores: &[Board], disparities: &[u16]) -> Outcome<String> {
    setup::firmware(&cores.iter().map(|board| board.target).collect::<Vec<_>>())?;
    let series = series(&WIDTHS, &HEIGHTS, disparities);
    let jobs: Vec<_> = cores.iter().flat_map(|&board| METHODS.map(|method| (board, method))).collect();
    let columns = parallel::work(jobs, |(board, method)| column(board, method, &series, disparities))?;
    let text = table::text(&series, &columns);
    println!("{text}");
    table::held(
        &series,
        &columns,
        |size| if size.disparities.is_multiple_of(32) { MOST } else { MOST_IN_HALVES },
    )?;
    Ok(text)
}

/// The instructions of one method on one core, for each evaluation, at all sizes.
fn column(board: Board, method: MethodName, series: &[Series], searches: &[u16]) -> Outcome<Column> {
    let sizes: Vec<Size> = series.iter().flat_map(|(_, sizes)| sizes.iter().copied()).collect();
    let (widest, highest) = (WIDTHS[WIDTHS.len() - 1], HEIGHTS[HEIGHTS.len() - 1]);
    let mut costs = vec![0.0; sizes.len()];
    for &disparities in searches {
        let built = Program::new(board, method, widest, highest, disparities)?.build()?;
        let mut stack = 0;
        for (cost, &size) in costs.iter_mut().zip(&sizes).filter(|(_, size)| size.disparities == disparities)
        {
            let frame = frame_of(&built, size)?;
            *cost = frame.instructions as f64 / size.evaluations() as f64;
            stack = frame.stack;
        }
        println!(
            "{} `{method}` with {disparities} disparities is measured, {stack} bytes of stack",
            board.core
        );
    }
    Ok(Column { on: board.core.to_owned(), method, costs })
}

/// A frame of the built-in scene, in any size, through a pipeline with room for the largest.
fn frame_of(built: &Built, size: Size) -> Outcome<Frame> {
    let scene = Pictures::of_scene(Scene { width: size.width, height: size.height })?;
    frame::with_any_stack(built, &scene, false)
}
