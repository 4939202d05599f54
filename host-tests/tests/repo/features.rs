//! No code of the core depends on two of its features at once. So a check of each alone and of every two
//! shows that every combination compiles: three together switch on nothing that two of them do not.
//!
//! And the crates whose types functions take and return are those that docs/firmware.md names.

use crate::source::{self, core_files, tokens};
use proc_macro2::TokenTree;
use std::collections::BTreeSet;

/// The most features that a condition names, `cfg`, `cfg_attr` and `cfg!` alike, and its line.
fn most_in_a_condition(tokens: &[TokenTree]) -> (usize, usize) {
    let mut most = (0, 0);
    for (i, token) in tokens.iter().enumerate() {
        let TokenTree::Group(group) = token else { continue };
        let inner: Vec<_> = group.stream().into_iter().collect();
        let is_condition = (1..=2).any(|back| {
            let before = i.checked_sub(back).and_then(|at| tokens.get(at));
            ["cfg", "cfg_attr"].contains(&source::word(before).as_str())
        });
        let found =
            if is_condition { (features(&inner), source::line(token)) } else { most_in_a_condition(&inner) };
        most = most.max(found);
    }
    most
}

/// How many times a feature is named.
fn features(tokens: &[TokenTree]) -> usize {
    let of_one = |(i, token): (usize, &TokenTree)| match token {
        TokenTree::Group(group) => features(&group.stream().into_iter().collect::<Vec<_>>()),
        token => {
            usize::from(source::word(Some(token)) == "feature" && source::is_sign(tokens.get(i + 1), '='))
        }
    };
    tokens.iter().enumerate().map(of_one).sum()
}

#[test]
fn no_code_depends_on_two_features() {
    let mut conditions = 0;
    for (name, text) in core_files() {
        let (most, line) = most_in_a_condition(&tokens(&name, &text));
        assert!(most < 2, "{name}:{line}: a condition on {most} features");
        conditions += most;
    }
    assert!(conditions > 50, "{conditions} files with conditions were found");
}

#[test]
fn two_features_are_found() {
    let most = |text: &str| most_in_a_condition(&tokens("x.rs", text)).0;
    assert_eq!(most("#[cfg(feature = \"a\")] fn f() {}"), 1);
    assert_eq!(most("#[cfg(all(feature = \"a\", not(feature = \"b\")))] fn f() {}"), 2);
    assert_eq!(most("mod m { fn f() -> bool { cfg!(any(feature = \"a\", feature = \"b\")) } }"), 2);
    assert_eq!(most("#[cfg_attr(feature = \"a\", derive(X))] #[cfg(feature = \"b\")] struct S;"), 1);
}

/// The signatures of public functions in a file.
fn signatures(text: &str) -> impl Iterator<Item = &str> {
    let starts = text.match_indices("pub fn ").chain(text.match_indices("pub const fn "));
    starts.map(|(at, _)| text[at..].split(['{', ';']).next().unwrap_or_default())
}

/// The names that a file has from a crate: `use heapless::{Vec, VecView};`, in one line.
fn from_crate<'a>(text: &'a str, name: &str) -> BTreeSet<&'a str> {
    let start = format!("use {name}::");
    let lines = text.lines().filter_map(|line| line.strip_prefix(start.as_str()));
    lines
        .flat_map(|names| names.split(|c: char| !c.is_alphanumeric()))
        .filter(|name| !name.is_empty())
        .collect()
}

/// Whether public functions of the core name a type of a crate.
fn is_public(name: &str) -> bool {
    core_files().iter().any(|(_, text)| {
        let types = from_crate(text, name);
        let mut words = signatures(text).flat_map(|s| s.split(|c: char| !c.is_alphanumeric()));
        words.any(|word| types.contains(word))
    })
}

#[test]
fn crates_in_the_interface_are_named() {
    let page = source::text("docs/firmware.md");
    let table = page.split("## Crates in the public interface").nth(1).expect("the table");
    let row =
        |name: &str| table.lines().find(|line| line.starts_with(&format!("| `{name}`"))).expect("a row");
    for name in ["nalgebra", "heapless", "libm"] {
        let is_named = row(name).contains("is one of ours");
        assert_eq!(is_public(name), is_named, "{name}: {}", row(name));
    }
}
