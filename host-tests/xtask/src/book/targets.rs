//! What the links of the chapters lead to: other chapters, source files, pictures.

use super::chapters::CHAPTERS;
use super::commands::Ran;
use crate::steps::{Failure, Outcome, root};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path};

/// Files that a browser shows as they are.
const SHOWN: [&str; 2] = ["png", "svg"];

/// Where links lead, and what has to be in the book for it.
pub struct Targets<'a> {
    ran: &'a Ran,
    sources: BTreeSet<String>,
    copies: BTreeMap<String, Vec<u8>>,
}

/// The page of a source file.
pub fn page_of_source(path: &str) -> String {
    format!("source/{}.html", path.replace('/', "-"))
}

/// A path without `.` and `..`, in the folder of a chapter's file.
fn resolved(chapter: &str, link: &str) -> String {
    let folder = Path::new(chapter).parent().unwrap_or(Path::new(""));
    let mut parts: Vec<String> = Vec::new();
    for part in folder.join(link).components() {
        match part {
            Component::ParentDir => drop(parts.pop()),
            Component::Normal(name) => parts.push(name.to_string_lossy().into_owned()),
            _ => {}
        }
    }
    parts.join("/")
}

impl<'a> Targets<'a> {
    /// Of the files that the commands wrote.
    pub fn new(ran: &'a Ran) -> Self {
        Self { ran, sources: BTreeSet::new(), copies: BTreeMap::new() }
    }

    /// Where a link of a chapter leads in the book; nothing for a folder. `function` is what the link calls a
    /// function of a source file.
    pub fn link(&mut self, chapter: &str, link: &str, function: Option<&str>) -> Outcome<Option<String>> {
        if link.contains("://") || link.starts_with('#') {
            return Ok(Some(link.to_owned()));
        }
        let (file, heading) = link.split_once('#').unwrap_or((link, ""));
        let heading = if heading.is_empty() { String::new() } else { format!("#{heading}") };
        let path = resolved(chapter, file);
        if let Some(chapter) = CHAPTERS.iter().find(|chapter| chapter.file == path) {
            return Ok(Some(chapter.page() + &heading));
        }
        if root().join(&path).is_dir() {
            return Ok(None);
        }
        let place = function.map(|name| place_of(&path, name)).transpose()?;
        let page = page_of_source(&path) + &place.map_or(heading, |line| format!("#L{line}"));
        self.sources.insert(path);
        Ok(Some(page))
    }

    /// The address of a picture of the repository.
    pub fn picture(&mut self, chapter: &str, link: &str) -> Outcome<String> {
        let path = resolved(chapter, link);
        self.copy(&root().join(&path), path.rsplit('/').next().unwrap_or(&path))
    }

    /// The address of a file that a command wrote, and whether it is a picture.
    pub fn figure(&mut self, file: &str) -> Outcome<(String, bool)> {
        let ending = file.rsplit('.').next().unwrap_or_default();
        let url = self.copy(&self.ran.file(file), &file.replace('/', "-"))?;
        Ok((url, SHOWN.contains(&ending)))
    }

    fn copy(&mut self, from: &Path, name: &str) -> Outcome<String> {
        let url = format!("pictures/{name}");
        let bytes = fs::read(from).map_err(|e| Failure::new(format!("{}: {e}", from.display())))?;
        self.copies.insert(url.clone(), bytes);
        Ok(url)
    }

    /// The source files that are linked to, with their texts.
    pub fn sources(&self) -> Outcome<Vec<(String, String)>> {
        let read = |path: &String| {
            let text = fs::read_to_string(root().join(path));
            text.map(|text| (path.clone(), text)).map_err(|e| Failure::new(format!("{path}: {e}")))
        };
        self.sources.iter().map(read).collect()
    }

    /// The pictures, by their names in the book.
    pub fn into_copies(self) -> BTreeMap<String, Vec<u8>> {
        self.copies
    }
}

/// The line, from 1, of a function or a type that a link names, as `Type::function` or `function`.
fn place_of(path: &str, name: &str) -> Outcome<usize> {
    let text = fs::read_to_string(root().join(path)).map_err(|e| Failure::new(format!("{path}: {e}")))?;
    let last = name.rsplit("::").next().unwrap_or(name);
    let begins = |line: &str| {
        ["fn ", "struct ", "enum ", "trait ", "macro_rules! "].iter().any(|kind| {
            line.split_once(kind).is_some_and(|(_, rest)| {
                rest.strip_prefix(last)
                    .is_some_and(|after| !after.starts_with(|c: char| c == '_' || c.is_alphanumeric()))
            })
        })
    };
    let found = text.lines().position(|line| !line.trim_start().starts_with("//") && begins(line));
    found
        .map(|line| line + 1)
        .ok_or_else(|| Failure::new(format!("{path}: has no {name}, which a chapter names")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_those_of_the_repository() {
        assert_eq!(resolved("docs/cli.md", "../src/units.rs"), "src/units.rs");
        assert_eq!(resolved("examples/fpga/README.md", "../../docs/bits.md"), "docs/bits.md");
        assert_eq!(resolved("docs/cli.md", "focus.md"), "docs/focus.md");
    }

    #[test]
    fn a_function_is_found_by_its_name() {
        let line = place_of("src/focus/lens.rs", "ThinLens::image_distance").expect("it is there");
        let text = fs::read_to_string(root().join("src/focus/lens.rs")).expect("the file");
        assert!(text.lines().nth(line - 1).is_some_and(|line| line.contains("pub fn image_distance(")));
        assert!(place_of("src/focus/lens.rs", "ThinLens::image").is_err());
    }
}
