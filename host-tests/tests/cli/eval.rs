//! `stereo eval`: measures of files and folders whose errors are known, and what is refused.

use super::support::{Bench, FAR, HEIGHT, NEAR, WIDTH, calibration, encode, pair, stereo, text};
use image::{GrayImage, ImageBuffer, ImageFormat, Luma, imageops};
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
fn steps(values: &[f32], width: u32) -> Vec<u8> {
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

fn put(bench: &Bench, name: &str, bytes: &[u8]) -> String {
    let folder = bench.path(name).parent().map(PathBuf::from).expect("a folder");
    fs::create_dir_all(folder).expect("a folder");
    bench.put(name, bytes).display().to_string()
}

fn evaluated(args: &[&str]) -> Value {
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
    // Steps of 1/128 px are twice as many pixels.
    let halves = evaluated(&["--found", &found_png, "--truth", &truth_png, "--found-scale", "128"]);
    assert_eq!(halves["mean"]["bad4"], 1.0);
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
    assert_eq!(csv.lines().last(), Some("mean,75.00,66.67,66.67,33.33,33.33,33.33,50.00,2.000,"));
}

/// True disparities of the pair, px.
fn true_disparities() -> Vec<f32> {
    let at = |(x, y): (u32, u32)| (40..70).contains(&x) && (12..36).contains(&y);
    let places = (0..WIDTH * HEIGHT).map(|place| (place % WIDTH, place / WIDTH));
    places.map(|place| if at(place) { NEAR as f32 } else { FAR as f32 }).collect()
}

/// A folder with one scene, `squares`, and its truth.
fn squares(bench: &Bench) -> (String, Vec<f32>) {
    let (left, right) = pair();
    let truth = true_disparities();
    put(bench, "scenes/squares/left.png", &encode(&left, ImageFormat::Png));
    put(bench, "scenes/squares/right.png", &encode(&right, ImageFormat::Png));
    put(bench, "scenes/squares/gt.png", &steps(&truth, WIDTH));
    put(bench, "scenes/squares/meta.json", br#"{"disparities": 32}"#);
    (bench.path("scenes").display().to_string(), truth)
}

#[test]
fn scenes_are_matched_as_match_does() {
    let bench = Bench::new();
    let (scenes, _) = squares(&bench);
    let here = evaluated(&["--scenes", &scenes, "--method", "block"]);
    assert_eq!(here["scenes"][0]["disparities"], 32);
    assert!(here["scenes"][0]["confidence_from_oracle"].is_number());
    assert!(here["mean"]["missed"].as_f64().is_some_and(|missed| missed < 0.2), "{here}");
    assert_eq!(here["mean"]["scored"], (WIDTH - 32) * HEIGHT);
    bench.matched(&[("--method", "block"), ("--out", &bench.path("out/squares").display().to_string())]);
    let out = bench.path("out").display().to_string();
    let there = evaluated(&["--found", &out, "--truth", &scenes]);
    assert_eq!(here["mean"], there["mean"]);
}

/// The measures of the scenes, by their names.
fn by_name(evaluated: &Value) -> Vec<(&str, Value)> {
    let scenes = evaluated["scenes"].as_array().expect("a list").iter();
    let measures = |scene: &Value| {
        let mut scene = scene.clone();
        let all = scene.as_object_mut().expect("an object");
        ["scene", "disparities", "time_ms"].iter().for_each(|name| drop(all.remove(*name)));
        scene
    };
    scenes.map(|scene| (scene["scene"].as_str().expect("a name"), measures(scene))).collect()
}

/// Scenes are named by numbers that are those of other scenes' results: each result is that of its images.
#[test]
fn numbered_results_of_many_pairs_are_those_of_their_images() {
    let bench = Bench::new();
    let (left, right) = pair();
    let upright = [left, right];
    let turned = upright.each_ref().map(imageops::flip_vertical);
    let truth = true_disparities();
    let flipped: Vec<f32> = truth.rchunks(WIDTH as usize).flatten().copied().collect();
    for (number, [left, right], truth) in [(2, &upright, &truth), (3, &turned, &flipped)] {
        let [left, right] = [left, right].map(|image| encode(image, ImageFormat::Png));
        let truth = steps(truth, WIDTH);
        for (file, bytes) in [("left.png", &left), ("right.png", &right), ("gt.png", &truth)] {
            put(&bench, &format!("own/00000{number}/{file}"), bytes);
        }
        put(&bench, &format!("own/00000{number}/meta.json"), br#"{"disparities": 32}"#);
        for (folder, bytes) in [("image_2", &left), ("image_3", &right), ("disp_occ_0", &truth)] {
            put(&bench, &format!("kitti/{folder}/00000{number}_10.png"), bytes);
        }
    }
    let at = |name: &str| bench.path(name).display().to_string();
    for (truth, left, right, out) in [
        ("own", "own/*/left.png", "own/*/right.png", "of_own"),
        ("kitti", "kitti/image_2", "kitti/image_3", "of_kitti"),
    ] {
        let [truth, left, right, out] = [truth, left, right, out].map(at);
        let search = ["--disparities", "32", "--method", "block"];
        let pairs = ["match", "--left", &left, "--right", &right, "--out", &out, "--quiet"];
        let run = stereo([&pairs[..], &search].concat());
        assert!(run.status.success(), "{}", text(&run.stderr));
        let there = evaluated(&["--found", &out, "--truth", &truth]);
        let here = evaluated(&[&["--scenes", &truth], &search[..]].concat());
        assert_eq!(by_name(&there), by_name(&here), "{truth}");
        let missed = here["mean"]["missed"].as_f64().expect("a number");
        assert!(missed < 0.4 && by_name(&here)[0].1 != by_name(&here)[1].1, "{here}");
    }
    // Images that have moved are known by their names; of two results of one scene neither is taken.
    let [own, of_own] = ["own", "of_own"].map(at);
    fs::rename(&own, at("moved")).expect("a folder");
    let moved = evaluated(&["--found", &of_own, "--truth", &at("moved")]);
    assert_eq!(by_name(&moved).len(), 2);
    let copy = bench.path("of_own/000007");
    fs::create_dir(&copy).expect("a folder");
    for file in ["disparity.pfm", "summary.json"] {
        fs::copy(bench.path("of_own/000001").join(file), copy.join(file)).expect("a file");
    }
    let refused = |truth: &str, line: &str| {
        bench.refused(&["eval", "--found", &of_own, "--truth", truth], line);
    };
    refused(&at("moved"), "of_own: holds two results for 000002, ");
    fs::remove_dir_all(&copy).expect("a folder");
    fs::remove_dir_all(bench.path("of_own/000002")).expect("a folder");
    refused(&at("moved"), "of_own: holds no result for 000003; ");
    refused(&at(""), "holds no scene with a truth, but in kitti, moved: name that folder");
    fs::write(bench.path("of_own/000001/summary.json"), "{}").expect("a file");
    refused(&at("moved"), "000001/summary.json: cannot be read (it names no inputs)");
}

/// Worse cameras are what the images of a scene are made into, by a seed of their own.
#[test]
fn scenes_are_matched_as_worse_cameras_take_them() {
    let bench = Bench::new();
    let (scenes, _) = squares(&bench);
    let with = |more: &[&str]| {
        evaluated(&[&["--scenes", &scenes, "--method", "sgm", "--balance", "none"], more].concat())
    };
    let plain = with(&[]);
    assert!(plain["altered"].is_null());
    for (how, name) in [
        ("noise:60", "noise, sigma 60"),
        ("exposure:1.5:30", "right x 1.5 + 30"),
        ("gamma:0.4", "right, gamma 0.4"),
        ("half-row", "right, half a row low"),
    ] {
        let worse = with(&["--altered", how]);
        assert_eq!(worse["altered"], name);
        assert_ne!(worse["mean"], plain["mean"], "{how}");
        assert_eq!(worse["mean"], with(&["--altered", how])["mean"], "{how} by the same seed");
    }
    let missed = |found: &Value| found["mean"]["missed"].as_f64().expect("a number");
    assert!(missed(&with(&["--altered", "noise:100"])) > missed(&plain));
    assert_eq!(with(&["--altered", "exposure:1:0"])["mean"], plain["mean"]);
    let table = text(&stereo(["eval", "--scenes", &scenes, "--altered", "noise:5"]).stdout);
    assert!(table.contains("\nimages altered: noise, sigma 5\n"), "{table}");
    for how in ["noise", "noise:x", "noise:5:x", "noise:-1", "exposure:1", "gamma:0", "half-row:1", "fog"] {
        bench.refused(&["eval", "--scenes", &scenes, "--altered", how], "--altered");
    }
    bench.refused(&["eval", "--found", &scenes, "--truth", &scenes, "--altered", "half-row"], "--altered");
}

/// A program stands in for a Python that has OpenCV: it looks for the images, and its answers are the truth
/// for one matcher, and a pixel more for the other.
#[cfg(unix)]
#[test]
fn opencv_is_beside() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::new();
    let (scenes, truth) = squares(&bench);
    let of_width = |add: f32| {
        let mut file = Vec::new();
        let values: Vec<_> = truth.iter().map(|px| px + add).collect();
        pfm::write(&mut file, WIDTH as usize, &values).expect("memory takes all");
        file
    };
    put(&bench, "python-StereoBM.pfm", &of_width(0.0));
    put(&bench, "python-StereoSGBM.pfm", &of_width(1.5));
    let python = put(
        &bench,
        "python",
        b"#!/bin/sh\n[ \"$1\" = -c ] || exit 2\ncase $2 in 'import cv2'*) echo 9.8.7; exit;; esac\n\
          folder=$3; shift 3\necho \"$@\" > \"$0.words\"\n\
          test -s \"$folder/$1-left.pgm\" -a -s \"$folder/$1-right.pgm\" || exit 3\n\
          for name in StereoBM StereoSGBM; do cp \"$0-$name.pfm\" \"$folder/$1-$name.pfm\"; done\n",
    );
    fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).expect("the owner may");
    let arguments = ["--scenes", &scenes, "--min-disparity", "2", "--method", "block", "--opencv", &python];
    let all = evaluated(&arguments);
    assert_eq!(text(&fs::read(format!("{python}.words")).expect("a file")), "0 32 2\n");
    assert!(all["mean"]["missed"].as_f64().is_some_and(|missed| missed < 0.2), "{all}");
    let beside = all["beside"].as_array().expect("a list");
    assert_eq!(beside.len(), 2);
    for (beside, (program, bad1)) in beside.iter().zip([("StereoBM", 0.0), ("StereoSGBM", 1.0)]) {
        assert_eq!(beside["program"], format!("OpenCV 9.8.7 {program}"));
        for measures in [&beside["mean"], &beside["scenes"][0]] {
            assert_eq!((&measures["bad1"], &measures["missed"]), (&bad1.into(), &0.0.into()), "{program}");
        }
    }
    let table = stereo([&["eval"], arguments.as_slice()].concat());
    let table = text(&table.stdout);
    let line = |name: &str| table.lines().find(|line| line.starts_with(name)).map(str::to_owned);
    assert!(line("OpenCV 9.8.7 StereoSGBM: squares").is_some_and(|line| line.contains(" 100.00")), "{table}");
    assert!(table.contains("uniquenessRatio 10"), "{table}");

    fs::write(&python, "#!/bin/sh\necho 'a trace' >&2\necho 'no module cv2' >&2\nexit 1\n").expect("a file");
    let line = format!("--opencv {python}: does not run OpenCV (no module cv2); install it (pip install");
    bench.refused(&["eval", "--scenes", &scenes, "--opencv", &python], &line);
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
