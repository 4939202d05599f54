//! `cargo xtask firmware --profiles`: a firmware by what its optimiser is asked for. Every one links, so no
//! panic is left in it, and none links what another number of disparities would need.

use super::frame::{self, Frame};
use super::program::{Lto, Program};
use super::tables::{self, Part, Readme};
use crate::parallel;
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::{Failure, Outcome};
use firmware_boards::{Board, M4, RV32};
use firmware_scenes::scene::Scene;
use stereopsis_host::run::MethodName;

/// A core with assembly and one without.
const CORES: [Board; 2] = [M4, RV32];
/// A method over windows and one along paths.
const METHODS: [MethodName; 2] = [MethodName::Block, MethodName::Sgm];
/// Levels of optimisation, as cargo spells them.
const LEVELS: [&str; 3] = ["3", "s", "z"];
/// Those of a sample: two of a level, whose flash is compared.
const SAMPLE: [(MethodName, &str, Lto); 4] = [
    (MethodName::Block, "3", Lto::Fat),
    (MethodName::Block, "3", Lto::Thin),
    (MethodName::Block, "z", Lto::Off),
    (MethodName::Sgm, "s", Lto::Fat),
];
/// Width, height and disparities.
const SIZE: (u16, u16, u16) = (160, 120, 32);
/// How much more flash than the least of its level a program may take.
const MOST_GROWTH: f64 = 1.3;

/// The part of docs/performance.md.
const PART: Part = Part { name: "profiles", command: "cargo xtask firmware --profiles" };

/// A program's figures.
struct Measured {
    level: &'static str,
    lto: Lto,
    frame: Frame,
}

/// Builds and runs all of it and writes the table, or compares it.
pub fn run(readme: Readme) -> Outcome {
    let is_sample = readme == Readme::Sample;
    let cores = if is_sample { &CORES[..1] } else { &CORES };
    setup::firmware(&CORES.map(|board| board.target))?;
    let levels = || LEVELS.into_iter().flat_map(|level| Lto::ALL.map(|lto| (level, lto)));
    let all = METHODS.into_iter().flat_map(|method| levels().map(move |(level, lto)| (method, level, lto)));
    let asked: Vec<_> = all.filter(|asked| !is_sample || SAMPLE.contains(asked)).collect();
    let cases = cores.iter().flat_map(|&board| asked.iter().map(move |&asked| (board, asked)));
    let measured = parallel::work(cases.collect(), measure)?;
    for (&board, method) in cores.iter().flat_map(|board| METHODS.map(|method| (board, method))) {
        for level in LEVELS {
            let flash = |one: &Measured| one.frame.sizes.flash();
            let is_of = |one: &&Measured| {
                let program = &one.frame.program;
                program.board == board && program.method == method && one.level == level
            };
            let least = measured.iter().filter(is_of).map(flash).min().unwrap_or_default();
            let is_large = |one: &&Measured| flash(one) as f64 > MOST_GROWTH * least as f64;
            if let Some(large) = measured.iter().filter(is_of).find(is_large) {
                let (core, lto, flash) = (board.core, large.lto.name(), flash(large));
                return Err(Failure::new(format!(
                    "{core}, {method}, at opt-level {level} with lto {lto}: {flash} bytes of flash, \
                     another has {least}"
                )));
            }
        }
    }
    let table = tables::with_compiler(&table(&measured))?;
    println!("{table}");
    tables::into_readme(&PART, &table, readme)
}

/// One frame of the built-in scene. What is made for size may take more than 2 KB of stack.
fn measure((board, (method, level, lto)): (Board, (MethodName, &'static str, Lto))) -> Outcome<Measured> {
    let (width, height, disparities) = SIZE;
    let program = Program::new(board, method, width, height, disparities)?;
    let built = program.build_as(level, lto)?;
    let scene = Pictures::of_scene(Scene { width, height })?;
    Ok(Measured { level, lto, frame: frame::with_any_stack(&built, &scene, true)? })
}

/// A line for each program.
fn table(measured: &[Measured]) -> String {
    let mut table = "| core | method | opt-level | lto | instructions | for an evaluation | stack | flash | \
                     of it dense path | panic symbols |\n| --- | --- | --- | --- | ---: | ---: | ---: | ---: \
                     | ---: | ---: |\n"
        .to_owned();
    for Measured { level, lto, frame } in measured {
        table += &format!(
            "| {} | `{}` | {level} | {} | {} | {:.2} | {} | {} | {} | {} |\n",
            frame.program.board.core,
            frame.program.method,
            lto.name(),
            frame.instructions,
            frame.per_evaluation(),
            frame.stack,
            frame.sizes.flash(),
            frame.sizes.dense_flash,
            frame.sizes.panics.len()
        );
    }
    table
}
