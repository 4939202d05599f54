//! `stereo walk`: what it refuses.

use super::support::{Bench, names};
use std::fs;

#[test]
fn frames_of_others_are_left_alone() {
    let bench = Bench::new();
    fs::create_dir_all(bench.path("mine/left")).expect("folders");
    bench.put("mine/left/000007.png", b"a frame");
    let mine = bench.path("mine").display().to_string();
    bench.refused(&["walk", "--frames", "3", "--width", "160", "--out", &mine], "did not write");
    assert_eq!(names(&bench.path("mine/left")), ["000007.png"]);
}
