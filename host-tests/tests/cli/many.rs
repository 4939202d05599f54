//! `stereo match` on many pairs, on pictures of both cameras, on raw frames from a pipe, and with several
//! settings.

use super::support::{Bench, HEIGHT, WIDTH, encode, names, pair, program, stereo, text};
use image::{GrayImage, ImageFormat, imageops};
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::process::{Output, Stdio};
use std::time::SystemTime;

const SEARCH: [&str; 4] = ["--disparities", "32", "--method", "block"];

/// Both images beside each other.
fn both() -> GrayImage {
    let (left, right) = pair();
    let mut both = GrayImage::new(2 * WIDTH, HEIGHT);
    imageops::replace(&mut both, &left, 0, 0);
    imageops::replace(&mut both, &right, i64::from(WIDTH), 0);
    both
}

fn matched(args: &[&str]) -> Output {
    let run = stereo([&["match"], &SEARCH[..], args].concat());
    assert!(run.status.success(), "{args:?}: {}", text(&run.stderr));
    run
}

/// The disparities of the pair, matched alone.
fn alone(bench: &Bench) -> Vec<u8> {
    bench.matched(&[("--method", "block"), ("--out", &at(bench, "alone"))]);
    fs::read(bench.path("alone/disparity.pfm")).expect("a result")
}

pub fn at(bench: &Bench, name: &str) -> String {
    bench.path(name).display().to_string()
}

/// Three pairs, of which 10 comes last.
pub fn pairs(bench: &Bench) {
    let (left, right) = pair();
    for (side, image) in [("left", left), ("right", right)] {
        fs::create_dir_all(bench.path("frames").join(side)).expect("a folder");
        for number in [2, 9, 10] {
            // The second one is turned about, so that the three differ.
            let image = if number == 9 { imageops::flip_vertical(&image) } else { image.clone() };
            bench.put(&format!("frames/{side}/f{number}.png"), &encode(&image, ImageFormat::Png));
        }
    }
}

#[test]
fn patterns_and_folders_are_many_pairs_in_the_order_of_their_numbers() {
    let bench = Bench::new();
    pairs(&bench);
    let alone = alone(&bench);
    let folder = |side| at(&bench, &format!("frames/{side}"));
    let pattern = |side| at(&bench, &format!("frames/{side}/f*.png"));
    for (left, right, out) in
        [(pattern("left"), pattern("right"), "by_pattern"), (folder("left"), folder("right"), "by_folder")]
    {
        let run = matched(&["--left", &left, "--right", &right, "--out", &at(&bench, out)]);
        let told = text(&run.stderr);
        let begins = [
            "000001 of 3 is being matched: f2.png f2.png",
            "000002 of 3",
            "000003 of 3 is being matched: f10",
        ];
        assert!(begins.iter().all(|line| told.contains(line)), "{told}");
        let numbers = ["000001", "000002", "000003"];
        assert_eq!(names(&bench.path(out)), [&numbers[..], &["frames.csv"]].concat());
        let disparities =
            |number: &str| fs::read(bench.path(out).join(number).join("disparity.pfm")).expect("a result");
        assert!(disparities("000001") == alone && disparities("000003") == alone);
        assert!(disparities("000002") != alone);
        let table = fs::read_to_string(bench.path(out).join("frames.csv")).expect("a table");
        assert_eq!(table.lines().next(), Some("frame,input,density,median_px,time_ms,state_bytes,fault"));
        assert_eq!(table.lines().count(), 4, "{table}");
        assert!(text(&run.stdout).contains("000003"), "{}", text(&run.stdout));
    }
}

#[test]
fn what_is_finished_is_not_done_again_unless_its_images_or_settings_differ() {
    let bench = Bench::new();
    pairs(&bench);
    let [left, right, out] = ["frames/left", "frames/right", "out"].map(|name| at(&bench, name));
    let run = |more: &[&str]| {
        let args = [&["--left", &left, "--right", &right, "--out", &out], more].concat();
        let told = text(&matched(&args).stderr);
        let lines = told.lines().filter(|line| line.contains(" of 3 "));
        lines.map(|line| line.contains("is being matched")).collect::<Vec<_>>()
    };
    let written = |number: &str| -> SystemTime {
        let file = bench.path("out").join(number).join("disparity.pfm");
        fs::metadata(file).and_then(|found| found.modified()).expect("a result")
    };
    assert_eq!(run(&[]), [true; 3]);
    let before = ["000001", "000002", "000003"].map(written);
    assert_eq!(run(&[]), [false; 3]);
    assert_eq!(before, ["000001", "000002", "000003"].map(written));
    // Another image, a result that is not there, other settings.
    bench.put("frames/right/f9.png", &encode(&pair().1, ImageFormat::Png));
    assert_eq!(run(&[]), [false, true, false]);
    fs::remove_dir_all(bench.path("out/000003")).expect("a folder");
    assert_eq!(run(&[]), [false, false, true]);
    // Results that are gone or cut off.
    fs::remove_file(bench.path("out/000001/disparity.pfm")).expect("a result");
    bench.put("out/000003/summary.json", b"");
    assert_eq!(run(&[]), [true, false, true]);
    assert_eq!(run(&[]), [false; 3]);
    assert_eq!(run(&["--filter", "strict"]), [true; 3]);
    assert_eq!(run(&["--filter", "strict"]), [false; 3]);
    // Fewer pairs than before.
    for (name, count, which) in [
        ("f?.png", 2, "000003 is of an earlier run"),
        ("f1*.png", 1, "000002 to 000003 are of an earlier run"),
    ] {
        let [left, right] = ["left", "right"].map(|side| at(&bench, &format!("frames/{side}/{name}")));
        let told = text(&matched(&["--left", &left, "--right", &right, "--out", &out]).stderr);
        assert!(told.contains(&format!("{which}, not in frames.csv")), "{told}");
        let table = fs::read_to_string(bench.path("out/frames.csv")).expect("a table");
        assert_eq!(table.lines().count(), 1 + count, "{table}");
        assert!(bench.path("out/000003/disparity.pfm").is_file());
    }
}

#[test]
fn a_picture_of_both_cameras_is_a_pair() {
    let bench = Bench::new();
    let alone = alone(&bench);
    let picture = bench.put("both.png", &encode(&both(), ImageFormat::Png)).display().to_string();
    let out = at(&bench, "out");
    let run = matched(&["--side-by-side", &picture, "--out", &out]);
    assert!(run.stderr.is_empty(), "{}", text(&run.stderr));
    assert!(fs::read(bench.path("out/disparity.pfm")).expect("a result") == alone);
    let summary: Value =
        serde_json::from_slice(&fs::read(bench.path("out/summary.json")).expect("a result")).expect("JSON");
    assert_eq!(summary["inputs"], serde_json::json!([picture]));
}

/// Runs the program with bytes on its standard input.
fn piped(args: &[&str], bytes: &[u8]) -> Output {
    let mut child = program()
        .args([&["match"], &SEARCH[..], args].concat())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // It may end before it has read all.
    let _ = child.stdin.take().expect("a pipe").write_all(bytes);
    child.wait_with_output().expect("it ends")
}

#[test]
fn raw_frames_come_through_a_pipe() {
    let bench = Bench::new();
    let alone = alone(&bench);
    let size = format!("{}x{HEIGHT}", 2 * WIDTH);
    let out = at(&bench, "out");
    let args = ["--raw", &size, "--side-by-side", "-", "--out", &out];
    let frame = both().into_raw();
    let run = piped(&args, &[frame.clone(), frame.clone()].concat());
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert_eq!(names(&bench.path("out")), ["000001", "000002", "frames.csv"]);
    for number in ["000001", "000002"] {
        let path = bench.path("out").join(number).join("disparity.pfm");
        assert!(fs::read(path).expect("a result") == alone, "frame {number}");
    }
    // The same frames in a file.
    let file = bench.put("frames.raw", &frame).display().to_string();
    let from_file = at(&bench, "from_file");
    matched(&["--raw", &size, "--side-by-side", &file, "--out", &from_file]);
    assert!(fs::read(bench.path("from_file/000001/disparity.pfm")).expect("a result") == alone);

    let cut = piped(&args, &frame[..frame.len() - 1]);
    let told = text(&cut.stderr);
    assert_eq!((cut.status.code(), told.lines().count()), (Some(1), 1), "{told}");
    assert!(told.contains("standard input: ends after 9215 of 9216 bytes of frame 1"), "{told}");
    // Frames before one that is cut have their table.
    let out = at(&bench, "cut");
    let args = ["--raw", &size, "--side-by-side", "-", "--out", &out];
    let cut = piped(&args, &[&frame, &frame[..100]].concat());
    assert!(text(&cut.stderr).contains("ends after 100 of 9216 bytes of frame 2"), "{}", text(&cut.stderr));
    assert_eq!(
        (cut.status.code(), names(&bench.path("cut"))),
        (Some(1), vec!["000001".into(), "frames.csv".into()])
    );
    let none = piped(&args, b"");
    assert_eq!(none.status.code(), Some(1));
    assert!(text(&none.stderr).contains("standard input: holds no frame"), "{}", text(&none.stderr));
}

/// A pipe can be read once only, and many look at what a calibration says.
#[cfg(unix)]
#[test]
fn a_calibration_comes_through_a_pipe() {
    const KITTI: &str = "P0: 90 0 48 0 0 90 24 0 0 0 1 0\nP1: 90 0 48 -45 0 90 24 0 0 0 1 0\n";
    let bench = Bench::new();
    pairs(&bench);
    let file = bench.put("calib.txt", KITTI.as_bytes()).display().to_string();
    let [left, right] = ["left", "right"].map(|side| at(&bench, &format!("frames/{side}")));
    let one = [left.clone() + "/f2.png", right.clone() + "/f2.png"];
    for (case, ([left, right], more, depth)) in [
        (one.clone(), None, "depth.pfm"),
        (one, Some("--rectify"), "depth.pfm"),
        ([left, right], None, "000003/depth.pfm"),
    ]
    .into_iter()
    .enumerate()
    {
        let [by_file, by_pipe] = ["file", "pipe"].map(|by| at(&bench, &format!("{case}-{by}")));
        let args = |calib, out| {
            let args = ["--left", &*left, "--right", &*right, "--calib", calib, "--out", out];
            args.into_iter().chain(more).collect::<Vec<_>>()
        };
        matched(&args(&file, &by_file));
        let run = piped(&args("/dev/stdin", &by_pipe), KITTI.as_bytes());
        assert!(run.status.success(), "case {case}: {}", text(&run.stderr));
        let [by_file, by_pipe] = [by_file, by_pipe].map(|out| fs::read(format!("{out}/{depth}")));
        assert!(by_pipe.expect("depths") == by_file.expect("depths"), "case {case}");
    }
}

#[test]
fn several_settings_are_shown_side_by_side() {
    let bench = Bench::new();
    let [left, right, out] = ["left.png", "right.png", "out"].map(|name| at(&bench, name));
    let run = stereo(
        [
            ["match", "--left", &left, "--right", &right, "--out", &out, "--disparities", "32"].as_slice(),
            &["--settings", "fast,block,sgm:strict,sgm"],
        ]
        .concat(),
    );
    assert!(run.status.success(), "{}", text(&run.stderr));
    let files = ["block", "fast", "settings.csv", "settings.png", "sgm", "sgm-strict"];
    assert_eq!(names(&bench.path("out")), files);
    let table = text(&run.stdout);
    assert!(["\nfast ", "\nblock ", "\nsgm-strict "].iter().all(|name| table.contains(name)), "{table}");
    assert!(fs::read(bench.path("out/block/disparity.pfm")).expect("a result") == alone(&bench));
    let picture = image::open(bench.path("out/settings.png")).expect("a picture").into_rgb8();
    // The left image and three maps, and below it the last one: names of 20 rows above each, of which the
    // longest takes 100 columns, and gaps of four pixels.
    let (column, row) = (WIDTH.max(100) + 4, 20 + 4 + HEIGHT + 4);
    assert_eq!(picture.dimensions(), (4 * column - 4, 2 * row - 4));
    let mut seen = Vec::new();
    for (name, x, y) in [("fast", 1, 0), ("block", 2, 0), ("sgm-strict", 3, 0), ("sgm", 0, 1)] {
        let map = image::open(bench.path("out").join(name).join("disparity_colour.png")).expect("a picture");
        let part = |top, height| imageops::crop_imm(&picture, x * column, y * row + top, WIDTH, height);
        assert!(part(24, HEIGHT).to_image() == map.into_rgb8(), "{name}");
        let written = part(0, 20).to_image();
        let dark = written.pixels().filter(|pixel| pixel.0 == [0; 3]).count();
        assert!(dark > 20 * name.len() && !seen.contains(&written), "{name} is not written: {dark}");
        seen.push(written);
    }
}

#[test]
fn sources_that_do_not_fit_are_named() {
    let bench = Bench::new();
    pairs(&bench);
    let [left, right, out, folder] =
        ["left.png", "right.png", "out", "frames/left"].map(|name| at(&bench, name));
    let odd = bench.put("odd.png", &encode(&GrayImage::new(65, 8), ImageFormat::Png)).display().to_string();
    let refused = |args: &[&str], culprit: &str| {
        bench.refused(&[&["match", "--out", &out], &SEARCH[..], args].concat(), culprit);
    };
    refused(&["--left", &left], "--right");
    refused(&["--side-by-side", &left, "--left", &left], "--side-by-side");
    refused(&["--side-by-side", &odd], "odd.png: has an odd number of columns");
    refused(&["--side-by-side", "-"], "--side-by-side -: --raw is missing");
    refused(&["--left", &left, "--right", &right, "--raw", "64x8"], "--raw");
    for raw in ["63x8", "30x8", "64", "64x0", "8192x8", "x"] {
        refused(&["--side-by-side", "-", "--raw", raw], "--raw");
    }
    refused(&["--left", &at(&bench, "no*.png"), "--right", &at(&bench, "no*.png")], "there is no such file");
    refused(&["--left", &folder, "--right", &right], "is not a file");
    let pair = ["--left", &left, "--right", &right];
    let settings = |value: &'static str| [&pair[..], &["--settings", value]].concat();
    // These choose the method themselves.
    let alone = |args: &[&str], culprit: &str| {
        bench.refused(&[&["match", "--out", &out, "--disparities", "32"], args].concat(), culprit);
    };
    alone(&settings("fast,best"), "fast, block, sgm-lean, sgm and sgm-edge");
    alone(&settings("sgm:soft"), "dense, default and strict");
    alone(&settings("fast,block,fast"), "--settings: fast is given twice");
    alone(&settings("sgm:strict:low:more"), "METHOD:FILTER:NOISE");
    alone(&["--left", &folder, "--right", &folder, "--settings", "fast"], "--settings: is for one pair");
    refused(&settings("fast"), "--settings");
}
