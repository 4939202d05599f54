//! Images of two cameras of which some are missing, and the names that say which belong together.

use super::odometry::walk;
use super::support::{Bench, stereo, text};
use std::fs;

#[test]
fn frames_without_a_partner_are_named() {
    let bench = Bench::new();
    let street = walk(&bench, "5");
    fs::remove_file(bench.path("street/left/000001.png")).expect("a frame");
    fs::remove_file(bench.path("street/right/000003.png")).expect("a frame");
    let [calib, out] = [format!("{street}/calib.txt"), bench.path("out").display().to_string()];
    let [left, right] = ["left", "right"].map(|side| format!("{street}/{side}"));
    let refused = |named: &str| {
        bench.refused(&["replay", "--from", &street, "--disparities", "32", "--out", &out], named);
        bench.refused(&["record", "--left", &left, "--right", &right, "--out", &out], named);
        bench.refused(&["odometry", "--sequence", &street, "--calib", &calib, "--out", &out], named);
    };
    refused("left/000003.png: has no partner in");
    // The same where the cameras have a letter.
    for (side, letter) in [("left", 'L'), ("right", 'R')] {
        for file in fs::read_dir(bench.path("street").join(side)).expect("a folder") {
            let path = file.expect("a file").path();
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            fs::rename(&path, path.with_file_name(format!("{letter}_{name}"))).expect("another name");
        }
    }
    refused("left/L_000003.png: has no partner in");
    fs::remove_file(bench.path("street/left/L_000003.png")).expect("a frame");
    refused("right/R_000001.png: has no partner in");
}

#[test]
fn folders_and_patterns_are_taken_alike() {
    let bench = Bench::new();
    let street = walk(&bench, "2");
    let file = |name: &str| bench.path(name).display().to_string();
    let [left, right] = ["left", "right"].map(|side| format!("{street}/{side}"));
    let [lefts, rights] = [&left, &right].map(|folder| format!("{folder}/*.png"));
    for (name, left, right) in
        [("a.lines", &left, &right), ("b.lines", &lefts, &rights), ("c.lines", &left, &rights)]
    {
        let run = stereo(["record", "--left", left, "--right", right, "--out", &file(name)]);
        assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
        assert!(fs::read(bench.path("a.lines")).expect("it") == fs::read(bench.path(name)).expect("it"));
    }
    let calib = format!("{street}/calib.txt");
    fs::copy(format!("{left}/000000.png"), format!("{left}/000001.png")).expect("room");
    for images in [&left, &lefts] {
        let structure = ["structure", "--images", images, "--calib", &calib, "--out", &file("seen")];
        bench.refused(&structure, "has not moved");
    }
    let calibrate = |left: &str, named: &str| {
        let all = ["calibrate", "--left", left, "--right", &right, "--pattern", "6x5", "--square-mm", "30"];
        bench.refused(&[&all[..], &["--out", &file("stereo.yml")]].concat(), named);
    };
    calibrate(&left, "0 views are too few");
    fs::create_dir(bench.path("empty")).expect("a folder");
    calibrate(&file("empty"), "empty: holds no image");
}
