//! README.md and docs/ hold: their commands work word for word in a fresh clone, and their figures are those
//! of this tree.

mod commands;
mod figures;
mod generated;
mod lecture;

use crate::source;
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

/// README.md, then the pages of docs/ by name: each name with the text.
fn pages(root: &Path) -> Vec<(String, String)> {
    let folder = root.join("docs");
    let entries = fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut names: Vec<_> = entries
        .map(|entry| format!("docs/{}", entry.expect("an entry").file_name().to_string_lossy()))
        .filter(|name| name.ends_with(".md"))
        .collect();
    names.sort();
    names.insert(0, "README.md".to_owned());
    names.into_iter().map(|name| (name.clone(), read(&root.join(name)))).collect()
}

#[test]
fn links_lead_to_files_and_headings() {
    let pages = pages(root());
    let anchors = |text: &str| {
        let headings = text.lines().filter(|line| line.starts_with('#'));
        let word = |c: char| c.is_alphanumeric() || c == '-';
        let anchor = |line: &str| line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        headings.map(|line| anchor(line).chars().filter(|&c| word(c)).collect()).collect::<Vec<String>>()
    };
    let mut found = 0;
    for (name, text) in &pages {
        let folder = Path::new(name).parent().expect("a folder");
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if link.contains("://") {
                continue;
            }
            found += 1;
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let path = if file.is_empty() { root().join(name) } else { root().join(folder).join(file) };
            assert!(path.exists(), "{name}: the link {link} leads nowhere");
            let has = || anchors(&read(&path)).iter().any(|anchor| anchor == heading);
            assert!(heading.is_empty() || has(), "{name}: {link} names no heading");
        }
    }
    assert!(found > 10, "{found} links in README.md and docs/");
}

#[test]
fn the_glossary_names_files_that_are_there() {
    let text = read(&root().join("docs/glossary.md"));
    let rows: Vec<_> = text.lines().filter(|line| line.starts_with("| ") && line.contains(".rs`")).collect();
    assert!(rows.len() > 30, "{} terms in docs/glossary.md", rows.len());
    let term = |row: &str| row.split('|').nth(1).map(|term| term.trim().to_lowercase());
    assert!(rows.windows(2).all(|pair| term(pair[0]) < term(pair[1])), "docs/glossary.md is not sorted");
    for row in rows {
        let file = row.rsplit('`').nth(1).expect("a file at the end of the row");
        assert!(root().join("src").join(file).is_file(), "docs/glossary.md: there is no src/{file}");
    }
}

#[test]
fn the_lectures_equations_are_functions_that_are_there() {
    let items = lecture::items(&read(&root().join("docs/lecture.md")));
    assert!(items.len() > 25, "{} equations in docs/lecture.md", items.len());
    for item in &items {
        let links = lecture::links(item);
        assert!(item.contains('$') && !links.is_empty(), "docs/lecture.md: no function is {item}");
        for (name, file) in links {
            let text = read(&root().join("docs").join(file));
            assert!(lecture::has(file, &text, name), "docs/lecture.md: {file} has no public {name}");
        }
    }
}

#[test]
fn what_assures_is_there() {
    const FOLDERS: [&str; 4] = ["src", "host-tests/tests", "host-tests/model/tests", "host-tests/fuzz/tests"];
    let tests: Vec<_> = FOLDERS.iter().flat_map(|folder| source::rust_files(folder)).collect();
    let text = read(&root().join("docs/assurance.md"));
    let promises = text.lines().skip_while(|line| !line.starts_with("| promise"));
    let rows: Vec<_> = promises.take_while(|line| line.starts_with("| ")).skip(2).collect();
    assert!(rows.len() > 10, "{} promises in docs/assurance.md", rows.len());
    for row in rows {
        let evidence = row.split('|').nth(2).expect("a second column");
        let names: Vec<_> = evidence.split('`').skip(1).step_by(2).collect();
        assert!(!names.is_empty() || evidence.contains("step"), "docs/assurance.md: nothing shows {row}");
        for name in names {
            let is_file = FOLDERS.iter().any(|folder| root().join(folder).join(name).is_file());
            let is_test = tests.iter().any(|(_, text)| text.contains(&format!("fn {name}(")));
            let is_chore = ["cross", "firmware --", "rtl --", "fuzz", "miri", "races", "mutants", "soak"]
                .iter()
                .any(|chore| name.starts_with(chore));
            assert!(is_file || is_test || is_chore, "docs/assurance.md: there is no test {name}");
        }
    }
}

/// `cargo xtask readme` runs this one with `STEREOPSIS_README=write`: then the parts are written instead.
#[test]
fn generated_parts_are_those_of_this_tree() {
    let path = root().join("docs/performance.md");
    let text = read(&path);
    let current = generated::splice(&text).unwrap_or_else(|e| panic!("docs/performance.md: {e}"));
    let read_me = read(&root().join("README.md"));
    let mut with_figures = read_me.clone();
    figures::table(&current)
        .and_then(|table| generated::replace_part(&mut with_figures, "figures", &table))
        .unwrap_or_else(|e| panic!("README.md: {e}"));
    let pictures = [
        ("README.md", "", generated::PICTURE, generated::picture()),
        ("docs/firmware.md", "../", generated::DISPLAY, generated::display()),
    ];
    if std::env::var("STEREOPSIS_README").as_deref() == Ok("write") {
        for (_, _, place, picture) in &pictures {
            let path = root().join(place);
            fs::create_dir_all(path.parent().expect("a folder")).expect("the picture's folder");
            fs::write(&path, generated::as_png(picture)).expect("the picture");
        }
        fs::write(&path, current).expect("docs/performance.md");
        fs::write(root().join("README.md"), with_figures).expect("README.md");
        return;
    }
    assert!(read_me == with_figures, "README.md's figures are not current, run `cargo xtask readme`");
    let differs = text.lines().zip(current.lines()).find(|(old, new)| old != new);
    assert!(text == current, "docs/performance.md is not current, run `cargo xtask readme`: {differs:?}");
    for (page, to_root, place, picture) in &pictures {
        assert!(
            read(&root().join(page)).contains(&format!("]({to_root}{place})")),
            "{page} does not show {place}"
        );
        let path = root().join(place);
        let stored = image::open(&path).unwrap_or_else(|e| panic!("{place}: {e}")).into_rgb8();
        assert!(stored == *picture, "{place} is not current, run `cargo xtask readme`");
        let bytes = fs::metadata(&path).expect("the picture").len();
        assert!(bytes < 150_000, "{place} has {bytes} bytes");
    }
}

/// What is committed is cloned as a user would, and every `sh` block of README.md and docs/ is run there.
///
/// `cargo run --release` and the chores run what this test was built with: the same sources, which take
/// minutes to build once more.
///
/// `cargo xtask test` runs it, which installs the programs that they name.
#[test]
#[ignore = "builds a clone for the host and for boards; needs CMake, QEMU and compilers for C"]
fn commands_work_in_a_fresh_clone() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let clone = folder.path().join(commands::CLONE);
    let mut git = Command::new("git");
    git.args(["clone", "--quiet"]).arg(root()).arg(&clone);
    let status = git.status().expect("git is needed: the repository is cloned");
    assert!(status.success(), "git clone: {status}");
    let pages: String = pages(&clone).into_iter().map(|(_, text)| text + "\n").collect();

    let blocks = commands::blocks(&pages);
    for program in commands::programs(&blocks.concat()) {
        let missing = "is not installed; `cargo xtask test` installs it";
        assert!(is_installed(program), "README.md or docs/ run {program}, which {missing}");
    }
    for block in &blocks {
        run(block, &clone);
    }
    let all = blocks.concat();
    assert!(
        all.contains(" demo ") && all.contains(" match "),
        "README.md and docs/ run neither demo nor match:\n{all}"
    );

    let outs: Vec<PathBuf> = commands::out_folders(&all).iter().map(|out| clone.join(out)).collect();
    let promised = commands::promised_files(&pages);
    assert!(promised.len() > 5, "README.md and docs/ name few files: {promised:?}");
    let there = |name: &String| clone.join(name).is_file() || outs.iter().any(|out| out.join(name).is_file());
    let missing: Vec<_> = promised.iter().filter(|name| !there(name)).collect();
    assert!(
        missing.is_empty(),
        "README.md or docs/ name files that their commands do not write: {missing:?}"
    );
}

/// Whether the shell finds a program.
fn is_installed(program: &str) -> bool {
    let found = Command::new("sh").args(["-c", "command -v \"$0\"", program]).output().expect("sh");
    found.status.success()
}

/// The folder of this test's own build products.
fn own_target() -> &'static Path {
    Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target folder")
}

/// `cargo` for the blocks: the program and the chores of this repository, which are built.
const CARGO: &str = r#"cargo() {
    case "$*" in
    "run --release -- "*) shift 3; "$STEREO" "$@";;
    "xtask "*)
        shift
        export CARGO_TARGET_DIR=$OWN_TARGET
        (cd "$ROOT" && command cargo build --locked --quiet -p xtask)
        "$OWN_TARGET/debug/xtask" "$@";;
    *) command cargo "$@";;
    esac
}
"#;

/// Runs a block's lines in one shell, which ends at the first that fails.
fn run(block: &str, clone: &Path) {
    let mut shell = Command::new("sh");
    shell.args(["-e", "-x", "-c", &format!("{CARGO}{block}")]).current_dir(clone);
    shell.env("CARGO_TARGET_DIR", clone.join("target")).env("OWN_TARGET", own_target()).env("ROOT", root());
    shell.env("STEREO", env!("CARGO_BIN_EXE_stereo"));
    let output = shell.output().expect("sh");
    let told =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(
        output.status.success(),
        "a block of README.md or docs/ failed, {}:\n{block}\n{told}",
        output.status
    );
}
