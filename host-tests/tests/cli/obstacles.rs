//! `match --obstacles`: what is found before a small robot, as a record and as a picture.

use super::results::json;
use super::support::{Bench, encode, stereo, text};
use image::ImageFormat;
use stereopsis_host::scene::RobotScene;

/// The options of a match of the robot's cameras.
fn arguments(bench: &Bench, more: &[&str]) -> Vec<String> {
    let file = |name| bench.path(name).display().to_string();
    let [left, right, out] = ["left.png", "right.png", "out"].map(file);
    let pair = ["match", "--left", &left, "--right", &right, "--disparities", "32", "--out", &out];
    pair.iter().chain(&["--method", "block"]).chain(more).map(|&word| word.to_owned()).collect()
}

#[test]
fn a_box_is_found_written_and_drawn() {
    let bench = Bench::new();
    let (left, right) = RobotScene::BoxAt(800).scene(3).render();
    for (name, picture) in [("left.png", left), ("right.png", right)] {
        bench.put(name, &encode(&picture, ImageFormat::Png));
    }
    let rig = ["--focal-px", "130", "--baseline-mm", "100"];
    let run = stereo(arguments(&bench, &[&rig[..], &["--obstacles"]].concat()));
    assert!(run.status.success(), "{}", text(&run.stderr));
    let found = json(&bench.path("out/obstacles.json"));
    assert!(found["blind"].is_null(), "{found}");
    let height_m = found["ground"]["height_m"].as_f64().expect("a ground");
    let pitch_deg = found["ground"]["pitch_deg"].as_f64().expect("a ground");
    assert!((height_m - RobotScene::HEIGHT_M).abs() < 0.01, "{height_m}");
    assert!((pitch_deg - RobotScene::PITCH_RAD.to_degrees()).abs() < 0.5, "{pitch_deg}");
    let sectors = found["sectors"].as_array().expect("sectors");
    assert_eq!(sectors.len(), 16);
    let ahead = &sectors[7];
    assert_eq!(ahead["state"], "obstacle", "{ahead}");
    let depth_m = ahead["depth_m"].as_f64().expect("a depth");
    // 0.8 m along the ground, seen by a camera that looks down from 0.3 m at a front 0.2 m high.
    assert!((depth_m - 0.82).abs() < 0.02, "{depth_m}");
    assert!((0.15..0.25).contains(&ahead["height_m"].as_f64().expect("a height")), "{ahead}");
    // Ranges go from right to left.
    let ranges = found["scan"]["ranges"].as_array().expect("ranges");
    assert_eq!(ranges[8], ahead["range_m"]);
    assert!(found["stixels"].as_array().is_some_and(|stixels| stixels.len() >= 5), "{found}");
    assert_eq!(found["decision"]["decision"], "slow", "{}", found["decision"]);
    let picture = image::open(bench.path("out/obstacles.png")).expect("a picture").into_rgb8();
    assert_eq!(picture.dimensions(), (160, 132));
    // The strip below the box is orange, that below a free sector would be green.
    assert_eq!(picture.get_pixel(78, 130).0, [0xd5, 0x5e, 0x00]);
    let is_coloured = picture.pixels().filter(|p| p.0[0] != p.0[1]).count();
    assert!(is_coloured > 2000, "{is_coloured} pixels");

    // A run without it takes both files away.
    let run = stereo(arguments(&bench, &rig));
    assert!(run.status.success(), "{}", text(&run.stderr));
    for name in ["out/obstacles.json", "out/obstacles.png"] {
        assert!(!bench.path(name).exists(), "{name}");
    }
}

#[test]
fn obstacles_need_a_calibration() {
    let bench = Bench::new();
    bench.refused(&arguments(&bench, &["--obstacles"]), "--obstacles: distances need a calibration");
}
