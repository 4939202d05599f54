//! `stereo odometry` of frames of which some are missing.

use super::odometry::walk;
use super::support::{Bench, stereo, text};
use std::fs;

#[test]
fn missing_frames_are_named() {
    let bench = Bench::new();
    let street = walk(&bench, "6");
    for side in ["left", "right"] {
        fs::remove_file(bench.path("street").join(side).join("000003.png")).expect("a frame");
    }
    let (calib, out) = (format!("{street}/calib.txt"), bench.path("found.txt").display().to_string());
    let run = stereo(["odometry", "--sequence", &street, "--calib", &calib, "--out", &out]);
    let said = text(&run.stderr);
    assert!(run.status.success() && said.contains("missing"), "{said}");
    assert!(said.contains("000002.png and ") && said.contains("000004.png: the way"), "{said}");
}
