//! A copy of the tree with all mutants in it, and its test programs.

use super::Test;
use super::weave::{Mutant, Spot, weave};
use crate::steps::{Failure, Outcome, command, output_of, root, target_dir};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What is put into the crate: the number of the mutant that runs, read before `main`. What runs while the
/// crate is compiled has no mutant.
const CHOICE: &str = r#"
extern crate std;
#[allow(missing_docs, unsafe_code)]
pub mod mutant {
    use core::sync::atomic::{AtomicU32, Ordering};
    static CHOSEN: AtomicU32 = AtomicU32::new(u32::MAX);
    extern "C" fn choose() {
        let chosen = std::env::var("STEREOPSIS_MUTANT").ok().and_then(|number| number.parse().ok());
        CHOSEN.store(chosen.unwrap_or(u32::MAX), Ordering::Relaxed);
    }
    #[used]
    #[unsafe(link_section = ".init_array")]
    static CHOOSE: extern "C" fn() = choose;
    const fn never(_: u32) -> bool {
        false
    }
    #[inline(always)]
    fn is_chosen(number: u32) -> bool {
        CHOSEN.load(Ordering::Relaxed) == number
    }
    #[inline(always)]
    pub const fn on(number: u32) -> bool {
        core::intrinsics::const_eval_select((number,), never, is_chosen)
    }
}
"#;
/// What [`CHOICE`] asks of the compiler, and mutants, whose constants may overflow.
const FEATURES: &str = "#![feature(core_intrinsics, const_eval_select)]\n\
                        #![allow(internal_features, arithmetic_overflow, unconditional_panic)]\n";

/// The mutants, and the programs that they are in.
pub struct Tree {
    /// Those that a program can run.
    pub woven: BTreeSet<u32>,
    /// Those that the compiler refuses.
    pub refused: BTreeSet<u32>,
    /// Those that cannot be woven.
    pub left_out: BTreeSet<u32>,
    /// The test programs by their names.
    built: Vec<(String, PathBuf)>,
}

/// A test program, and the words in the names of the tests that it is to run.
pub struct Program {
    pub path: PathBuf,
    pub words: &'static [&'static str],
}

impl Tree {
    /// The program of a test.
    pub fn program(&self, test: &Test) -> Outcome<Program> {
        let path = self.built.iter().find(|(name, _)| name == test.name).map(|(_, path)| path.clone());
        let path =
            path.ok_or_else(|| Failure::new(format!("{} has no test program {}", test.package, test.name)))?;
        Ok(Program { path, words: test.words })
    }
}

/// Weaves mutants into a copy of the tree and builds the test programs there.
pub fn build(mutants: &[Mutant], tests: &[&Test]) -> Outcome<Tree> {
    let folder = root().join(target_dir()).join("mutants");
    let tree = folder.join("tree");
    let files: BTreeSet<&str> = mutants.iter().map(|mutant| mutant.file.as_str()).collect();
    copy(&tree, &files)?;
    let (mut refused, mut left_out) = (BTreeSet::new(), BTreeSet::new());
    loop {
        let mut spots: BTreeMap<&str, Vec<Spot>> = BTreeMap::new();
        for &file in &files {
            let numbered = (0..)
                .zip(mutants)
                .filter(|(number, mutant)| mutant.file == file && !refused.contains(number));
            let source = read(&root().join(file))?;
            let woven = weave(&source, &numbered.collect::<Vec<_>>());
            let woven = woven.map_err(|e| Failure::new(format!("{file}: {e}")))?;
            write(&tree.join(file), &woven.text)?;
            spots.insert(file, woven.spots);
            left_out.extend(woven.left_out);
        }
        let wrong = wrong(&tree, &folder, &spots)?;
        if wrong.is_empty() {
            break;
        }
        println!("{} mutants are refused by the compiler", wrong.len());
        refused.extend(wrong);
    }
    let woven = (0..mutants.len() as u32).filter(|n| !refused.contains(n) && !left_out.contains(n)).collect();
    let built = programs(&tree, &folder, tests)?;
    Ok(Tree { woven, refused, left_out, built })
}

/// Copies what git knows of the tree but the files of mutants; what is as it was keeps its time.
fn copy(tree: &Path, woven: &BTreeSet<&str>) -> Outcome {
    for file in output_of(&mut command("git", &["ls-files"]))?.lines() {
        let from = root().join(file);
        if from.is_file() && file != "src/lib.rs" && !woven.contains(file) {
            write_bytes(
                &tree.join(file),
                &fs::read(&from).map_err(|e| Failure::new(format!("{file}: {e}")))?,
            )?;
        }
    }
    let library = read(&root().join("src/lib.rs"))?;
    let inner = library.find("#![no_std]").ok_or_else(|| Failure::new("src/lib.rs: no #![no_std]"))?;
    write(&tree.join("src/lib.rs"), &[&library[..inner], FEATURES, &library[inner..], CHOICE].concat())
}

/// Cargo in the copy, with its own products.
fn cargo(tree: &Path, folder: &Path, words: &[&str]) -> Command {
    let mut cargo = command("cargo", words);
    cargo.current_dir(tree).env("CARGO_TARGET_DIR", folder.join("target"));
    cargo.env("RUSTC_BOOTSTRAP", "stereopsis");
    cargo
}

/// The mutants that the compiler's errors stand in.
fn wrong(tree: &Path, folder: &Path, spots: &BTreeMap<&str, Vec<Spot>>) -> Outcome<BTreeSet<u32>> {
    let words = ["check", "--locked", "-p", "stereopsis", "--features", "ffi", "--message-format", "json"];
    let check = cargo(tree, folder, &words).output();
    let check = check.map_err(|e| Failure::new(format!("cargo check: {e}")))?;
    let mut wrong = BTreeSet::new();
    let mut last = String::new();
    for line in String::from_utf8_lossy(&check.stdout).lines() {
        let Ok(message) = serde_json::from_str::<Value>(line) else { continue };
        let message = &message["message"];
        if message["level"] != "error" {
            continue;
        }
        last = message["rendered"].as_str().unwrap_or_default().replace('\n', " ");
        for span in message["spans"].as_array().into_iter().flatten() {
            let at = span["byte_start"].as_u64().unwrap_or_default() as usize;
            let Some(spots) = span["file_name"].as_str().and_then(|file| spots.get(file)) else { continue };
            // The text of the mutant; where an error shows in what it stands beside, the innermost of them.
            let of = |range: fn(&Spot) -> &Range<usize>| spots.iter().rfind(|spot| range(spot).contains(&at));
            let found = of(|spot| &spot.mutant).or_else(|| of(|spot| &spot.code));
            wrong.extend(found.map(|spot| spot.number));
        }
    }
    if !check.status.success() && wrong.is_empty() {
        let said = String::from_utf8_lossy(&check.stderr);
        return Err(Failure::new(format!(
            "cargo check of the mutants: {last} {}",
            said.lines().last().unwrap_or("")
        )));
    }
    Ok(wrong)
}

/// Builds the test programs: those of several packages at once, so that none builds what another one needs
/// with other features.
fn programs(tree: &Path, folder: &Path, tests: &[&Test]) -> Outcome<Vec<(String, PathBuf)>> {
    let (own, others): (Vec<_>, Vec<_>) = tests.iter().copied().partition(|test| test.name == Test::OWN);
    let mut built = Vec::new();
    for group in [others, own] {
        let mut build = cargo(tree, folder, &["test", "--locked", "--no-run", "--message-format", "json"]);
        let packages: BTreeSet<_> = group.iter().map(|test| test.package).collect();
        build.args(packages.iter().flat_map(|package| ["-p", package]));
        let names: BTreeSet<_> = group.iter().map(|test| test.name).collect();
        for name in names {
            if name == Test::OWN {
                build.arg("--lib")
            } else {
                build.args(["--test", name])
            };
        }
        if group.is_empty() {
            continue;
        }
        // What the compiler says meanwhile goes to the terminal.
        let output = build.stderr(Stdio::inherit()).output();
        let output = output.map_err(|e| Failure::new(format!("cargo test --no-run: {e}")))?;
        if !output.status.success() {
            return Err(Failure::new("the test programs do not build"));
        }
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        for message in text.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok()) {
            let is_own = message["profile"]["test"] == true && message["target"]["kind"][0] != "test";
            let name = if is_own { Some(Test::OWN) } else { message["target"]["name"].as_str() };
            if let (Some(name), Some(path)) = (name, message["executable"].as_str()) {
                built.push((name.to_owned(), PathBuf::from(path)));
            }
        }
    }
    Ok(built)
}

fn read(path: &Path) -> Outcome<String> {
    fs::read_to_string(path).map_err(|e| Failure::new(format!("{}: {e}", path.display())))
}

fn write(path: &Path, text: &str) -> Outcome {
    write_bytes(path, text.as_bytes())
}

/// Writes a file unless it is so already.
fn write_bytes(path: &Path, bytes: &[u8]) -> Outcome {
    if fs::read(path).is_ok_and(|there| there == bytes) {
        return Ok(());
    }
    let made = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(path, bytes));
    made.map_err(|e| Failure::new(format!("{}: {e}", path.display())))
}
