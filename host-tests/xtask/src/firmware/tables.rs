//! The parts of docs/performance.md that are made of the firmware's figures.

use super::measured::{Measured, spread};
use crate::steps::{Failure, Outcome, command, output_of, root};
use std::fs;
use std::ops::Range;
use std::path::PathBuf;

/// A part of docs/performance.md, between lines that name it.
pub struct Part {
    pub name: &'static str,
    /// What writes it.
    pub command: &'static str,
}

/// What is done with the figures' tables.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Readme {
    /// All is measured and written.
    Write,
    /// All is measured, and docs/performance.md has to say it.
    Compare,
    /// A part is measured that every kind of core has a share in, for the sake of time, and
    /// docs/performance.md has to say it.
    Sample,
}

impl Readme {
    /// As `--check` asks for.
    pub fn of_check(check: bool) -> Self {
        if check { Self::Compare } else { Self::Write }
    }
}

/// That of `cargo xtask firmware --all`.
pub const FIRMWARE: Part = Part { name: "firmware", command: "cargo xtask firmware --all" };

/// How far a figure may lie from the figures': another folder moves a constant, another compiler makes other
/// code.
const WITHIN: f64 = 0.01;
const WITHIN_OF_ANOTHER_COMPILER: f64 = 0.15;

/// The names of the pictures in the table, in its order. Real pictures are not everybody's and not in it.
const PICTURES: [&str; 4] = ["blank", "noise", "stripes", "scene"];

/// The whole part.
pub fn part(results: &[Measured]) -> Outcome<String> {
    Ok(format!("{}\n{}", with_compiler(&figures(results))?, spreads(results)))
}

/// A table with a line below it that says what compiled the programs.
pub fn with_compiler(table: &str) -> Outcome<String> {
    let compiler = output_of(&mut command("rustc", &["--version"]))?;
    let version = compiler.split_whitespace().nth(1).unwrap_or_default();
    Ok(format!("{table}\nCompiler: rustc {version}.\n"))
}

/// A line for each program.
fn figures(results: &[Measured]) -> String {
    let mut table = "| core | method | pixels | disparities | instructions | for an evaluation | static RAM \
                     | stack | flash | of it dense path | panic symbols |\n| --- | --- | --- | ---: | ---: \
                     | ---: | ---: | ---: | ---: | ---: | ---: |\n"
        .to_owned();
    for Measured { frame, .. } in results {
        let (program, sizes) = (&frame.program, &frame.sizes);
        table += &format!(
            "| {} | `{}` | {}x{} | {} | {} | {:.2} | {} | {} | {} | {} | {} |\n",
            program.board.core,
            program.method,
            program.width,
            program.height,
            program.disparities,
            frame.instructions,
            frame.per_evaluation(),
            sizes.static_ram,
            frame.stack,
            sizes.flash(),
            sizes.dense_flash,
            sizes.panics.len()
        );
    }
    table
}

/// A line for each program that saw different pictures.
fn spreads(results: &[Measured]) -> String {
    let mut table = format!("| core | method | {} | spread, % |\n| --- | --- |", PICTURES.join(" | "));
    table += &" ---: |".repeat(PICTURES.len() + 1);
    table += "\n";
    for result in results.iter().filter(|result| !result.spread.is_empty()) {
        let program = &result.frame.program;
        let shown: Vec<_> =
            result.spread.iter().copied().filter(|(name, _)| PICTURES.contains(name)).collect();
        let counts: String = shown.iter().map(|(_, count)| format!(" {count} |")).collect();
        table += &format!(
            "| {} | `{}` |{counts} {:.2} |\n",
            program.board.core,
            program.method,
            100.0 * spread(&shown)
        );
    }
    table
}

/// Writes a part's text into docs/performance.md, or only compares.
pub fn into_readme(part: &Part, text: &str, readme: Readme) -> Outcome {
    if readme == Readme::Write {
        return splice(part, text);
    }
    let (whole, place) = part.find()?;
    match difference(&whole[place], text, readme == Readme::Sample) {
        Some(what) => Err(Failure::new(format!("docs/performance.md: {what}; run `{}`", part.command))),
        None => Ok(()),
    }
}

/// Writes a part's text into docs/performance.md.
pub fn splice(part: &Part, text: &str) -> Outcome {
    let (mut readme, place) = part.find()?;
    readme.replace_range(place, &format!("\n{text}\n"));
    fs::write(readme_path(), readme).map_err(|e| Failure::new(format!("docs/performance.md: {e}")))
}

fn readme_path() -> PathBuf {
    root().join("docs/performance.md")
}

impl Part {
    /// The text of the part as it stands.
    pub fn text(&self) -> Outcome<String> {
        let (whole, place) = self.find()?;
        Ok(whole[place].to_owned())
    }

    /// docs/performance.md, and where the part stands in it.
    fn find(&self) -> Outcome<(String, Range<usize>)> {
        let failed = |what: String| Failure::new(format!("docs/performance.md: {what}"));
        let (begin, end) =
            (format!("<!-- generated: {} -->\n", self.name), format!("<!-- end: {} -->", self.name));
        let readme = fs::read_to_string(readme_path()).map_err(|e| failed(e.to_string()))?;
        let missing = |line: &str| failed(format!("there is no line {}", line.trim()));
        let first = readme.find(&begin).ok_or_else(|| missing(&begin))? + begin.len();
        let length = readme[first..].find(&end).ok_or_else(|| missing(&end))?;
        Ok((readme, first..first + length))
    }
}

/// How two parts differ, if they do: in words, or in figures by more than they may. Of a sample, each line
/// has to be in the old part.
fn difference(old: &str, new: &str, is_sample: bool) -> Option<String> {
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let compiler = |text: &str| text.lines().find(|line| line.starts_with("Compiler: ")).map(str::to_owned);
    let within = if compiler(old) == compiler(new) { WITHIN } else { WITHIN_OF_ANOTHER_COMPILER };
    let lines = |text: &str| {
        let lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with("Compiler: "));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    let (old, new) = (lines(old), lines(new));
    if !is_sample && old.len() != new.len() {
        return Some(format!("the tables have {} lines where {} are due", old.len(), new.len()));
    }
    let is_near = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
        // Shares of a percent and small counts may differ by a little in themselves.
        (Ok(a), Ok(b)) => {
            (a - b).abs() <= within * a.abs().max(b.abs()) || (a - b).abs() <= 0.5 && a.fract() != 0.0
        }
        _ => a == b,
    };
    let is_same = |a: &str, b: &str| {
        let (x, y) = (words(a), words(b));
        x.len() == y.len() && x.iter().zip(&y).all(|(x, y)| is_near(x, y))
    };
    if is_sample {
        let missing = new.iter().find(|b| !old.iter().any(|a| is_same(a, b)));
        return missing.map(|b| format!("no line of the table reads \"{b}\""));
    }
    let other = old.iter().zip(&new).find(|(a, b)| !is_same(a, b));
    other.map(|(a, b)| format!("\"{a}\" should read \"{b}\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_may_differ_a_little_and_words_not() {
        let difference = |old: &str, new: &str| super::difference(old, new, false);
        let old = "| core | n |\n| m4 | 1000 |\n\nCompiler: rustc 1.0.\n";
        assert_eq!(difference(old, old), None);
        assert_eq!(difference(old, &old.replace("1000", "1009")), None);
        assert!(difference(old, &old.replace("1000", "1020")).is_some());
        assert!(difference(old, &old.replace("m4", "m7")).is_some());
        assert!(difference(old, &old.replace("| m4 | 1000 |\n", "")).is_some());
        let other = old.replace("1.0", "1.1");
        assert_eq!(difference(old, &other.replace("1000", "1100")), None);
        assert!(difference(old, &other.replace("1000", "1300")).is_some());
        assert!(difference("| m4 | 0 |\n", "| m4 | 1 |\n").is_some());
    }

    #[test]
    fn a_sample_has_lines_of_the_table() {
        let old = "| core | n |\n| m4 | 1000 |\n| m7 | 2000 |\n";
        assert_eq!(difference(old, "| core | n |\n| m7 | 2001 |\n", true), None);
        assert!(difference(old, "| core | n |\n| m7 | 1000 |\n", true).is_some());
        assert!(difference(old, "| core | n |\n| m0 | 2000 |\n", true).is_some());
    }
}
