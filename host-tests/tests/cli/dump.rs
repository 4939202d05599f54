//! `stereo dump`: the rows of a stage beside `match`'s answers and beside one another, and what is refused.

use super::support::{Bench, FAR, HEIGHT, WIDTH, stereo, text};
use serde_json::Value;
use std::fs;
use stereopsis_host::pfm;

const STAGES: [(&str, usize); 9] = [
    ("census", 2 * WIDTH as usize),
    ("cost", 32 * WIDTH as usize),
    ("aggregated", 32 * WIDTH as usize),
    ("winner", 8 * WIDTH as usize),
    ("left-right", 2 * WIDTH as usize),
    ("subpixel", 2 * WIDTH as usize),
    ("smoothed", 2 * WIDTH as usize),
    ("checked", 4 * WIDTH as usize),
    ("final", 4 * WIDTH as usize),
];

/// The arguments of `dump` on the bench's pair.
fn arguments(bench: &Bench, stage: &str, change: &[(&str, &str)]) -> Vec<String> {
    let mut words = bench.arguments(&[&[("--stage", stage), ("--method", "sgm")], change].concat());
    words[0] = "dump".to_owned();
    words
}

/// Runs it; the bytes, and what the manifest says.
fn dumped(bench: &Bench, stage: &str, change: &[(&str, &str)]) -> (Vec<u8>, Value) {
    let run = stereo(arguments(bench, stage, change));
    assert!(run.status.success() && run.stderr.is_empty(), "{stage} {change:?}: {}", text(&run.stderr));
    let file = |kind: &str| fs::read(bench.path(&format!("out/{stage}.{kind}"))).expect("a file of the dump");
    // The text has the same elements, the lowest byte last.
    let manifest: Value = serde_json::from_slice(&file("json")).expect("JSON");
    let bytes = file("bin");
    let element = manifest["element_bytes"].as_u64().expect("a number") as usize;
    let hexadecimal = |bytes: &[u8]| bytes.iter().rev().map(|byte| format!("{byte:02x}")).collect::<String>();
    let mem = text(&file("mem"));
    let lines: Vec<_> = mem.lines().filter(|line| !line.starts_with("//")).collect();
    assert!(lines.iter().copied().eq(bytes.chunks_exact(element).map(hexadecimal)), "{stage}.mem");
    (bytes, manifest)
}

#[test]
fn every_stage_has_its_rows_and_the_last_is_what_match_answers() {
    let bench = Bench::new();
    for (stage, row) in STAGES {
        let (bytes, manifest) = dumped(&bench, stage, &[]);
        assert_eq!(bytes.len(), row * HEIGHT as usize, "{stage}");
        assert_eq!(manifest["row_crc32"].as_array().map(Vec::len), Some(HEIGHT as usize), "{stage}");
        // One row is that row of all.
        let (one, manifest) = dumped(&bench, stage, &[("--row", "20")]);
        assert!(one == bytes[20 * row..21 * row], "{stage}");
        assert_eq!(manifest["first_row"], 20, "{stage}");
    }
    let (last, _) = dumped(&bench, "final", &[]);
    bench.matched(&[("--method", "sgm"), ("--out", &bench.path("matched").display().to_string())]);
    let map = fs::read(bench.path("matched/disparity.pfm")).expect("the map");
    let answers = pfm::read(&mut map.as_slice()).expect("a map").values;
    let dumped = last.chunks_exact(4).map(|element| match u16::from_le_bytes([element[0], element[1]]) {
        u16::MAX => f32::INFINITY,
        steps => f32::from(steps) / 32.0,
    });
    assert!(dumped.eq(answers.iter().copied()), "the last stage is what `match` writes");
    assert!(answers.contains(&(FAR as f32)), "the pair has answers");
}

#[test]
fn rows_and_stages_that_are_none_are_refused() {
    let bench = Bench::new();
    bench.refused(&arguments(&bench, "census", &[("--row", "48")]), "--row 48: a row from 0 to 47");
    for bad in ["-1", "x1", "1.5", ""] {
        let arguments = arguments(&bench, "census", &[("--row", bad)]);
        bench.refused(&arguments, "for '--row <Y>': a row from 0 or all is needed");
    }
    bench.refused(&arguments(&bench, "sharpened", &[]), "the stages are census, cost");
}
