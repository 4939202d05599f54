//! The house rules that a machine can read: short files, no panics in the core, nothing of one machine, a
//! tidy root.

use crate::source::{self, end_of_item, is_sign, is_test_attribute, line, tokens, word};
use proc_macro2::TokenTree;

/// Lines of a Rust file without its tests, or of a script, at most.
const MOST_LINES: usize = 300;

/// Lines of README.md, at most: what is more belongs in docs/.
const MOST_README_LINES: usize = 130;

/// Lines of the matcher that depend on a target, at most: the choice among targets has one home.
const MOST_TARGET_LINES: usize = 41;

/// What the root may hold.
const ROOT: [&str; 18] = [
    ".cargo",
    ".ci",
    ".gitattributes",
    ".github",
    ".gitignore",
    "CHANGELOG.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "build.rs",
    "docs",
    "examples",
    "host-tests",
    "memory.x",
    "rustfmt.toml",
    "src",
];

/// Text that belongs to one machine or one mirror of packages. Written in two halves, so that this file
/// passes.
const FOREIGN: [&str; 11] = [
    concat!("/wo", "rk/"),
    concat!("/tm", "p/"),
    concat!("/ro", "ot/"),
    concat!("/fa", "rm/"),
    concat!("/ho", "me/"),
    concat!("crates", ".io"),
    concat!("static.rust", "-lang.org"),
    concat!("pypi", ".org"),
    concat!("pythonhosted", ".org"),
    concat!("npmjs", ".org"),
    concat!("deb.debian", ".org"),
];

/// Methods and macros that end in a panic.
const PANICKING_METHODS: [&str; 2] = ["unwrap", "expect"];
const PANICKING_MACROS: [&str; 5] = ["panic", "todo", "unimplemented", "unreachable", "dbg"];

/// How many lines a Rust file has before its tests.
fn lines_without_tests(text: &str) -> usize {
    text.lines().take_while(|line| line.trim() != "#[cfg(test)]").count()
}

/// Lines of code with a condition on a target.
fn target_lines(text: &str) -> usize {
    let is_condition = |line: &&str| {
        let line = line.trim_start();
        let names_a_target = ["target_", "stereopsis_"].iter().any(|what| line.contains(what));
        !line.starts_with("//") && line.contains("cfg") && names_a_target
    };
    text.lines().filter(is_condition).count()
}

/// Lines of `text` with something of one machine in them.
fn foreign(name: &str, text: &str) -> Vec<String> {
    // The lock file names where packages are indexed; cargo writes it.
    if name.ends_with("Cargo.lock") {
        return Vec::new();
    }
    let found = |line: &str| FOREIGN.iter().find(|what| line.contains(**what)).copied();
    let lines = text.lines().zip(1..);
    lines.filter_map(|(line, n)| found(line).map(|what| format!("{name}:{n}: {what}"))).collect()
}

/// Modules of a Rust file that are taken from outside of its folder.
fn modules_from_elsewhere(name: &str, text: &str) -> Vec<String> {
    let is_elsewhere = |line: &str| line.trim_start().starts_with("#[path") && line.contains("..");
    let lines = text.lines().zip(1..).filter(|(line, _)| is_elsewhere(line));
    lines.map(|(line, n)| format!("{name}:{n}: {}", line.trim())).collect()
}

/// Calls that can panic, outside `#[cfg(test)]`.
fn panics(name: &str, tokens: &[TokenTree]) -> Vec<String> {
    let mut found = Vec::new();
    let mut i = 0;
    while let Some(token) = tokens.get(i) {
        if is_sign(Some(token), '#') && is_test_attribute(tokens.get(i + 1)) {
            i = end_of_item(tokens, i + 2);
            continue;
        }
        let name_here = word(Some(token));
        let is_method =
            i > 0 && is_sign(tokens.get(i - 1), '.') && PANICKING_METHODS.contains(&name_here.as_str());
        let is_macro = is_sign(tokens.get(i + 1), '!') && PANICKING_MACROS.contains(&name_here.as_str());
        if is_method || is_macro {
            found.push(format!("{name}:{}: {name_here}", line(token)));
        }
        if let TokenTree::Group(group) = token {
            found.extend(panics(name, &group.stream().into_iter().collect::<Vec<_>>()));
        }
        i += 1;
    }
    found
}

#[test]
fn files_are_short() {
    let long = |name: &String| {
        let lines = lines_without_tests(&source::text(name));
        (lines > MOST_LINES).then(|| format!("{name}: {lines} lines without its tests, {MOST_LINES} at most"))
    };
    let files = source::files();
    let is_code = |name: &&String| [".rs", ".js", ".mjs"].iter().any(|ending| name.ends_with(ending));
    let wrong: Vec<_> = files.iter().filter(is_code).filter_map(long).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn the_readme_is_short() {
    let lines = source::text("README.md").lines().count();
    assert!(lines <= MOST_README_LINES, "README.md: {lines} lines, {MOST_README_LINES} at most");
}

#[test]
fn nothing_of_one_machine_is_written_down() {
    let wrong: Vec<_> = source::files().iter().flat_map(|name| foreign(name, &source::text(name))).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn a_package_has_its_modules_in_its_folder() {
    let files = source::files();
    let rust = files.iter().filter(|name| name.ends_with(".rs"));
    let wrong: Vec<_> = rust.flat_map(|name| modules_from_elsewhere(name, &source::text(name))).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn the_core_does_not_panic_on_its_own() {
    let files = source::core_files();
    let wrong: Vec<_> = files.iter().flat_map(|(name, text)| panics(name, &tokens(name, text))).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// What the check of combinations of features rests on.
#[test]
fn features_add_code_and_take_none_away() {
    let takes = |text: &str| text.contains("not(feature") || text.contains("not(any(feature");
    let files = source::core_files();
    let wrong: Vec<_> = files.iter().filter(|(_, text)| takes(text)).map(|(name, _)| name).collect();
    assert!(wrong.is_empty(), "code that a feature takes away: {wrong:?}");
}

#[test]
fn the_matcher_chooses_among_targets_in_one_place() {
    let files = source::core_files();
    let of_matcher = files.iter().filter(|(name, _)| name.starts_with("src/matching/"));
    let lines: usize = of_matcher.map(|(_, text)| target_lines(text)).sum();
    assert!((1..=MOST_TARGET_LINES).contains(&lines), "{lines} lines of src/matching depend on a target");
}

#[test]
fn the_root_is_tidy() {
    let files = source::files();
    let stray: Vec<_> =
        files.iter().filter(|name| !ROOT.contains(&name.split('/').next().unwrap_or(name))).collect();
    assert!(stray.is_empty(), "at the root, without a place there: {stray:?}");
}

/// The checks above, on text that breaks the rules.
mod shown_to_fail {
    use super::*;

    fn count(text: &str) -> usize {
        panics("src/x.rs", &tokens("src/x.rs", text)).len()
    }

    #[test]
    fn panics_are_found_in_code_alone() {
        assert_eq!(count("fn f() { a.unwrap(); b.expect(\"b\"); todo!() }"), 3);
        assert_eq!(
            count("fn f() { g(|| panic!(\"x\")); if a { unreachable!() } else { unimplemented!() } }"),
            3
        );
        assert_eq!(count("/// a.unwrap()\nfn f() { a.unwrap_or(0); } // todo!()"), 0);
        assert_eq!(count("#[cfg(test)]\nmod tests { fn f() { a.unwrap() } }\nfn g() { a.unwrap() }"), 1);
        assert_eq!(count("#[cfg(test)]\nuse x::y;\nfn g() { a.unwrap() }"), 1);
        assert_eq!(count("#[cfg(not(test))]\nfn g() { a.unwrap() }"), 1);
        assert_eq!(count("#[expect(dead_code)]\nfn expect() {}"), 0);
    }

    #[test]
    fn foreign_text_is_found() {
        for what in FOREIGN {
            assert_eq!(
                foreign("README.md", &format!("one\nsee {what}here")),
                [format!("README.md:2: {what}")]
            );
        }
        assert!(foreign("README.md", "a workshop, a root, a home").is_empty());
        assert!(foreign("Cargo.lock", FOREIGN[5]).is_empty());
    }

    #[test]
    fn conditions_on_targets_are_counted() {
        let text = "// cfg(stereopsis_simd)\n#[cfg(stereopsis_simd)]\n    if cfg!(target_arch = \"arm\") {\n\
                    #[cfg_attr(not(stereopsis_dsp), inline)]\n#[cfg(test)]\nuse stereopsis_x;\n";
        assert_eq!(target_lines(text), 3);
    }

    #[test]
    fn modules_from_elsewhere_are_found() {
        let text = "#[path = \"no_x86.rs\"]\nmod x86;\n    #[path = \"../queue.rs\"]\nmod queue;\n";
        assert_eq!(modules_from_elsewhere("a.rs", text), ["a.rs:3: #[path = \"../queue.rs\"]"]);
    }

    #[test]
    fn lines_are_counted_up_to_the_tests() {
        let text = format!("{}#[cfg(test)]\nmod tests {{\n{}}}\n", "// a\n".repeat(301), "// b\n".repeat(50));
        assert_eq!(lines_without_tests(&text), 301);
    }
}
