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
    // A pose of each line would be one of another frame behind the gap.
    let truth = format!("{street}/poses.txt");
    let args = ["odometry", "--sequence", &street, "--calib", &calib, "--out", &out, "--truth", &truth];
    bench.refused(&args, "poses.txt: has 6 poses, and there are 5 frames, of which");
    let poses = fs::read_to_string(&truth).expect("poses");
    let without =
        poses.lines().enumerate().filter(|(line, _)| *line != 3).map(|(_, pose)| format!("{pose}\n"));
    bench.put("street/poses.txt", without.collect::<String>().as_bytes());
    assert!(text(&stereo(args).stdout).contains("ATE          0.0"), "{}", text(&stereo(args).stdout));
}
