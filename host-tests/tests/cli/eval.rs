//! `stereo eval`: measures of files and folders whose errors are known, and what is refused.

use super::support::{Bench, HEIGHT, WIDTH, calibration, encode, stereo, text};
use image::{GrayImage, ImageBuffer, ImageFormat, Luma};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use stereopsis_host::pfm;

const NONE: f32 = f32::INFINITY;
/// Four pixels in a row: errors of 0, 1.5 and 4.5 px, and none.
const TRUTH: [f32; 4] = [10.0, 20.0, 30.0, 40.0];
const FOUND: [f32; 4] = [10.0, 21.5, 34.5, NONE];

fn float_map(values: &[f32]) -> Vec<u8> {
    let mut file = Vec::new();
    pfm::write(&mut file, values.len(), values).expect("memory takes all");
    file
}

/// Steps of 1/256 px, 0 where there is none.
pub fn steps(values: &[f32], width: u32) -> Vec<u8> {
    let samples = values.iter().map(|px| if px.is_finite() { (px * 256.0) as u16 } else { 0 });
    let image = ImageBuffer::<Luma<u16>, _>::from_raw(
        width,
        values.len() as u32 / width,
        samples.collect::<Vec<_>>(),
    );
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.expect("whole rows").write_to(&mut bytes, ImageFormat::Png).expect("memory takes all");
    bytes.into_inner()
}

pub fn put(bench: &Bench, name: &str, bytes: &[u8]) -> String {
    let folder = bench.path(name).parent().map(PathBuf::from).expect("a folder");
    fs::create_dir_all(folder).expect("a folder");
    bench.put(name, bytes).display().to_string()
}

pub fn evaluated(args: &[&str]) -> Value {
    let run = stereo([&["eval", "--json"], args].concat());
    assert!(run.status.success() && run.stderr.is_empty(), "{args:?}: {}", text(&run.stderr));
    serde_json::from_slice(&run.stdout).expect("JSON")
}

fn is_as_worked_by_hand(measures: &Value) {
    let near = |name: &str, expected: f64| {
        let found = measures[name].as_f64().unwrap_or_else(|| panic!("{name} in {measures}"));
        assert!((found - expected).abs() < 1e-6, "{name}: {found}, {expected} is due");
    };
    near("density", 0.75);
    near("missed", 0.5);
    near("epe_px", 2.0);
    near("bad05", 2.0 / 3.0);
    near("d1", 1.0 / 3.0);
    for name in ["bad2", "bad4"] {
        near(name, 1.0 / 3.0);
    }
    near("bad1", 2.0 / 3.0);
    assert_eq!(measures["scored"], 4);
}

#[test]
fn two_files() {
    let bench = Bench::new();
    let truth = put(&bench, "truth.pfm", &float_map(&TRUTH));
    let found = put(&bench, "found.pfm", &float_map(&FOUND));
    is_as_worked_by_hand(&evaluated(&["--found", &found, "--truth", &truth])["mean"]);
    let (truth_png, found_png) =
        (put(&bench, "t.png", &steps(&TRUTH, 4)), put(&bench, "f.png", &steps(&FOUND, 4)));
    is_as_worked_by_hand(&evaluated(&["--found", &found_png, "--truth", &truth_png])["mean"]);
    // The last pixel is not scored then, and nothing is missing; the wrong one is the least sure.
    let mask = put(&bench, "mask.png", &encode(&row(&[255, 255, 255, 128]), ImageFormat::Png));
    let sure = put(&bench, "sure.png", &encode(&row(&[200, 100, 50, 0]), ImageFormat::Png));
    let masked = evaluated(&["--found", &found, "--truth", &truth, "--mask", &mask, "--confidence", &sure]);
    let mean = &masked["mean"];
    assert_eq!((&mean["scored"], &mean["density"]), (&Value::from(3), &Value::from(1.0)));
    assert_eq!(mean["confidence_from_oracle"], 0.0);
    assert_eq!(mean["occluded"], serde_json::json!({ "density": 0.0, "bad2": 0.0, "missed": 1.0 }));
    // Steps of 1/128 px are twice as many pixels.
    // They are named: hardly anything is right.
    let run =
        stereo(["eval", "--json", "--found", &found_png, "--truth", &truth_png, "--found-scale", "128"]);
    let halves: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    assert_eq!(halves["mean"]["bad4"], 1.0);
    assert!(text(&run.stderr).contains("f.png: 100 % of the answers are over 2 px off"), "{halves}");
    // The table is a result, also where there is one already.
    for _ in 0..2 {
        let csv = bench.path("table.csv").display().to_string();
        evaluated(&["--found", &found, "--truth", &truth, "--csv", &csv]);
        assert!(fs::read_to_string(csv).expect("a table").contains("found.pfm,75.00,"));
    }
}

fn row(samples: &[u8]) -> GrayImage {
    GrayImage::from_raw(samples.len() as u32, 1, samples.to_vec()).expect("a row")
}

#[test]
fn depths_are_disparities_by_a_calibration() {
    let bench = Bench::new();
    // 100 px x 0.2 m and an offset of 1 px, as the calibration says.
    let calib = put(&bench, "calib.txt", calibration(WIDTH, HEIGHT).as_bytes());
    let truth = put(&bench, "truth.pfm", &float_map(&TRUTH));
    let depths = FOUND.map(|px| if px.is_finite() { 20.0 / (px + 1.0) } else { NONE });
    let found = put(&bench, "depth.pfm", &float_map(&depths));
    is_as_worked_by_hand(&evaluated(&["--found", &found, "--truth", &truth, "--depths-by", &calib])["mean"]);
    // A truth in depths, too.
    let true_depths = put(&bench, "true.pfm", &float_map(&TRUTH.map(|px| 20.0 / (px + 1.0))));
    let both = ["--found", &found, "--truth", &true_depths, "--depths-by", &calib];
    is_as_worked_by_hand(&evaluated(&[&both[..], &["--truth-depths"]].concat())["mean"]);
    let run = stereo([&["eval"], &both[..]].concat());
    assert!(text(&run.stderr).contains("--truth-depths for a truth in metres"), "{}", text(&run.stderr));
}

#[test]
fn folders_of_the_public_benchmarks() {
    let bench = Bench::new();
    let (truth_map, found_map) = (float_map(&TRUTH), float_map(&FOUND));
    let all_seen = encode(&row(&[255; 4]), ImageFormat::Png);
    for (name, bytes) in [
        ("middlebury/a/disp0.pfm", &truth_map),
        ("middlebury/a/mask0nocc.png", &all_seen),
        ("middlebury/b/disp0.pfm", &truth_map),
        ("of_middlebury/a/disparity.pfm", &found_map),
        ("of_middlebury/b.pfm", &found_map),
        ("eth3d/scene/disp0GT.pfm", &truth_map),
        ("of_eth3d/scene.pfm", &found_map),
        ("kitti/disp_occ_0/000000_10.png", &steps(&TRUTH, 4)),
        ("of_kitti/disp_0/000000_10.png", &steps(&FOUND, 4)),
    ] {
        put(&bench, name, bytes);
    }
    for (layout, scenes) in
        [("middlebury", vec!["a", "b"]), ("eth3d", vec!["scene"]), ("kitti", vec!["000000_10"])]
    {
        let [truth, found] =
            [layout.to_owned(), format!("of_{layout}")].map(|name| bench.path(&name).display().to_string());
        let all = evaluated(&["--found", &found, "--truth", &truth]);
        let names: Vec<_> = all["scenes"].as_array().expect("a list").iter().map(|s| &s["scene"]).collect();
        assert_eq!(names, scenes, "{layout}");
        all["scenes"].as_array().expect("a list").iter().for_each(is_as_worked_by_hand);
        let mean = &all["mean"];
        assert_eq!((&mean["density"], &mean["missed"]), (&Value::from(0.75), &Value::from(0.5)), "{layout}");
    }
    let [truth, found] = ["middlebury", "of_middlebury"].map(|name| bench.path(name).display().to_string());
    let csv = bench.path("table.csv");
    let run = stereo(["eval", "--found", &found, "--truth", &truth, "--csv", &csv.display().to_string()]);
    let table = text(&run.stdout);
    assert!(table.contains("mean     75.00    66.67    66.67    33.33    33.33    33.33    50.00    2.000"));
    let csv = fs::read_to_string(csv).expect("a file");
    assert!(csv.starts_with("scene,density,bad0.5,"), "{csv}");
    assert_eq!(csv.lines().last(), Some("mean,75.00,66.67,66.67,33.33,33.33,33.33,50.00,2.000,,,"));
}

#[test]
fn what_cannot_be_compared_is_named() {
    let bench = Bench::new();
    let truth = put(&bench, "truth.pfm", &float_map(&TRUTH));
    let found = put(&bench, "found.pfm", &float_map(&FOUND));
    let short = put(&bench, "short.pfm", &float_map(&FOUND[1..]));
    let unknown = put(&bench, "unknown.pfm", &float_map(&[NONE; 4]));
    let text_file = put(&bench, "text.png", b"text");
    let folder = bench.path("empty");
    fs::create_dir(&folder).expect("a folder");
    let folder = folder.display().to_string();
    put(&bench, "scenes/a/disp0.pfm", &float_map(&TRUTH));
    let scenes = bench.path("scenes").display().to_string();
    let refused = |args: &[&str], culprit: &str| bench.refused(&[&["eval"], args].concat(), culprit);
    refused(&[], "--found");
    refused(&["--found", &found], "--truth");
    refused(&["--found", &short, "--truth", &truth], "short.pfm: is 3 x 1 px; 4 x 1 px are needed");
    refused(&["--found", &found, "--truth", &unknown], "unknown.pfm: no pixel of it is known");
    refused(&["--found", &found, "--truth", &text_file], "text.png: is neither PFM nor a picture");
    refused(&["--found", "missing.pfm", "--truth", &truth], "missing.pfm: cannot be read");
    refused(&["--found", &found, "--truth", &truth, "--mask", &text_file], "text.png: is no picture");
    refused(&["--found", &found, "--truth", &folder], "empty: holds no scene with a truth");
    refused(&["--found", &folder, "--truth", &scenes], "holds no result for a");
    refused(&["--scenes", &folder], "empty: holds no scene with a truth");
    refused(&["--scenes", &scenes], "im0.png");
    refused(&["--scenes", &scenes, "--found", &found], "--found");
    refused(&["--scenes", &scenes, "--opencv", "no-such-python"], "--opencv no-such-python");
    refused(&["--found", &found, "--truth", &truth, "--opencv"], "--opencv");
    refused(&["--found", &found, "--truth", &scenes, "--mask", &found], "--mask");
    refused(
        &["--found", &found, "--truth", &scenes],
        "found.pfm: is a file; a folder of scenes has a folder",
    );
    refused(&["--found", &found, "--truth", &truth, "--found-scale", "0"], "--found-scale");
    refused(&["--found", &found, "--truth", &truth, "--disparities", "64"], "--disparities");
}

/// What is for files says nothing of scenes that are matched here, and what is for a search nothing of files.
#[test]
fn options_of_the_other_way_to_evaluate_are_refused() {
    let bench = Bench::new();
    let found = put(&bench, "found.pfm", &float_map(&FOUND));
    let truth = put(&bench, "truth.pfm", &float_map(&TRUTH));
    let (scenes, nothing) = (bench.path("scenes").display().to_string(), "nothing");
    for [option, value] in [
        ["--mask", nothing],
        ["--confidence", nothing],
        ["--depths-by", nothing],
        ["--found-scale", "256"],
        ["--truth-scale", "64"],
    ] {
        let run = stereo(["eval", "--scenes", &scenes, option, value]);
        bench.is_refusal(&run, "cannot be used with", option);
        assert!(text(&run.stderr).contains(option), "{option}: {}", text(&run.stderr));
    }
    for [option, value] in [
        ["--method", "fast"],
        ["--filter", "strict"],
        ["--noise", "high"],
        ["--min-confidence", "100"],
        ["--threads", "2"],
        ["--balance", "none"],
    ] {
        let run = stereo(["eval", "--found", &found, "--truth", &truth, option, value]);
        bench.is_refusal(&run, "cannot be used with", option);
        assert!(text(&run.stderr).contains(option), "{option}: {}", text(&run.stderr));
    }
}
