//! The table of the matcher's stages names what a row's two functions call, in their order.

use crate::source;

const FILE: &str = "src/matching/stages/mod.rs";

/// The calls that the table lists, each once where it has several lines.
fn listed(text: &str) -> Vec<String> {
    let table = text.lines().skip_while(|line| !line.starts_with("//! stage ")).skip(1);
    let names = table.take_while(|line| !line.starts_with("//! ```")).filter_map(|line| {
        let name = line.trim_start_matches("//! ").split_whitespace().next()?;
        Some(name.trim_end_matches(':').to_owned()).filter(|name| name.contains("::"))
    });
    let mut names: Vec<_> = names.collect();
    names.dedup();
    names
}

/// The calls of `step` and `finish_row`, without those that only show what there is.
fn called(text: &str) -> Vec<String> {
    let lines = text.lines().skip_while(|line| !line.starts_with("fn step<"));
    let names = lines.filter_map(|line| {
        let call = line.trim().split_once('(')?.0;
        let name = call.split("::<").next()?;
        let (module, function) = name.split_once("::")?;
        let is_name = |part: &str| part.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
        (is_name(module) && is_name(function) && module != "traced").then(|| name.to_owned())
    });
    names.collect()
}

#[test]
fn the_table_of_stages_is_in_running_order() {
    let text = source::text(FILE);
    let called = called(&text);
    assert!(called.len() > 20, "{called:?}");
    assert_eq!(listed(&text), called, "{FILE}: the table beside the calls");
}

/// The check above, on a table that lacks a call.
#[test]
fn a_stage_that_the_table_lacks_is_seen() {
    let text = "//! stage  reads\n//! a::b  x\n//! S::c: d  y\n//! S::c: e  z\n//! mask  w\n//! ```\n\
                fn step<S>(f: F) {\n    if let Some(n) = y.checked_sub(S::R) {\n        a::b(f);\n    }\n    \
                S::c::<M>(f);\n    traced::d(f);\n    finish_row(f);\n}\n\
                fn finish_row(f: F) {\n    g::h(f);\n}\n";
    assert_eq!(listed(text), ["a::b", "S::c"]);
    assert_eq!(called(text), ["a::b", "S::c", "g::h"]);
}
