//! `stereo odometry` beside a truth that has other times than the frames.

use super::odometry::walk;
use super::support::{Bench, stereo, text};
use std::fs::{self, File};
use stereopsis_host::interpolate::between;
use stereopsis_host::odometry::poses::{read, write_tum};

/// Four true poses for each frame's interval, from the given one on, and the times of the frames.
fn often(bench: &Bench, first: usize) -> [String; 2] {
    let truth = read(&bench.path("street/poses.txt")).expect("poses").poses;
    let last = 4 * (truth.len() - 1);
    let at = |i: usize| match i % 4 {
        0 => truth[i / 4],
        part => between(&truth[i / 4], &truth[i / 4 + 1], part as f64 / 4.0),
    };
    let poses: Vec<_> = (first..=last).map(at).collect();
    let times: Vec<f64> = (first..=last).map(|i| 10.0 + 0.0125 * i as f64).collect();
    let path = bench.path(&format!("often{first}.txt"));
    write_tum(&mut File::create(&path).expect("room"), &poses, &times).expect("room");
    let of_frames: String = (0..truth.len()).map(|i| format!("{:.6}\n", 10.0 + 0.05 * i as f64)).collect();
    let of_frames = bench.put("times.txt", of_frames.as_bytes());
    [path, of_frames].map(|path| path.display().to_string())
}

/// The lines of errors.
fn errors(said: &str) -> Vec<&str> {
    let is_error = |line: &&str| ["ATE", "RPE", "drift"].iter().any(|name| line.starts_with(name));
    said.lines().filter(is_error).collect()
}

#[test]
fn a_truth_of_other_times_is_taken_at_those_of_the_frames() {
    let bench = Bench::new();
    let street = walk(&bench, "6");
    let path = |name: &str| bench.path(name).display().to_string();
    let (calib, line_by_line, out) =
        (format!("{street}/calib.txt"), format!("{street}/poses.txt"), path("found.txt"));
    let arguments = ["odometry", "--sequence", &street, "--calib", &calib, "--out", &out, "--truth"];
    let beside = |more: &[&str]| stereo(arguments.iter().chain(more));
    let expected = beside(&[&line_by_line]);
    let expected = text(&expected.stdout);
    assert!(errors(&expected).len() >= 2, "{expected}");

    let [truth, times] = often(&bench, 0);
    let run = beside(&[&truth, "--times", &times]);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    assert_eq!(errors(&text(&run.stdout)), errors(&expected));

    // The first two frames, which the truth does not have.
    let [truth, times] = often(&bench, 6);
    let picture = path("way.svg");
    let run = beside(&[&truth, "--times", &times, "--picture", &picture]);
    let said = text(&run.stderr);
    assert!(run.status.success() && said.contains("note: 2 of 6 frames have no true pose"), "{said}");
    assert!(text(&run.stdout).contains("ATE          0.0"), "{}", text(&run.stdout));
    assert!(fs::read_to_string(&picture).expect("a drawing").contains(">truth<"));

    // Times are needed, those of this clock, and are of no use for lines without any.
    let refused = |more: &[&str], culprit: &str| {
        let all: Vec<&str> = arguments.iter().chain(more).copied().collect();
        bench.refused(&all, culprit);
    };
    refused(&[&truth], "has 15 poses with their times, and there are 6 frames; give --times");
    let late = bench.put("late.txt", b"100\n101\n102\n103\n104\n105\n").display().to_string();
    refused(&[&truth, "--times", &late], "has no pose near the time of any frame");
    refused(&[&line_by_line, "--times", &times], "give --format tum too");
}
