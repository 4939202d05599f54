//! `--obstacles` of `match` and `replay`: what is found before a small robot, as a record and as a picture,
//! in a frame and over time.

use super::results::json;
use super::support::{Bench, encode, names, stereo, text};
use image::{GrayImage, ImageFormat};
use serde_json::Value;
use std::fs;
use std::time::SystemTime;
use stereopsis_host::scene::RobotScene;

/// The robot's cameras.
const RIG: [&str; 4] = ["--focal-px", "130", "--baseline-mm", "100"];
/// The robot comes nearer to a box that is taken away then.
const APPROACH: [RobotScene; 5] = [
    RobotScene::BoxAt(1200),
    RobotScene::BoxAt(1000),
    RobotScene::BoxAt(800),
    RobotScene::Sky,
    RobotScene::Sky,
];

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
    assert!(text(&run.stdout).contains("obstacles    slow, 0."), "{}", text(&run.stdout));
    let is_coloured = picture.pixels().filter(|p| p.0[0] != p.0[1]).count();
    assert!(is_coloured > 2000, "{is_coloured} pixels");

    let page = fs::read_to_string(bench.path("out/report.html")).expect("the page");
    let said = ["<h3>Obstacles</h3>", "<figcaption>Decision: slow, 0.", "a sector that is blind</th>"];
    assert!(said.iter().all(|part| page.contains(part)), "the page shows what was found");

    // A run without it takes both files away.
    let run = stereo(arguments(&bench, &rig));
    assert!(run.status.success(), "{}", text(&run.stderr));
    for name in ["out/obstacles.json", "out/obstacles.png"] {
        assert!(!bench.path(name).exists(), "{name}");
    }
    let page = fs::read_to_string(bench.path("out/report.html")).expect("the page");
    assert!(!said.iter().any(|part| page.contains(part)), "the page shows what was not looked for");
}

#[test]
fn obstacles_need_a_calibration() {
    let bench = Bench::new();
    bench.refused(&arguments(&bench, &["--obstacles"]), "--obstacles: distances need a calibration");
}

/// Puts the frames of the approach into the folders `frames/left` and `frames/right`.
fn put_approach(bench: &Bench) {
    for (number, scene) in (1..).zip(APPROACH) {
        let (left, right) = scene.scene(3).render();
        for (side, picture) in [("left", left), ("right", right)] {
            fs::create_dir_all(bench.path("frames").join(side)).expect("a folder");
            bench.put(&format!("frames/{side}/{number}.png"), &encode(&picture, ImageFormat::Png));
        }
    }
}

/// Matches the approach into a folder; returns what is said on standard error.
fn approach(bench: &Bench, out: &str, more: &[&str]) -> String {
    let [left, right, out] = ["frames/left", "frames/right", out].map(|name| bench.path(name));
    let [left, right, out] = [left, right, out].map(|path| path.display().to_string());
    let pair = ["match", "--left", &left, "--right", &right, "--out", &out];
    let run = stereo([&pair[..], &["--disparities", "32", "--method", "block"], &RIG, more].concat());
    assert!(run.status.success(), "{}", text(&run.stderr));
    text(&run.stderr)
}

/// What was found in each frame of a folder, and over time.
fn found(bench: &Bench, out: &str) -> (Vec<Value>, String) {
    let frames = (1..=APPROACH.len()).map(|n| json(&bench.path(&format!("{out}/{n:06}/obstacles.json"))));
    let table = fs::read_to_string(bench.path(out).join("obstacles.csv")).expect("a table");
    (frames.collect(), table)
}

fn states(frame: &Value, of: &str) -> Vec<String> {
    let sectors = frame[of].as_array().expect("sectors");
    sectors.iter().map(|sector| sector["state"].as_str().expect("a state").to_owned()).collect()
}

#[test]
fn a_sequence_is_carried_and_resumed() {
    let bench = Bench::new();
    put_approach(&bench);
    approach(&bench, "out", &["--obstacles"]);
    let whole = found(&bench, "out");
    let (frames, table) = &whole;
    assert_eq!(frames.iter().map(|f| f["frame"].as_u64()).collect::<Vec<_>>(), [1, 2, 3, 4, 5].map(Some));
    // The box is held for two frames after it was seen last; the robot stays slow.
    assert_eq!(states(&frames[2], "sectors")[7], "obstacle");
    assert_eq!(states(&frames[3], "sectors")[7], "free");
    assert_eq!(states(&frames[3], "free_space")[7], "obstacle");
    let decisions: Vec<_> = frames.iter().map(|f| f["decision"]["decision"].as_str().unwrap_or("")).collect();
    assert_eq!(decisions[2..], ["slow"; 3], "{decisions:?}");
    let contacts: Vec<_> = frames[..3].iter().map(|f| f["decision"]["contact_s"].as_f64()).collect();
    assert!(contacts.is_sorted_by(|a, b| a > b) && contacts[2].is_some_and(|s| (1.4..1.7).contains(&s)));
    assert_eq!(table.lines().count(), 6, "{table}");
    assert!(table.lines().nth(3).is_some_and(|line| line.starts_with("000003,3,,0.299")), "{table}");
    let picture = image::open(bench.path("out/obstacles.png")).expect("a picture").into_rgb8();
    assert_eq!(picture.dimensions(), (16 * 12 + 4 + 16, 5 * 16));

    // An interrupted run goes on as if it had not been: the third pair and what was found are lost.
    let written = |n: usize| -> SystemTime {
        let file = bench.path(&format!("out/{n:06}/disparity.pfm"));
        fs::metadata(file).and_then(|found| found.modified()).expect("a result")
    };
    let before = [1, 2, 4, 5].map(written);
    fs::remove_dir_all(bench.path("out/000003")).expect("a folder");
    fs::remove_file(bench.path("out/000002/obstacles.json")).expect("a file");
    let told = approach(&bench, "out", &["--obstacles"]);
    assert_eq!(told.matches("is there already").count(), 4, "{told}");
    assert_eq!(before, [1, 2, 4, 5].map(written));
    assert!(found(&bench, "out") == whole);

    // Another speed, and none of it, match nothing anew.
    let told = approach(&bench, "out", &["--obstacles", "--speed", "0.05"]);
    assert_eq!(told.matches("is there already").count(), 5, "{told}");
    let slow = found(&bench, "out").0;
    assert_eq!(
        (&slow[1]["decision"]["decision"], &slow[1]["ground"]),
        (&"clear".into(), &frames[1]["ground"])
    );
    approach(&bench, "out", &[]);
    let left = names(&bench.path("out"));
    assert_eq!(left, ["000001", "000002", "000003", "000004", "000005", "frames.csv"]);
    assert!(
        !bench.path("out/000004/obstacles.json").exists() && !bench.path("out/000004/obstacles.png").exists()
    );

    // Another image in the middle changes what is carried from there on, as in a run of its own.
    for side in ["left", "right"] {
        let other = bench.path(&format!("frames/{side}"));
        fs::copy(other.join("5.png"), other.join("2.png")).expect("a file");
    }
    approach(&bench, "out", &["--obstacles"]);
    approach(&bench, "anew", &["--obstacles"]);
    assert!(found(&bench, "out") == found(&bench, "anew"));
    assert!(found(&bench, "out") != whole);
}

#[test]
fn a_replay_shows_obstacles_over_time() {
    let bench = Bench::new();
    put_approach(&bench);
    let [from, out, file] =
        ["frames", "played", "a.lines"].map(|name| bench.path(name).display().to_string());
    let search = ["--disparities", "32", "--method", "block", "--out", &out, "--obstacles"];
    let played = |from: &str| {
        let run = stereo([&["replay", "--from", from][..], &search, &RIG].concat());
        assert!(run.status.success(), "{}", text(&run.stderr));
        text(&run.stdout)
    };
    assert!(played(&from).starts_with("obstacles: clear "), "the decisions are counted");
    approach(&bench, "out", &["--obstacles"]);
    let (frames, table) = found(&bench, "out");
    for (n, frame) in (1..).zip(&frames) {
        assert_eq!(&json(&bench.path(&format!("played/{n:06}-obstacles.json"))), frame, "frame {n}");
        let [played, matched] = [format!("played/{n:06}-obstacles.png"), format!("out/{n:06}/obstacles.png")];
        let picture = |name: &str| fs::read(bench.path(name)).expect("a picture");
        assert!(picture(&played) == picture(&matched), "frame {n}");
    }
    assert_eq!(fs::read_to_string(bench.path("played/obstacles.csv")).expect("a table"), table);
    // Of a recording in which every other line is lost, all is blind.
    let sides = ["left", "right"].map(|side| bench.path("frames").join(side).display().to_string());
    let record = ["record", "--left", &sides[0], "--right", &sides[1], "--frames", "5", "--faults", "0.5"];
    assert!(stereo([&record[..], &["--out", &file]].concat()).status.success());
    assert!(played(&file).starts_with("obstacles: blind 5\n"), "{}", played(&file));
    // A replay without them takes their files away.
    let run = stereo(["replay", "--from", &from, "--disparities", "32", "--out", &out]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert!(!names(&bench.path("played")).iter().any(|name| name.contains("obstacles")));
}

#[test]
fn bad_cameras_are_blind() {
    let bench = Bench::new();
    let (left, right) = RobotScene::BoxAt(800).scene(3).render();
    let black = GrayImage::new(left.width(), left.height());
    let decided = |left: &GrayImage, right: &GrayImage, more: &[&str]| {
        for (name, picture) in [("left.png", left), ("right.png", right)] {
            bench.put(name, &encode(picture, ImageFormat::Png));
        }
        let run = stereo(arguments(&bench, &[&RIG[..], &["--obstacles"], more].concat()));
        assert!(run.status.success(), "{}", text(&run.stderr));
        json(&bench.path("out/obstacles.json"))["decision"].clone()
    };
    let covered = decided(&left, &black, &[]);
    assert_eq!((&covered["decision"], &covered["reason"]), (&"blind".into(), &"Camera".into()));
    let swapped = decided(&right, &left, &["--force"]);
    assert_eq!((&swapped["decision"], &swapped["reason"]), (&"blind".into(), &"Swapped".into()));
    // What is lower than what counts is ground.
    let low = decided(&left, &right, &["--least-height", "0.25"]);
    assert_eq!(low["decision"], "clear", "{low}");
    // The pose in place of a search.
    let given =
        decided(&left, &right, &["--camera-height", "0.3", "--camera-pitch", "8.6", "--speed", "1.3"]);
    assert_eq!(given["decision"], "stop", "{given}");
    let ground = || json(&bench.path("out/obstacles.json"))["ground"].clone();
    let number = |ground: &Value, name: &str| ground[name].as_f64().expect("a number");
    assert!((number(&ground(), "height_m") - 0.3).abs() < 1e-6, "{}", ground());
    // The height alone, with which the pitch is searched.
    let known = decided(&left, &right, &["--camera-height", "0.31", "--speed", "1.3"]);
    assert_eq!(known["decision"], "stop", "{known}");
    let ground = ground();
    assert!((number(&ground, "height_m") - 0.31).abs() < 1e-6, "{ground}");
    assert!((number(&ground, "pitch_deg") - 8.6).abs() < 1.0, "{ground}");
}

#[test]
fn options_of_obstacles_that_do_not_fit_are_named() {
    let bench = Bench::new();
    let with = |more: &[&str]| arguments(&bench, &[&RIG[..], more].concat());
    bench.refused(&with(&["--speed", "1"]), "--obstacles");
    bench.refused(&with(&["--obstacles", "--speed", "66"]), "a speed from 0 to 65 is needed");
    bench.refused(&with(&["--obstacles", "--corridor", "-1"]), "a length from 0.01 to 65 is needed");
    bench.refused(&with(&["--obstacles", "--least-height", "0"]), "a length from 0.01 to 65 is needed");
    bench.refused(&with(&["--obstacles", "--camera-pitch", "5"]), "--camera-height");
    bench.refused(&with(&["--obstacles", "--camera-height", "1", "--camera-roll", "5"]), "--camera-pitch");
    bench.refused(&with(&["--obstacles", "--camera-pitch", "29", "--camera-height", "1"]), "from -28 to 28");
    bench.refused(&with(&["--obstacles", "--settings", "fast,block"]), "cannot be used with");
    put_approach(&bench);
    let [from, out] = ["frames", "played"].map(|name| bench.path(name).display().to_string());
    let replay = ["replay", "--from", &from, "--disparities", "32", "--out", &out];
    bench.refused(&[&replay[..], &["--obstacles"]].concat(), "--obstacles: distances need a calibration");
    bench.refused(&[&replay[..], &["--calib", "x.txt"]].concat(), "--obstacles");
    let [left, right] = ["left", "right"].map(|side| bench.path("frames").join(side).display().to_string());
    let pairs = ["match", "--left", &left, "--right", &right, "--disparities", "32", "--out", &out];
    bench.refused(&[&pairs[..], &["--obstacles"]].concat(), "--obstacles: distances need a calibration");
}
