//! `cargo xtask book`: the pages of docs/ as a book, which is read from a folder without a network.
//!
//! In: the chapters in the order of reading, and the program `stereo`. Out: a page of HTML for each chapter,
//! the pictures that the commands of the chapters write, and the source files that are linked to.
//!
//! * [`chapters`]: which pages, in which order. [`commands`]: a chapter's commands, run in a scratch folder.
//! * [`chapter`]: a chapter as HTML. [`targets`]: what its links lead to. [`layout`]: what stands around it.
//! * [`check`]: no link and no picture leads nowhere. [`look`]: how it fits a narrow window and a wide one.

mod chapter;
mod chapters;
mod check;
mod commands;
mod layout;
mod look;
mod targets;

use crate::steps::{Failure, Outcome, cargo, root, run as run_command, target_dir};
use chapters::{CHAPTERS, Chapter};
use clap::Args;
use commands::Ran;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use stereopsis_host::live::LOOK;
use targets::Targets;

/// The style of the book, after the look that every page has.
const STYLE: &str = include_str!("book.css");
/// The file that says that a folder is a book, which a new one may take the place of.
const MARK: &str = "book.css";

/// The options of `book`.
#[derive(Args)]
pub struct Arguments {
    /// The folder of the book; what it held of an earlier book is removed
    #[arg(long, value_name = "DIR", default_value = "target/book")]
    out: PathBuf,
}

/// Builds the program and writes the book.
pub fn run(arguments: &Arguments) -> Outcome {
    run_command(&mut cargo(&["build", "--locked", "--release", "-p", "stereopsis-host", "--bin", "stereo"]))?;
    let stereo =
        root().join(target_dir()).join("release/stereo").with_extension(std::env::consts::EXE_EXTENSION);
    write(&stereo, &arguments.out)?;
    println!("the book is {}", arguments.out.join("index.html").display());
    Ok(())
}

/// The test step: writes the book with a program that is built, and looks at every page in a browser.
pub fn sample(stereo: &Path) -> Outcome {
    let folder = tempfile::tempdir().map_err(|e| Failure::new(e.to_string()))?;
    let out = folder.path().join("book");
    write(stereo, &out)?;
    look::every_page_fits(&out)
}

/// Writes the book into a folder that is new or holds an earlier one, and checks it.
fn write(stereo: &Path, out: &Path) -> Outcome {
    let failed = |path: &Path, e: &dyn std::fmt::Display| Failure::new(format!("{}: {e}", path.display()));
    let is_earlier = out.join(MARK).is_file();
    let is_free = is_earlier || !out.exists() || fs::read_dir(out).is_ok_and(|mut all| all.next().is_none());
    if !is_free {
        return Err(failed(out, &"holds something else than a book; give another folder"));
    }
    let scratch = tempfile::tempdir().map_err(|e| failed(out, &e))?;
    let texts = chapters::read()?;
    let ran = commands::run_all(stereo, scratch.path(), &texts)?;
    let pages = pages(&texts, &ran)?;
    if is_earlier {
        fs::remove_dir_all(out).map_err(|e| failed(out, &e))?;
    }
    for (name, bytes) in &pages {
        let path = out.join(name);
        fs::create_dir_all(path.parent().unwrap_or(out)).map_err(|e| failed(out, &e))?;
        fs::write(&path, bytes).map_err(|e| failed(&path, &e))?;
    }
    Ok(())
}

/// All files of the book by their names, checked.
fn pages(texts: &[String], ran: &Ran) -> Outcome<BTreeMap<String, Vec<u8>>> {
    let mut targets = Targets::new(ran);
    let chapters: Vec<_> = CHAPTERS
        .iter()
        .zip(texts)
        .enumerate()
        .map(|(place, (chapter, text))| chapter::html(chapter, text, ran.of(place), &mut targets))
        .collect::<Outcome<_>>()?;
    let mut files = BTreeMap::new();
    for (place, chapter) in CHAPTERS.iter().enumerate() {
        let page = layout::chapter(&chapters, place);
        files.insert(chapter.page(), page.into_bytes());
    }
    files.insert("index.html".into(), layout::cover(&chapters).into_bytes());
    for (path, text) in targets.sources()? {
        files.insert(targets::page_of_source(&path), layout::source(&path, &text, &chapters).into_bytes());
    }
    files.extend(targets.into_copies());
    files.insert(MARK.into(), [LOOK, STYLE].concat().into_bytes());
    check::links(&files)?;
    Ok(files)
}

impl Chapter {
    /// The name of its page.
    fn page(&self) -> String {
        let stem = self.file.trim_end_matches(".md").trim_start_matches("docs/").replace('/', "-");
        format!("{stem}.html").to_lowercase()
    }
}
