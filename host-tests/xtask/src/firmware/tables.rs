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
/// How far a percentage may lie from the figures', however small it is: a share moves with the other ones.
const WITHIN_PERCENT: f64 = 0.5;

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
    let compiler = |text: &str| text.lines().find(|line| line.starts_with("Compiler: ")).map(str::to_owned);
    let within = if compiler(old) == compiler(new) { WITHIN } else { WITHIN_OF_ANOTHER_COMPILER };
    let (old, new) = (Line::all(old), Line::all(new));
    if !is_sample && old.len() != new.len() {
        return Some(format!("the tables have {} lines where {} are due", old.len(), new.len()));
    }
    if is_sample {
        let missing = new.iter().find(|b| !old.iter().any(|a| a.is_near(b, within)));
        return missing.map(|b| format!("no line of the table reads \"{}\"", b.text));
    }
    let other = old.iter().zip(&new).find(|(a, b)| !a.is_near(b, within));
    other.map(|(a, b)| format!("\"{}\" should read \"{}\"", a.text, b.text))
}

/// A line of a part.
struct Line<'a> {
    text: &'a str,
    /// Its words and, of each, whether the cell or the head of its column says that it is a percentage.
    words: Vec<(&'a str, bool)>,
}

impl<'a> Line<'a> {
    /// The lines of a part, but for empty ones and the compiler's.
    fn all(part: &'a str) -> Vec<Self> {
        let lines = part.lines().filter(|line| !line.trim().is_empty() && !line.starts_with("Compiler: "));
        let mut lines = lines.peekable();
        let (mut all, mut heads) = (Vec::new(), Vec::new());
        while let Some(text) = lines.next() {
            if lines.peek().is_some_and(|below| below.starts_with("| ---")) {
                heads = text.split('|').collect();
            }
            let heads = heads.iter().copied().chain(std::iter::repeat(""));
            let words = text.split('|').zip(heads).flat_map(|(cell, head)| {
                let is_percentage = [cell, head].iter().any(|text| text.contains('%'));
                // A line of another number of cells is another line.
                cell.split_whitespace().chain(["|"]).map(move |word| (word, is_percentage))
            });
            all.push(Self { text, words: words.collect() });
        }
        all
    }

    /// Whether the words are the same, and the figures by as much as they may differ.
    fn is_near(&self, other: &Self, within: f64) -> bool {
        let mut both = self.words.iter().zip(&other.words);
        self.words.len() == other.words.len()
            && both.all(|(&(a, is_percentage), &(b, _))| is_near(a, b, within, is_percentage))
    }
}

/// Whether two words are the same, or figures that differ by a share of them at most, or by one unit of the
/// last digit behind the point.
fn is_near(a: &str, b: &str, within: f64, is_percentage: bool) -> bool {
    let (Ok(x), Ok(y)) = (a.parse::<f64>(), b.parse::<f64>()) else { return a == b };
    let digits = a.split_once('.').map_or(0, |(_, digits)| digits.len());
    let unit = if digits == 0 { 0.0 } else { 0.1_f64.powi(digits as i32) };
    let least = if is_percentage { unit.max(WITHIN_PERCENT) } else { unit };
    // A decimal is a number of two powers, and a hair beside it.
    (x - y).abs() <= (within * x.abs().max(y.abs())).max(1.001 * least)
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
    fn small_figures_differ_by_their_last_digit_and_percentages_by_half_of_one() {
        let old = "| n | share, % | of it |\n| --- | --- | --- |\n| 1.96 | 2.5 | 9.9 % |\n\n8.5 of them.\n";
        let differs = |from: &str, to: &str| difference(old, &old.replace(from, to), false).is_some();
        assert!(!differs("1.96", "1.97") && !differs("1.96", "1.95"));
        assert!(differs("1.96", "2.46") && differs("1.96", "1.99") && differs("1.96", "1.9"));
        assert!(!differs("2.5", "3.0") && !differs("2.5", "2") && differs("2.5", "3.1"));
        assert!(!differs("9.9", "10.4") && differs("9.9", "10.5"));
        assert!(!differs("8.5", "8.6") && differs("8.5", "8.7"));
    }

    #[test]
    fn a_sample_has_lines_of_the_table() {
        let old = "| core | n |\n| m4 | 1000 |\n| m7 | 2000 |\n";
        assert_eq!(difference(old, "| core | n |\n| m7 | 2001 |\n", true), None);
        assert!(difference(old, "| core | n |\n| m7 | 1000 |\n", true).is_some());
        assert!(difference(old, "| core | n |\n| m0 | 2000 |\n", true).is_some());
    }
}
