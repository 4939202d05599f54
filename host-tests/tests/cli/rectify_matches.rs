//! `stereo rectify --matches`: what wrong matches and swapped cameras do to it.

use super::support::{Bench, stereo, text};
use serde_json::Value;
use stereopsis_host::scene::Scene;

/// A pair and its matches, with so many wrong ones on their lines.
fn matches(bench: &Bench, wrong: u32) -> [String; 3] {
    let (left, right) = Scene::demo().render();
    let path = |name: &str| bench.path(name).display().to_string();
    let [left_file, right_file, found] = ["l.png", "r.png", "found.csv"].map(path);
    left.save(&left_file).expect("a picture");
    right.save(&right_file).expect("a picture");
    let run = stereo(["features", "--left", &left_file, "--right", &right_file, "--out", &found]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let mut lines = std::fs::read_to_string(&found).expect("matches");
    for i in 0..wrong {
        let (x, y) = (20 + 37 * i % 200, 30 + 53 * i % 400);
        lines += &format!("{x},{y},{},{y}\n", 400 + 41 * i % 200);
    }
    std::fs::write(&found, lines).expect("a file");
    [left_file, right_file, found]
}

/// The arguments for a pair and its matches.
fn rectify<'a>(left: &'a str, right: &'a str, matches: &'a str, out: &'a str) -> [&'a str; 9] {
    ["rectify", "--left", left, "--right", right, "--matches", matches, "--out", out]
}

#[test]
fn a_few_wrong_matches_move_nothing() {
    for wrong in [0, 1, 12] {
        let bench = Bench::new();
        let [left, right, found] = matches(&bench, wrong);
        let out = bench.path("out").display().to_string();
        let run = stereo(rectify(&left, &right, &found, &out));
        assert!(run.status.success() && run.stderr.is_empty(), "{wrong}: {}", text(&run.stderr));
        let told = std::fs::read(bench.path("out/rectified.json")).expect("rectified.json");
        let told: Value = serde_json::from_slice(&told).expect("JSON");
        let numbers = |name: &str| [0, 1].map(|i| told[name][i].as_f64().expect("a number"));
        assert!(numbers("seen").iter().all(|&seen| seen > 0.9), "{wrong}: {:?}", numbers("seen"));
        assert!(numbers("disparity_px")[1] < 64.0, "{wrong}: {:?}", numbers("disparity_px"));
    }
}

#[test]
fn swapped_cameras_are_told_by_their_matches() {
    let bench = Bench::new();
    let [left, right, found] = matches(&bench, 0);
    let lines = std::fs::read_to_string(&found).expect("matches");
    let exchanged = |line: &str| {
        let mut numbers: Vec<_> = line.split(',').collect();
        numbers.rotate_left(2);
        numbers.join(",") + "\n"
    };
    let lines: String = lines.lines().skip(1).map(exchanged).collect();
    let swapped = bench.put("swapped.csv", format!("x1,y1,x2,y2\n{lines}").as_bytes()).display().to_string();
    let out = bench.path("out").display().to_string();
    let run = stereo(rectify(&right, &left, &swapped, &out));
    let said = text(&run.stderr);
    assert!(run.status.success() && said.contains("exchange left and right"), "{said}");
}
