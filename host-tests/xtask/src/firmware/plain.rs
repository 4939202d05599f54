//! The tables in docs/performance.md of the programs without sizes to choose: a line for each core that one
//! is measured on.

use super::program::Optimised;
use super::results::Taken;
use super::tables::{self, Part, Readme};
use crate::parallel;
use crate::steps::Outcome;
use firmware_boards::{self as board, Board};

/// What came of a program, as its table shows it.
pub trait Tabled: Send {
    /// The program's name, and that of its part of docs/performance.md.
    const NAME: &'static str;
    /// What it is measured on; most are on both cores that are built alike, and on one of them made for size.
    const CASES: &'static [(Board, Optimised)] =
        &[(board::M4, Optimised::Speed), (board::M7, Optimised::Speed), (board::M7, Optimised::Size)];
    /// The columns between the core and what every program takes.
    const COLUMNS: &'static [&'static str];
    /// What stands in them.
    fn cells(&self) -> Vec<String>;
    /// What it takes.
    fn taken(&self) -> &Taken;
}

/// Measures a program; writes its table into docs/performance.md, or compares it.
pub fn run_all<T: Tabled>(
    readme: Readme,
    run: fn(Board, Optimised) -> Outcome<T>,
    told: fn(&T) -> String,
) -> Outcome {
    into_readme::<T>(&table(&measured(readme, run, told)?), readme)
}

/// Runs a program on all of its cases and says what came of each. Cores with the same instructions are as one
/// in a sample.
pub fn measured<T: Tabled>(
    readme: Readme,
    run: fn(Board, Optimised) -> Outcome<T>,
    told: fn(&T) -> String,
) -> Outcome<Vec<T>> {
    let is_measured = |board: Board| readme != Readme::Sample || [board::M7, board::RV32].contains(&board);
    let cases = T::CASES.iter().copied().filter(|&(board, _)| is_measured(board)).collect();
    parallel::work(cases, |(board, optimised)| {
        let found = run(board, optimised)?;
        println!("{}", told(&found));
        Ok(found)
    })
}

/// The table. What a line is made for stands in it where that is not the same for all.
pub fn table<T: Tabled>(all: &[T]) -> String {
    let says_size = T::CASES.iter().any(|&(_, optimised)| optimised == Optimised::Size);
    let made_for = |words: &'static str| says_size.then_some(words);
    let line = |cells: &[&str]| format!("| {} |\n", cells.join(" | "));
    let names: Vec<_> = ["core"].into_iter().chain(made_for("made for")).collect();
    let numbers = [T::COLUMNS, &["static RAM", "stack", "flash", "panic symbols"]].concat();
    let rule = [vec!["---"; names.len()], vec!["---:"; numbers.len()]].concat();
    let mut table = line(&[names, numbers].concat()) + &line(&rule);
    for one in all {
        let taken = one.taken();
        let takes =
            [taken.static_ram_bytes, taken.stack_bytes, taken.flash_bytes, taken.panic_symbols as u64];
        let numbers: Vec<_> = one.cells().into_iter().chain(takes.map(|n| n.to_string())).collect();
        let names = [taken.core].into_iter().chain(made_for(taken.made_for()));
        table += &line(&names.chain(numbers.iter().map(String::as_str)).collect::<Vec<_>>());
    }
    table
}

/// Writes the text with a program's table into docs/performance.md, or compares it.
pub fn into_readme<T: Tabled>(text: &str, readme: Readme) -> Outcome {
    let part = tables::with_compiler(text)?;
    println!("{part}");
    tables::into_readme(&Part { name: T::NAME, command: "cargo xtask firmware --all" }, &part, readme)
}
