//! The commands of the chapters, run in a scratch folder in the order of reading: what they write are the
//! book's pictures, and what they print stands below them.

use super::chapters::CHAPTERS;
use crate::steps::{Failure, Outcome};
use std::path::{Path, PathBuf};
use std::process::Command;

/// What begins a line that runs the program.
const STEREO: &str = "cargo run --release -- ";
/// What else may stand in a block that is run.
const ALSO: [&str; 2] = ["mkdir ", "cp "];
/// What begins a comment that asks for a figure, `FILE | CAPTION` after it, and one that asks for what was
/// printed.
pub const FIGURE: &str = "<!-- figure: ";
pub const OUTPUT: &str = "<!-- output -->";

/// What came of the commands.
pub struct Ran {
    folder: PathBuf,
    /// For each chapter what each of its blocks printed.
    printed: Vec<Vec<String>>,
}

impl Ran {
    /// What each block of a chapter printed, in their order; nothing for one that is not run.
    pub fn of(&self, chapter: usize) -> &[String] {
        self.printed.get(chapter).map_or(&[], Vec::as_slice)
    }

    /// Where a command wrote a file.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }
}

/// The `sh` blocks of a chapter.
fn blocks(text: &str) -> Vec<String> {
    let mut blocks = Vec::new();
    let mut lines = text.lines();
    while lines.by_ref().any(|line| line == "```sh") {
        let block = lines.by_ref().take_while(|line| *line != "```");
        blocks.push(block.map(|line| format!("{line}\n")).collect());
    }
    blocks
}

/// A block as a script for a shell whose `$0` is the program; nothing for one that runs other things.
fn script(block: &str) -> Option<String> {
    let line = |line: &str| {
        let own = line.strip_prefix(STEREO).map(|rest| format!("\"$0\" {rest}\n"));
        own.or_else(|| ALSO.iter().any(|word| line.starts_with(word)).then(|| format!("{line}\n")))
    };
    block.lines().map(line).collect()
}

/// Runs the blocks of every chapter that shows what comes of them.
pub fn run_all(stereo: &Path, folder: &Path, texts: &[String]) -> Outcome<Ran> {
    let mut printed = Vec::new();
    for (chapter, text) in CHAPTERS.iter().zip(texts) {
        let is_shown = text.contains(FIGURE) || text.contains(OUTPUT);
        let mut of_chapter = Vec::new();
        for block in blocks(text) {
            let script = script(&block).filter(|_| is_shown);
            let run = |script: String| run(stereo, folder, &script);
            let text = script.map(run).transpose();
            let named = |e: Failure| Failure::new(format!("{}: {e}", chapter.file));
            of_chapter.push(text.map_err(named)?.unwrap_or_default());
        }
        printed.push(of_chapter);
    }
    Ok(Ran { folder: folder.into(), printed })
}

fn run(stereo: &Path, folder: &Path, script: &str) -> Outcome<String> {
    let failed = |e: &dyn std::fmt::Display| Failure::new(format!("{}: {e}", script.trim()));
    let mut shell = Command::new("sh");
    shell.args(["-e", "-c", script]).arg(stereo).current_dir(folder);
    let output = shell.output().map_err(|e| failed(&e))?;
    if !output.status.success() {
        return Err(failed(&String::from_utf8_lossy(&output.stderr).trim()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_that_run_the_program_are_scripts() {
        let text = "a\n```sh\ncargo run --release -- demo --out demo\nmkdir x\n```\n```rust\nlet a;\n```\n\
                    ```sh\ncmake --build out\n```\n";
        let found = blocks(text);
        assert_eq!(found.len(), 2);
        assert_eq!(script(&found[0]).as_deref(), Some("\"$0\" demo --out demo\nmkdir x\n"));
        assert_eq!(script(&found[1]), None);
    }
}
