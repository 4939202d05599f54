//! Lines of Rust files and of the live page's have at most 110 columns: code, comments, strings and tables
//! alike.

use crate::source;

/// Columns of a line, at most.
const MOST_COLUMNS: usize = 110;
/// What the files end with that are looked at.
const CODE: [&str; 4] = [".rs", ".js", ".mjs", ".html"];

/// Lines of `text` that are too long.
fn long_lines(name: &str, text: &str) -> Vec<String> {
    let columns = text.lines().map(|line| line.chars().count()).zip(1..);
    columns
        .filter(|(n, _)| *n > MOST_COLUMNS)
        .map(|(n, line)| format!("{name}:{line}: {n} columns"))
        .collect()
}

#[test]
fn lines_have_at_most_110_columns() {
    let files = source::files();
    let is_code = |name: &&String| CODE.iter().any(|ending| name.ends_with(ending));
    let wrong: Vec<_> =
        files.iter().filter(is_code).flat_map(|name| long_lines(name, &source::text(name))).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn a_long_line_is_found() {
    let text = format!("{}\n{}\n// {}\n", "a".repeat(110), "é".repeat(110), "b".repeat(108));
    assert_eq!(long_lines("src/x.rs", &text), ["src/x.rs:3: 111 columns"]);
}
