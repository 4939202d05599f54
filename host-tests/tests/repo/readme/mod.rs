//! README.md holds: its commands work word for word in a fresh clone, and its figures are those of this tree.

mod commands;
mod generated;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The repository's root.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("host-tests stands below the root")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// `cargo xtask readme` runs this one with `STEREOPSIS_README=write`: then the parts are written instead.
#[test]
fn generated_parts_are_those_of_this_tree() {
    let path = root().join("README.md");
    let readme = read(&path);
    let current = generated::splice(&readme).unwrap_or_else(|e| panic!("README.md: {e}"));
    let pictures = [(generated::PICTURE, generated::picture()), (generated::DISPLAY, generated::display())];
    if std::env::var("STEREOPSIS_README").as_deref() == Ok("write") {
        for (place, picture) in &pictures {
            let path = root().join(place);
            fs::create_dir_all(path.parent().expect("a folder")).expect("the picture's folder");
            fs::write(&path, generated::as_png(picture)).expect("the picture");
        }
        fs::write(&path, current).expect("README.md");
        return;
    }
    let differs = readme.lines().zip(current.lines()).find(|(old, new)| old != new);
    assert!(readme == current, "README.md is not current, run `cargo xtask readme`: {differs:?}");
    for (place, picture) in &pictures {
        let path = root().join(place);
        let stored = image::open(&path).unwrap_or_else(|e| panic!("{place}: {e}")).into_rgb8();
        assert!(stored == *picture, "{place} is not current, run `cargo xtask readme`");
        let bytes = fs::metadata(&path).expect("the picture").len();
        assert!(bytes < 150_000, "{place} has {bytes} bytes");
    }
}

/// What is committed is cloned as a user would, and every `sh` block of its README is run there.
///
/// `cargo xtask test` runs it, which installs the programs that README.md names.
#[test]
#[ignore = "builds a clone for the host and for boards; needs CMake, QEMU and compilers for C"]
fn commands_work_in_a_fresh_clone() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let clone = folder.path().join(commands::CLONE);
    let mut git = Command::new("git");
    git.args(["clone", "--quiet"]).arg(root()).arg(&clone);
    let status = git.status().expect("git is needed: the repository is cloned");
    assert!(status.success(), "git clone: {status}");
    let readme = read(&clone.join("README.md"));

    let blocks = commands::blocks(&readme);
    for program in commands::programs(&blocks.concat()) {
        let missing = "is not installed; `cargo xtask test` installs it";
        assert!(is_installed(program), "README.md runs {program}, which {missing}");
    }
    assert!(read(&clone.join(".cargo/config.toml")).contains("run --locked --quiet --release "), "see run()");
    for block in &blocks {
        run(block, &clone);
    }
    let all = blocks.concat();
    assert!(
        all.contains(" demo ") && all.contains(" match "),
        "README.md runs neither demo nor match:\n{all}"
    );

    let outs: Vec<PathBuf> = commands::out_folders(&all).iter().map(|out| clone.join(out)).collect();
    let promised = commands::promised_files(&readme);
    assert!(promised.len() > 5, "README.md names few files: {promised:?}");
    let there = |name: &String| clone.join(name).is_file() || outs.iter().any(|out| out.join(name).is_file());
    let missing: Vec<_> = promised.iter().filter(|name| !there(name)).collect();
    assert!(missing.is_empty(), "README.md names files that its commands do not write: {missing:?}");
}

/// Whether the shell finds a program.
fn is_installed(program: &str) -> bool {
    let found = Command::new("sh").args(["-c", "command -v \"$0\"", program]).output().expect("sh");
    found.status.success()
}

/// Runs a block's lines in one shell, which ends at the first that fails.
fn run(block: &str, clone: &Path) {
    // The build products go where this test's own are: the dependencies are built once. The clone's packages
    // take the places of this tree's, so its commands are all of the release profile, of which no test
    // is.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target folder");
    let mut shell = Command::new("sh");
    shell.args(["-e", "-x", "-c", block]).current_dir(clone).env("CARGO_TARGET_DIR", target);
    let output = shell.output().expect("sh");
    let told =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "a block of README.md failed, {}:\n{block}\n{told}", output.status);
}
