//! What `match` says of a pair before it matches it.

use super::results::json;
use super::support::{Bench, stereo, text};
use stereopsis_host::scene::Scene;

/// The options of `match` for two pictures of the demonstration scene.
fn arguments(bench: &Bench, left: &str, right: &str, disparities: &str) -> Vec<String> {
    let (of_left, of_right) = Scene::demo().render();
    of_left.save(bench.path("a.png")).expect("a picture");
    of_right.save(bench.path("b.png")).expect("a picture");
    let path = |name: &str| bench.path(name).display().to_string();
    let words = ["match", "--left", &path(left), "--right", &path(right), "--disparities", disparities];
    words.map(String::from).into_iter().chain(["--out".into(), path("out")]).collect()
}

#[test]
fn swapped_cameras_are_refused_unless_forced() {
    let bench = Bench::new();
    let mut swapped = arguments(&bench, "b.png", "a.png", "64");
    bench.refused(&swapped, "exchange --left and --right");
    swapped.push("--force".into());
    let run = stereo(&swapped);
    assert!(run.status.success() && text(&run.stderr).contains("swapped"), "{}", text(&run.stderr));
    assert_eq!(json(&bench.path("out/summary.json"))["pair"]["fault"], "swapped");
}

#[test]
fn the_same_picture_twice_is_said() {
    let bench = Bench::new();
    let run = stereo(arguments(&bench, "a.png", "a.png", "64"));
    assert!(run.status.success() && text(&run.stderr).contains("same picture"), "{}", text(&run.stderr));
}

#[test]
fn a_short_search_is_said_and_auto_finds_one() {
    let bench = Bench::new();
    let run = stereo(arguments(&bench, "a.png", "b.png", "16"));
    let said = text(&run.stderr);
    let needed = json(&bench.path("out/summary.json"))["pair"]["search"].clone();
    assert!(said.contains(&format!("--min-disparity {} --disparities {}", needed[0], needed[1])), "{said}");
    let run = stereo(arguments(&bench, "a.png", "b.png", "auto"));
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let summary = json(&bench.path("out/summary.json"));
    assert_eq!((&summary["min_disparity"], &summary["disparities"]), (&needed[0], &needed[1]));
    assert!(summary["pair"]["fault"].is_null());
}
