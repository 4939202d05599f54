//! The chapters in the order in which a newcomer reads them.

use crate::steps::{Failure, Outcome, root};
use std::fs;

/// A page of docs/, or of an example, as a chapter.
pub struct Chapter {
    /// The part that it belongs to.
    pub part: &'static str,
    /// Where it stands in the repository.
    pub file: &'static str,
    /// What it answers.
    pub summary: &'static str,
}

const fn chapter(part: &'static str, file: &'static str, summary: &'static str) -> Chapter {
    Chapter { part, file, summary }
}

const BEGIN: &str = "Begin";
const DEVICE: &str = "Onto a device";
const LOOK_UP: &str = "Look up";
const BEHIND: &str = "Behind it";

/// All chapters.
pub const CHAPTERS: [Chapter; 19] = [
    chapter(BEGIN, "docs/first-depth.md", "From a clone to a picture of depth."),
    chapter(BEGIN, "docs/metres.md", "From a calibration to metres, with how sure they are."),
    chapter(BEGIN, "docs/tuning.md", "Which setting cures what, and how to know."),
    chapter(BEGIN, "docs/numbers.md", "Every figure that the program prints, and its unit."),
    chapter(BEGIN, "docs/lecture.md", "Each equation with the function that is it."),
    chapter(DEVICE, "docs/firmware.md", "Onto a board: a camera, a pipeline in a static, rows out."),
    chapter(DEVICE, "docs/c.md", "The same from C."),
    chapter(DEVICE, "examples/fpga/README.md", "The first half of the path in gates."),
    chapter(DEVICE, "docs/library.md", "The crate as its users meet it."),
    chapter(LOOK_UP, "docs/cli.md", "All commands of the program, with their files."),
    chapter(LOOK_UP, "docs/calibration.md", "Cameras that are not rectified: boards, lenses, remaps."),
    chapter(LOOK_UP, "docs/odometry.md", "Motion, structure and bundle adjustment."),
    chapter(LOOK_UP, "docs/focus.md", "Depth by one camera whose lens moves."),
    chapter(LOOK_UP, "docs/obstacles.md", "What stands in the way, and what is not known."),
    chapter(LOOK_UP, "docs/glossary.md", "One word, one meaning, and its file."),
    chapter(BEHIND, "docs/performance.md", "Instructions, memory, flash and accuracy, with their commands."),
    chapter(BEHIND, "docs/bits.md", "The dense path in integers, for those who build it again."),
    chapter(BEHIND, "docs/assurance.md", "What shows that promises are kept."),
    chapter(BEHIND, "docs/design-notes.md", "What was tried and is not done, with its figures."),
];

/// The texts of all chapters.
pub fn read() -> Outcome<Vec<String>> {
    let text = |chapter: &Chapter| {
        fs::read_to_string(root().join(chapter.file))
            .map_err(|e| Failure::new(format!("{}: {e}", chapter.file)))
    };
    CHAPTERS.iter().map(text).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_of_docs_is_a_chapter_once() {
        let names = fs::read_dir(root().join("docs"))
            .expect("docs/")
            .map(|entry| format!("docs/{}", entry.expect("an entry").file_name().to_string_lossy()));
        let mut pages: Vec<_> = names.filter(|name| name.ends_with(".md")).collect();
        pages.push("examples/fpga/README.md".into());
        pages.sort();
        let mut chapters: Vec<_> = CHAPTERS.iter().map(|chapter| chapter.file.to_owned()).collect();
        chapters.sort();
        assert_eq!(pages, chapters);
    }

    #[test]
    fn parts_stand_together() {
        let mut parts: Vec<_> = CHAPTERS.iter().map(|chapter| chapter.part).collect();
        parts.dedup();
        assert_eq!(parts, [BEGIN, DEVICE, LOOK_UP, BEHIND]);
    }
}
