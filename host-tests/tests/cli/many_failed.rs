//! `stereo match` on many pairs, one of which cannot be matched.

use super::many::{at, pairs};
use super::support::{Bench, names, stereo, text};
use std::fs;

#[test]
fn a_pair_that_cannot_be_matched_is_named_and_the_others_are_matched() {
    let bench = Bench::new();
    pairs(&bench);
    let whole = fs::read(bench.path("frames/left/f9.png")).expect("an image");
    let cut = |name: &str| bench.put(&format!("frames/left/{name}.png"), &whole[..whole.len() / 2]);
    cut("f9");
    let [left, right, out] = ["frames/left", "frames/right", "out"].map(|name| at(&bench, name));
    let args = ["match", "--left", &left, "--right", &right, "--out", &out, "--disparities", "32"];
    let run = stereo(args);
    let told = text(&run.stderr);
    assert_eq!(run.status.code(), Some(1), "{told}");
    assert!(told.ends_with("stereo: 1 of 3 pairs have no results: 000002\n"), "{told}");
    let is_named = |line: &str| {
        line.starts_with("stereo: 000002: ") && line.contains("f9.png") && line.contains("truncated")
    };
    assert!(told.lines().any(is_named), "{told}");
    assert_eq!(names(&bench.path("out")), ["000001", "000003", "frames.csv"]);
    let table = fs::read_to_string(bench.path("out/frames.csv")).expect("a table");
    let lines: Vec<_> = table.lines().collect();
    assert!(lines.len() == 4 && lines[2].contains(",,,,") && lines[2].contains("truncated"), "{table}");
    bench.put("frames/left/f9.png", &whole);
    let told = text(&stereo(args).stderr);
    assert!(told.contains("000002 of 3 is being") && told.contains("000003 of 3 is there already"), "{told}");

    // What an earlier run had of a pair that fails is said to be of that one.
    cut("f9");
    let told = text(&stereo(args).stderr);
    assert!(told.contains("000002: is of an earlier run, not in frames.csv"), "{told}");
    bench.put("frames/left/f9.png", &whole);

    // What is wrong with the command line is wrong for all.
    let usage = stereo(args.into_iter().chain(["--depth-unit", "1/256"]));
    let told = text(&usage.stderr);
    assert!(usage.status.code() == Some(2) && told.contains("--depth-unit: is of depths"), "{told}");

    // What the first one fails of the others are not tried for.
    cut("f2");
    let other = at(&bench, "other");
    let run = stereo(["match", "--left", &left, "--right", &right, "--out", &other, "--disparities", "32"]);
    let told = text(&run.stderr);
    assert_eq!((run.status.code(), told.lines().count()), (Some(1), 2), "{told}");
    assert!(told.lines().last().is_some_and(|line| line.starts_with("stereo: 000001: ")), "{told}");
    assert!(!bench.path("other").exists());
}
