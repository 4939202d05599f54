//! `cargo xtask firmware --stages`: the instructions of a frame by stage, counted one by one in QEMU's log.

use super::emulate;
use super::frame;
use super::program::Program;
use super::tables::{self, Part, Readme};
use crate::elf;
use crate::parallel;
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::{Failure, Outcome};
use firmware_boards::{Board, M3, M4, M55, RV32, RV32V};
use firmware_scenes::scene::Scene;
use stereopsis_host::run::MethodName;

/// Those whose code differs: an M7 and an M33 run an M4's.
const CORES: [Board; 5] = [M3, M4, M55, RV32, RV32V];
/// Those whose stages differ.
const METHODS: [MethodName; 3] = [MethodName::Fast, MethodName::Block, MethodName::Sgm];
/// Width, height and disparities.
const SIZE: (u16, u16, u16) = (160, 120, 32);

/// The stages, with what is in the paths of their functions and in no path of a stage before.
const STAGES: [(&str, &[&str]); 9] = [
    ("denoise", &["denoise", "imaging::smooth"]),
    ("census, features", &["census", "features"]),
    ("cost", &["columns", "tables", "reverse", "enter", "cost", "within_edges"]),
    (
        "aggregation, selection",
        &[
            "windows",
            "begin_",
            "walk",
            "paths",
            "sgm::rows",
            "select",
            "winners",
            "changes",
            "close",
            "quarters",
        ],
    ),
    ("left-right, sub-pixel", &["answers", "partners", "left_right", "subpixel", "consistency"]),
    ("fattening", &["fattening", "edges::push"]),
    ("smoothing", &["surface", "smooth", "down", "vertical"]),
    ("speckle", &["speckle"]),
    ("fill", &["fill"]),
];
/// The most of a frame that may be in no stage: more of it, and [`STAGES`] does not know a function's name.
const MOST_OUTSIDE: f64 = 0.25;

/// The part of docs/performance.md.
const PART: Part = Part { name: "stages", command: "cargo xtask firmware --stages" };

/// The instructions of a frame.
struct Counted {
    program: Program,
    all: u64,
    stages: [u64; STAGES.len()],
}

/// Counts all of it and writes the table, or compares it.
pub fn run(readme: Readme) -> Outcome {
    setup::firmware(&CORES.map(|board| board.target))?;
    let (width, height, disparities) = SIZE;
    let programs = CORES
        .into_iter()
        .flat_map(|board| METHODS.map(|method| Program::new(board, method, width, height, disparities)));
    let counted = parallel::work(programs.collect::<Outcome<_>>()?, count)?;
    let table = tables::with_compiler(&table(&counted))?;
    println!("{table}");
    tables::into_readme(&PART, &table, readme)
}

/// The failure of a line of the frames' table, with the stages whose instructions have changed since the
/// table of stages: by over a hundredth of the frame. A line of a program that is not in that table stays as
/// it is.
pub fn named(failure: Failure) -> Failure {
    let text = failure.to_string();
    let is_named = |(board, method): &(Board, MethodName)| text.contains(&row_begins(board, *method));
    let programs = CORES.into_iter().flat_map(|board| METHODS.map(|method| (board, method)));
    let Some((board, method)) = programs.into_iter().find(is_named) else { return failure };
    match changed(board, method) {
        Ok(stages) if !stages.is_empty() => Failure::new(format!("{text}; changed: {}", stages.join(", "))),
        _ => failure,
    }
}

/// What a program's row of either table begins with.
fn row_begins(board: &Board, method: MethodName) -> String {
    format!("| {} | `{method}` |", board.core)
}

/// The stages that have changed, each with its instructions before and after.
fn changed(board: Board, method: MethodName) -> Outcome<Vec<String>> {
    let (width, height, disparities) = SIZE;
    let now = count(Program::new(board, method, width, height, disparities)?)?;
    let table = PART.text()?;
    let Some(row) = table.lines().find(|line| line.starts_with(&row_begins(&board, method))) else {
        return Ok(Vec::new());
    };
    Ok(since(row, &now.stages))
}

/// The stages that have changed since a row of the table.
fn since(row: &str, now: &[u64]) -> Vec<String> {
    let numbers: Vec<f64> = row.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
    let Some((all, shares)) = numbers.split_first() else { return Vec::new() };
    let stages = STAGES.iter().zip(shares.iter().zip(now));
    let changed = stages.filter_map(|((name, _), (share, &now))| {
        let (before, now) = (all * share / 100.0, now as f64);
        ((now - before).abs() > all / 100.0).then(|| format!("{name} from {before:.0} to {now:.0}"))
    });
    changed.collect()
}

/// One frame of the built-in scene.
fn count(program: Program) -> Outcome<Counted> {
    let built = program.build()?;
    let scene = Pictures::of_scene(Scene { width: program.width, height: program.height })?;
    let all = frame::run(&built, &scene, true)?.instructions;
    let functions = elf::functions_of_the_library(&built.elf)?;
    let mut stages = [0; STAGES.len()];
    for (at, instructions) in emulate::instructions_of(&built, &functions)?.into_iter().enumerate() {
        if let Some(stage) = stage(&functions[at].name) {
            stages[stage] += instructions;
        }
    }
    let outside = all.saturating_sub(stages.iter().sum()) as f64 / all as f64;
    if outside > MOST_OUTSIDE {
        let share = 100.0 * outside;
        return Err(Failure::new(format!("{program}: {share:.1} % of its instructions are in no stage")));
    }
    println!("{program}: {all} instructions");
    Ok(Counted { program, all, stages })
}

/// The stage that a function belongs to.
fn stage(function: &str) -> Option<usize> {
    STAGES.iter().position(|(_, names)| names.iter().any(|name| function.contains(name)))
}

/// A line for each program.
fn table(counted: &[Counted]) -> String {
    let names = STAGES.map(|(name, _)| name).join(", % | ");
    let mut table = format!("| core | method | instructions | {names}, % | the rest, % |\n| --- | --- |");
    table += &" ---: |".repeat(STAGES.len() + 2);
    table += "\n";
    for Counted { program, all, stages } in counted {
        let share = |part: u64| format!(" {:.1} |", 100.0 * part as f64 / *all as f64);
        let shares: String = stages.iter().map(|&part| share(part)).collect();
        let rest = share(all.saturating_sub(stages.iter().sum()));
        table += &format!("| {} | `{}` | {all} |{shares}{rest}\n", program.board.core, program.method);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_that_changed_are_named() {
        let row = "| m4 | `sgm` | 1000 | 0.0 | 50.0 | 0.0 | 30.0 | 0.0 | 0.0 | 0.0 | 20.0 | 0.0 | 0.0 |";
        let mut now = [0, 505, 0, 300, 0, 0, 0, 200, 0];
        assert_eq!(since(row, &now), [""; 0]);
        now[7] = 215;
        assert_eq!(since(row, &now), ["speckle from 200 to 215"]);
    }

    #[test]
    fn functions_have_a_stage() {
        let name = |function| stage(function).map(|stage| STAGES[stage].0);
        assert_eq!(name("stereopsis::matching::kernels::bytes::census::ring8"), Some("census, features"));
        assert_eq!(name("stereopsis::matching::speckle::Support::count"), Some("speckle"));
        assert_eq!(name("stereopsis::matching::matcher::Matcher<S,_,_>::step"), None);
    }
}
