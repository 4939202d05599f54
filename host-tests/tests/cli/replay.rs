//! `stereo record` and `stereo replay`: their files, and what they say when they cannot.

use super::support::{Bench, names, stereo, text};
use crate::results::json;
use serde_json::Value;
use std::fs;
use std::time::Instant;
use stereopsis_host::pfm;
use stereopsis_host::scene::Scene;
use stereopsis_host::scene::pattern::Pattern;

/// Two images of a bench, and their options.
pub fn put_pair(bench: &Bench, folders: bool) -> [String; 2] {
    let (left, right) = Pattern::Shifted { most: 12, noise_grey: 2.0 }.pair(48, 30, 5);
    let put = |side: &str, image: &image::GrayImage| {
        if !folders {
            let path = bench.path(&format!("{side}.png"));
            image.save(&path).expect("a file");
            return path.display().to_string();
        }
        let folder = bench.path("frames").join(side);
        fs::create_dir_all(&folder).expect("a folder");
        for name in ["1.png", "2.png"] {
            image.save(folder.join(name)).expect("a file");
        }
        folder.display().to_string()
    };
    [put("left", &left), put("right", &right)]
}

pub fn run(arguments: &[&str]) -> String {
    let run = stereo(arguments);
    assert!(run.status.success() && run.stderr.is_empty(), "{arguments:?}: {}", text(&run.stderr));
    text(&run.stdout).to_owned()
}

/// What a run that succeeds says on standard error.
fn notes(arguments: &[&str]) -> String {
    let run = stereo(arguments);
    assert!(run.status.success(), "{arguments:?}: {}", text(&run.stderr));
    text(&run.stderr).to_owned()
}

pub fn summary(bench: &Bench, folder: &str) -> serde_json::Value {
    let file = fs::read(bench.path(folder).join("summary.json")).expect("a summary");
    serde_json::from_slice(&file).expect("JSON")
}

pub fn disparities(bench: &Bench, name: &str) -> Vec<u32> {
    let file = fs::read(bench.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    pfm::read(&mut file.as_slice()).expect("a PFM").values.iter().map(|v| v.to_bits()).collect()
}

#[test]
fn what_is_recorded_is_played_as_match_sees_it() {
    let bench = Bench::new();
    let [left, right] = put_pair(&bench, false);
    let [file, out, matched] =
        ["a.lines", "out", "matched"].map(|name| bench.path(name).display().to_string());
    let told =
        run(&["record", "--left", &left, "--right", &right, "--frames", "3", "--fps", "50", "--out", &file]);
    assert!(told.starts_with("3 frames, 90 lines, 0 errors are in "), "{told}");
    for method in ["block", "sgm"] {
        let matching = ["--disparities", "16", "--method", method];
        let replay = [&["replay", "--from", &file, "--out", &out][..], &matching].concat();
        let told = run(&replay);
        assert!(told.contains("3 whole, 0 with rows flagged as damaged, 0 broken off"), "{told}");
        let pair = ["match", "--left", &left, "--right", &right, "--out", &matched];
        run(&[&pair[..], &matching].concat());
        let expected = disparities(&bench, "matched/disparity.pfm");
        for frame in 1..=3 {
            assert_eq!(
                disparities(&bench, &format!("out/{frame:06}-disparity.pfm")),
                expected,
                "{method} {frame}"
            );
        }
    }
    let summary = summary(&bench, "out");
    assert_eq!((&summary["frames"], &summary["counters"]["lines"]), (&3.into(), &90.into()));
    let table = fs::read_to_string(bench.path("out/frames.csv")).expect("a table");
    assert_eq!(table.lines().count(), 4);
    assert!(
        table.lines().nth(2).is_some_and(|line| line.starts_with("2,2,40000,30,0,0,") && line.ends_with(',')),
        "{table}"
    );

    // At the recorded speed the three frames take over two periods of 20 ms; fewer frames leave none of the
    // others' files.
    let start = Instant::now();
    run(&["replay", "--from", &file, "--disparities", "16", "--timing", "recorded", "--out", &out]);
    assert!(start.elapsed().as_millis() >= 40, "{:?}", start.elapsed());
    run(&["replay", "--from", &file, "--disparities", "16", "--frames", "1", "--out", &out]);
    assert_eq!(
        names(&bench.path("out")),
        ["000001-disparity.pfm", "000001-flags.png", "frames.csv", "summary.json"]
    );
}

#[test]
fn recorded_faults_happen_again_and_are_counted_by_name() {
    let bench = Bench::new();
    let [left, right] = put_pair(&bench, false);
    let [file, again, out] = ["a.lines", "b.lines", "out"].map(|name| bench.path(name).display().to_string());
    let images = ["--left", &left, "--right", &right, "--frames", "60", "--faults", "0.02", "--seed", "4"];
    for file in [&file, &again] {
        run(&[&["record", "--out", file][..], &images].concat());
    }
    assert_eq!(fs::read(&file).expect("a file"), fs::read(&again).expect("a file"), "the faults are seeded");
    let told = run(&["replay", "--from", &file, "--disparities", "16", "--out", &out]);
    assert!(told.starts_with("60 frames of 48 x 30 px"), "{told}");
    let summary = summary(&bench, "out");
    let count = |name: &str| summary["counters"][name].as_u64().unwrap_or_else(|| panic!("{name}"));
    let kinds = [
        "lines_dropped",
        "lines_repeated",
        "lines_torn",
        "lines_late",
        "lines_failed",
        "lines_timed_out",
        "lines_short",
    ];
    assert!(kinds.iter().filter(|kind| count(kind) > 0).count() > 5, "{summary}");
    assert!(count("rows_damaged") > 0 && count("rows_damaged") < count("rows"), "{summary}");
    let frames = |name: &str| summary[name].as_u64().expect("a number");
    let all =
        frames("whole_frames") + frames("damaged_frames") + frames("broken_frames") + frames("failed_frames");
    assert_eq!((all, frames("frames")), (60, 60), "{summary}");

    // A recording that was cut is played up to there.
    let bytes = fs::read(&file).expect("a file");
    fs::write(&again, &bytes[..bytes.len() * 2 / 3]).expect("a file");
    let told = notes(&["replay", "--from", &again, "--disparities", "16", "--out", &out]);
    assert!(told.contains("ends within a record"), "{told}");
}

#[test]
fn folders_are_played_in_the_order_of_their_names() {
    let bench = Bench::new();
    put_pair(&bench, true);
    let [frames, out] = ["frames", "out"].map(|name| bench.path(name).display().to_string());
    run(&["replay", "--from", &frames, "--disparities", "16", "--out", &out]);
    assert_eq!(
        disparities(&bench, "out/000001-disparity.pfm"),
        disparities(&bench, "out/000002-disparity.pfm")
    );
}

#[test]
fn what_cannot_be_played_is_named() {
    let bench = Bench::new();
    let [left, right] = put_pair(&bench, false);
    let frames = put_pair(&bench, true);
    let [file, out, missing] =
        ["a.lines", "out", "missing"].map(|name| bench.path(name).display().to_string());
    let replay = |from: &str, wanted: &str| {
        bench.refused(&["replay", "--from", from, "--disparities", "16", "--out", &out], wanted);
    };
    replay(&missing, "missing: cannot be read");
    replay(&left, "left.png: is no recording; give one by `stereo record`");
    replay(&frames[0], "has no folder 'left' in it");
    run(&["record", "--left", &left, "--right", &right, "--out", &file]);
    let mut bytes = fs::read(&file).expect("a file");
    bench.refused(
        &["replay", "--from", &file, "--disparities", "64", "--out", &out],
        "--disparities 64: the images are 48",
    );
    let at = bytes.len() - (11 + 2 * 48);
    bytes[at] = b'?';
    fs::write(&file, &bytes).expect("a file");
    replay(&file, "is corrupt at byte");
    fs::write(&file, "stereopsis recording 1\n{\"width\":0,\"height\":9,\"max_row_skew_us\":0}\n")
        .expect("a file");
    replay(&file, "frames of 0 x 9");
    fs::write(&file, "stereopsis recording 1\n{\"width\":48,\"height\":9,\"max_row_skew_us\":0}\n")
        .expect("a file");
    replay(&file, "a recording without a frame");
    for (option, range) in [("--most-lost", "0 to 65535"), ("--frames", "1 to 4294967295")] {
        for bad in ["-1", "x", "4294967296"] {
            bench.refused(
                &["replay", "--from", &file, "--disparities", "16", "--out", &out, option, bad],
                &format!("a whole number from {range} is needed"),
            );
        }
    }
    let record =
        |arguments: &[&str], wanted: &str| bench.refused(&[&["record"][..], arguments].concat(), wanted);
    record(&["--left", &left, "--right", &missing, "--out", &file], "missing: cannot be read");
    record(&["--left", &left, "--right", &frames[1], "--out", &file], "has 1 images and");
    record(&["--left", &left, "--right", &right, "--faults", "2", "--out", &file], "a number from 0 to 1");
    record(
        &["--left", &left, "--right", &right, "--seed", "-1", "--out", &file],
        "for '--seed <S>': a whole number from 0 to",
    );
    record(
        &["--left", &left, "--right", &right, "--out", &bench.path("").display().to_string()],
        "is not the name of a file",
    );
}

#[test]
fn what_cannot_be_recorded_or_is_odd_is_reported_by_name() {
    let bench = Bench::new();
    let [left, right] = put_pair(&bench, true);
    let file = bench.path("a.lines");
    let out = file.display().to_string();
    let refused = |left: &str| {
        let run = stereo(["record", "--left", left, "--right", &right, "--out", &out]);
        assert!(!run.status.success() && !file.exists());
        let told = text(&run.stderr).to_owned();
        assert!(told.lines().count() == 1, "{told}");
        told
    };
    let missing = bench.path("missing").display().to_string();
    assert!(refused(&missing).contains("missing: cannot be read ("), "{}", refused(&missing));

    // The second frame's time stamp is of before the first one's.
    run(&["record", "--left", &left, "--right", &right, "--out", &out]);
    let mut bytes = fs::read(&file).expect("a recording");
    let header = 2 + bytes.split(|&b| b == b'\n').take(2).map(<[u8]>::len).sum::<usize>();
    let frame = 17 + 30 * (11 + 2 * 48);
    assert_eq!((bytes[header], bytes[header + frame]), (b'F', b'F'));
    bytes[header + frame + 5..][..8].copy_from_slice(&1_u64.to_le_bytes());
    fs::write(&file, bytes).expect("a recording");
    let replayed = bench.path("out").display().to_string();
    let told =
        notes(&["replay", "--from", &out, "--disparities", "16", "--timing", "recorded", "--out", &replayed]);
    assert!(told.contains("note: time stamps go back at frame 2;"), "{told}");
    assert_eq!(summary(&bench, "out")["time_went_back_at"], 2);

    // An image of another size.
    fs::remove_file(&file).expect("it is there");
    image::GrayImage::new(48, 29).save(std::path::Path::new(&left).join("2.png")).expect("a file");
    image::GrayImage::new(48, 29).save(std::path::Path::new(&right).join("2.png")).expect("a file");
    let told = refused(&left);
    assert!(
        told.contains("2.png: is of another size than the first image") && !told.contains("a.lines"),
        "{told}"
    );
}

#[test]
fn swapped_cameras_are_refused_unless_forced() {
    let bench = Bench::new();
    let (left, right) = Scene::demo().render();
    for (side, picture) in [("left", &right), ("right", &left)] {
        let folder = bench.path("swapped").join(side);
        fs::create_dir_all(&folder).expect("a folder");
        picture.save(folder.join("1.png")).expect("a file");
    }
    let [swapped, file, out] =
        ["swapped", "a.lines", "out"].map(|name| bench.path(name).display().to_string());
    let [l, r] = ["left", "right"].map(|side| format!("{swapped}/{side}"));
    run(&["record", "--left", &l, "--right", &r, "--faults", "0.02", "--out", &file]);
    for from in [&swapped, &file] {
        let replay = ["replay", "--from", from, "--disparities", "64", "--method", "fast", "--out", &out];
        bench.refused(&replay, "exchange left and right, or give --force");
        let forced = stereo([&replay[..], &["--force"]].concat());
        assert!(forced.status.success() && text(&forced.stderr).contains("swapped"));
        fs::remove_dir_all(&out).expect("results");
    }
    // Lines that never come say nothing of the cameras.
    run(&["record", "--left", &l, "--right", &r, "--faults", "1", "--out", &file]);
    let lost = ["replay", "--from", &file, "--method", "fast", "--out", &out, "--disparities"];
    bench.refused(&[&lost[..], &["auto"]].concat(), "the first frames show nothing");
    let lost = stereo([&lost[..], &["64"]].concat());
    assert!(lost.status.success() && lost.stderr.is_empty(), "{}", text(&lost.stderr));
    fs::remove_dir_all(&out).expect("results");
    // The same cameras in their order.
    run(&["record", "--left", &r, "--right", &l, "--faults", "0.02", "--out", &file]);
    let replay = |options: &[&str]| {
        let words = ["replay", "--from", &file, "--method", "fast", "--out", &out, "--disparities"];
        stereo(words.iter().chain(options))
    };
    let short = replay(&["16", "--quiet"]);
    assert!(short.status.success() && short.stdout.is_empty());
    assert!(text(&short.stderr).contains("give --min-disparity"), "{}", text(&short.stderr));
    let auto = replay(&["auto", "--json"]);
    assert!(auto.status.success() && auto.stderr.is_empty(), "{}", text(&auto.stderr));
    let printed: Value = serde_json::from_slice(&auto.stdout).expect("JSON");
    assert_eq!(printed, json(&bench.path("out/summary.json")));
    assert!(printed["pair"]["fault"].is_null() && printed["pair"]["warnings"] == serde_json::json!([]));
    assert_eq!((&printed["command"][1], &printed["inputs"][0]), (&"replay".into(), &file.as_str().into()));
    assert_eq!(printed["pair"]["search"][1], printed["disparities"]);
}

#[test]
fn cameras_that_see_nothing_are_told() {
    let bench = Bench::new();
    for side in ["left", "right"] {
        let folder = bench.path("dark").join(side);
        fs::create_dir_all(&folder).expect("a folder");
        image::GrayImage::new(96, 64).save(folder.join("1.png")).expect("a file");
    }
    let [dark, out] = ["dark", "out"].map(|name| bench.path(name).display().to_string());
    let said = notes(&["replay", "--from", &dark, "--disparities", "32", "--method", "fast", "--out", &out]);
    for line in ["100 % of the images are black", "only 0.0 % of the pixels have an answer"] {
        assert!(said.contains(line), "{said}");
    }
}
