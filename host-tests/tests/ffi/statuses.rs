//! Every status of the header has a text, and a program in C that meets it.

use super::*;
use std::ffi::CStr;

#[test]
fn every_status_of_the_header_has_a_text() {
    let header = include_str!("../../../src/ffi/stereopsis.h");
    let codes: Vec<i32> = header
        .lines()
        .filter_map(|line| {
            line.trim().strip_prefix("STEREOPSIS_STATUS_")?.trim_end_matches(',').split_once(" = ")
        })
        .map(|(_, code)| code.parse().expect("a number"))
        .collect();
    assert!(codes.len() > 50, "the header's statuses were not found");
    // SAFETY: the texts are constants that end in a zero.
    let text = |code| unsafe { CStr::from_ptr(stereopsis_status_text(code)) };
    let unknown = text(i32::MAX);
    let named = |status: Status| status.text();
    assert_eq!((named(Status::Ok), named(Status::Null)), (c"done", c"a pointer is null"));
    assert_eq!(named(Status::Block), c"a block has 2 to 8 pixels a side");
    let (first, last) = (codes.iter().min().expect("codes"), codes.iter().max().expect("codes"));
    for beyond in [i32::MIN, i32::MIN + 1, first - 1, last + 1] {
        assert_eq!(text(beyond), unknown);
    }
    for &code in &codes {
        assert_ne!(text(code), unknown, "{code}");
        assert!(
            codes.iter().filter(|&&other| text(other) == text(code)).count() == 1,
            "{code}: {:?}",
            text(code)
        );
    }
}

#[test]
fn every_status_of_the_header_is_met_from_c() {
    let programs = [
        include_str!("misuse.c"),
        include_str!("misuse_features.c"),
        include_str!("misuse_motion.c"),
        include_str!("misuse_obstacles.c"),
        include_str!("misuse_queue.c"),
        include_str!("misuse_raw.c"),
        include_str!("misuse_two_views.c"),
        include_str!("misuse_winners.c"),
    ];
    // The last word of a line such as `EXPECT(call, STATUS);`, or the whole name.
    let text = programs.concat();
    let words: Vec<&str> = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect();
    let is_met = |name: &&str| {
        let whole = format!("STEREOPSIS_STATUS_{name}");
        text.contains(&format!(", {name});")) || words.contains(&whole.as_str())
    };
    let header = include_str!("../../../src/ffi/stereopsis.h");
    let names = header.lines().filter_map(|line| line.trim().strip_prefix("STEREOPSIS_STATUS_"));
    let names: Vec<&str> = names.filter_map(|line| line.split_once(" = ").map(|(name, _)| name)).collect();
    assert!(names.len() > 50, "the header's statuses were not found");
    let missing: Vec<&str> = names.into_iter().filter(|name| !is_met(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
