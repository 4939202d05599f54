//! The files that a command line names to be read.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// The options that name results; all others name what is read, if they name a file.
const RESULTS: [&str; 5] = ["--out", "--picture", "--states", "--report", "--csv"];
/// The folders of a pair's images in a folder.
const SIDES: [&str; 2] = ["left", "right"];
/// The endings of images.
const IMAGES: [&str; 11] = ["png", "jpg", "jpeg", "pgm", "ppm", "pnm", "pbm", "tif", "tiff", "bmp", "webp"];

/// What stands after the command's name, which may be that of a folder too.
pub fn after_command(args: impl Iterator<Item = OsString>) -> impl Iterator<Item = OsString> {
    args.skip_while(|arg| arg.to_string_lossy().starts_with('-')).skip(1)
}

/// The files that the arguments name: themselves, by a pattern, or as the images of a folder.
pub fn of(args: impl Iterator<Item = OsString>) -> Vec<PathBuf> {
    let (mut found, mut is_result) = (Vec::new(), false);
    for arg in args {
        let text = arg.to_string_lossy().into_owned();
        let value = if text.starts_with("--") {
            let (option, value) = text.split_once('=').unzip();
            is_result = RESULTS.contains(&option.unwrap_or(&text));
            value.map(PathBuf::from)
        } else {
            Some(PathBuf::from(arg))
        };
        if let Some(value) = value.filter(|_| !is_result) {
            add(&value, &mut found);
        }
    }
    found
}

fn add(path: &Path, found: &mut Vec<PathBuf>) {
    let sides = SIDES.map(|side| path.join(side));
    if path.is_file() {
        found.push(path.into());
    } else if sides.iter().any(|side| side.is_dir()) {
        sides.iter().for_each(|side| found.extend(images(side)));
    } else if path.is_dir() {
        found.extend(images(path));
    } else if let Some(pattern) = path.to_str().filter(|text| text.contains(['*', '?', '['])) {
        found.extend(glob::glob(pattern).into_iter().flatten().flatten());
    }
}

/// The images of a folder.
fn images(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let is_image = |path: &PathBuf| {
        let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
        ending.is_some_and(|ending| IMAGES.contains(&ending.as_str()))
    };
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).filter(is_image)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_is_no_input() {
        let words = |list: &[&str]| list.iter().map(OsString::from).collect::<Vec<_>>();
        for all in [&["demo", "--out", "demo"][..], &["--quiet", "demo", "--out", "demo"]] {
            let left: Vec<_> = after_command(words(all).into_iter()).collect();
            assert_eq!(left, words(&["--out", "demo"]));
        }
    }

    #[test]
    fn results_are_no_inputs() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        fs::create_dir_all(path("frames/left")).expect("a folder");
        for name in ["a.png", "b.csv", "frames/left/1.PNG", "frames/left/notes.txt", "frames/poses.txt"] {
            fs::write(path(name), "x").expect("a file");
        }
        let args = |list: &[(&str, &str)]| {
            let words = list.iter().flat_map(|(option, name)| [(*option).into(), path(name).into()]);
            of(words.collect::<Vec<OsString>>().into_iter())
        };
        assert_eq!(args(&[("--left", "a.png"), ("--out", "b.csv")]), [path("a.png")]);
        assert_eq!(args(&[("--out", "a.png"), ("--matches", "b.csv")]), [path("b.csv")]);
        assert_eq!(args(&[("--found", "a.png"), ("--csv", "b.csv")]), [path("a.png")]);
        assert_eq!(args(&[("--sequence", "frames")]), [path("frames/left/1.PNG")]);
        assert_eq!(args(&[("--left", "*.png"), ("--picture", "b.csv")]), [path("a.png")]);
        let equals = format!("--left={}", path("a.png").display());
        assert_eq!(of([equals.into()].into_iter()), [path("a.png")]);
    }
}
