//! `stereo rectify`: its files, and what it says when it cannot.

use super::support::{Bench, HEIGHT, WIDTH, encode, names, pair, stereo, text};
use image::{GrayImage, ImageFormat, Luma};
use serde_json::Value;
use stereopsis_host::scene::Scene;

/// Rows that the right camera stands too high in its housing: its picture is as far down.
const DOWN: u32 = 4;

/// The calibration of such a pair, in metres.
pub fn opencv() -> String {
    let camera = |n: u32, cy: f64| {
        format!(
            "K{n}: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 100., 0., 47.5, 0., 100., \
             {cy}, 0., 0., 1. ]\nD{n}: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ 0., \
             0., 0., 0., 0. ]\n"
        )
    };
    format!(
        "%YAML:1.0\n---\nimage_width: {WIDTH}\nimage_height: {HEIGHT}\n{}{}\
         R: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n\
         \x20  data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]\n\
         T: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n\
         \x20  data: [ -0.2, 0., 0. ]\n",
        camera(1, 23.5),
        camera(2, 23.5 + f64::from(DOWN))
    )
}

/// A raw pair, its calibration, and the command for them.
pub fn raw(bench: &Bench) -> Vec<String> {
    let right = pair().1;
    let lower = GrayImage::from_fn(WIDTH, HEIGHT, |x, y| *right.get_pixel(x, y.saturating_sub(DOWN)));
    let file = |path: std::path::PathBuf| path.display().to_string();
    let right = file(bench.put("lower.png", &encode(&lower, ImageFormat::Png)));
    let calib = file(bench.put("stereo.yml", opencv().as_bytes()));
    let (left, out) = (file(bench.path("left.png")), file(bench.path("out")));
    ["rectify", "--left", &left, "--right", &right, "--calib", &calib, "--out", &out]
        .map(str::to_owned)
        .into()
}

/// The command with another value of an option, or with one more.
pub fn with(arguments: &[String], option: &str, value: &str) -> Vec<String> {
    let mut arguments = arguments.to_vec();
    match arguments.iter().position(|argument| argument == option) {
        Some(at) => arguments[at + 1] = value.to_owned(),
        None => arguments.extend([option.to_owned(), value.to_owned()]),
    }
    arguments
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

#[test]
fn rows_are_aligned_and_the_new_cameras_reported() {
    let bench = Bench::new();
    let arguments = raw(&bench);
    let run = stereo(&arguments);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    assert!(
        text(&run.stdout).starts_with("96 x 48 px, horizontal, OpenCV calibration\n"),
        "{}",
        text(&run.stdout)
    );
    let files = ["left.png", "rectified.json", "right.png", "valid_left.png", "valid_right.png"];
    assert_eq!(names(&bench.path("out")), files);

    // Both go halfway, by whole rows: every pixel is one of the raw pictures.
    let picture = |name: &str| {
        let opened = image::open(bench.path("out").join(name)).expect(name);
        assert_eq!(opened.color(), image::ColorType::L8, "{name}");
        opened.into_luma8()
    };
    let halfway = DOWN / 2;
    let seen = |row: u32, raw: &GrayImage, x: u32| (row < HEIGHT).then(|| raw.get_pixel(x, row).0[0]);
    let lower = image::open(bench.path("lower.png")).expect("the raw one").into_luma8();
    let expected = |is_right: bool, x: u32, y: u32| {
        if is_right { seen(y + halfway, &lower, x) } else { seen(y.wrapping_sub(halfway), &pair().0, x) }
    };
    for (is_right, name) in [(false, "left.png"), (true, "right.png")] {
        let grey = GrayImage::from_fn(WIDTH, HEIGHT, |x, y| Luma([expected(is_right, x, y).unwrap_or(0)]));
        let mask =
            GrayImage::from_fn(WIDTH, HEIGHT, |x, y| Luma([expected(is_right, x, y).map_or(0, |_| 255)]));
        assert!(picture(name) == grey, "{name}");
        assert!(picture(&format!("valid_{name}")) == mask, "the mask of {name}");
    }

    let told = std::fs::read(bench.path("out/rectified.json")).expect("rectified.json");
    let told: Value = serde_json::from_slice(&told).expect("JSON");
    let mut all = keys(&told);
    all.sort_unstable();
    let expected =
        "axis baseline_m calibration common cx cy field_of_view_deg focal_px height left q right width";
    assert_eq!(all.join(" "), expected);
    for side in ["left", "right"] {
        let mut all = keys(&told[side]);
        all.sort_unstable();
        assert_eq!(all.join(" "), "largest_warp_px projection rotation rows seen");
    }
    let near = |value: &Value, expected: f64| {
        let found = value.as_f64().expect("a number");
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    };
    assert_eq!(
        (&told["axis"], &told["width"], &told["height"]),
        (&"horizontal".into(), &96.into(), &48.into())
    );
    near(&told["left"]["largest_warp_px"], f64::from(halfway));
    near(&told["right"]["largest_warp_px"], f64::from(halfway));
    near(&told["focal_px"], 100.0);
    near(&told["cy"], 25.5);
    near(&told["baseline_m"], 0.2);
    near(&told["right"]["projection"][0][3], -20.0);
    // A disparity of 12 px is 100 px * 0.2 m / 12 px.
    let q = |row: usize, column: usize| told["q"][row][column].as_f64().expect("a number");
    near(&(q(2, 3) / (12.0 * q(3, 2) + q(3, 3))).into(), 100.0 * 0.2 / 12.0);

    // What was rectified can be matched.
    let file = |name: &str| bench.path("out").join(name).display().to_string();
    let matched = bench.matched(&[
        ("--left", &file("left.png")),
        ("--right", &file("right.png")),
        ("--out", &bench.path("depth").display().to_string()),
    ]);
    assert!(text(&matched.stdout).contains("median 5."), "{}", text(&matched.stdout));
}

#[test]
fn a_raw_pair_is_matched_in_one_loop() {
    let bench = Bench::new();
    raw(&bench);
    let file = |name: &str| bench.path(name).display().to_string();
    let (lower, calib) = (file("lower.png"), file("stereo.yml"));
    let change = [("--right", lower.as_str()), ("--calib", calib.as_str()), ("--out", &file("raw"))];
    let rectify = |change: &[(&str, &str)]| {
        let mut arguments = bench.arguments(change);
        arguments.push("--rectify".into());
        arguments
    };
    let run = stereo(rectify(&change));
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    assert!(
        text(&run.stdout).contains("camera       f 100.00 px, baseline 0.2000 m"),
        "{}",
        text(&run.stdout)
    );
    for name in ["depth.pfm", "rectified_left.png", "rectified_right.png", "rectified.json", "report.html"] {
        assert!(names(&bench.path("raw")).contains(&name.to_owned()), "{name}");
    }
    // The background is 5 px away from itself. The left camera saw nothing of two rows above, the right one
    // of two below.
    let summary = std::fs::read(bench.path("raw/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_slice(&summary).expect("JSON");
    assert!(
        (summary["depth"]["found_m"]["median"].as_f64().expect("a depth") - 4.0).abs() < 0.1,
        "{summary}"
    );
    let flags = image::open(bench.path("raw/flags.png")).expect("flags").into_luma8();
    let depth = image::open(bench.path("raw/depth.png")).expect("depths").into_luma16();
    for (x, y, flags) in flags.enumerate_pixels() {
        let is_seen = [y >= DOWN / 2, y < HEIGHT - DOWN / 2];
        assert!(is_seen == [true; 2] || depth.get_pixel(x, y).0[0] == 0, "{x} {y}");
        assert!(is_seen[0] || flags.0[0] == 1, "{x} {y} {}", flags.0[0]);
    }
    // A run without takes away what only this one wrote.
    bench.matched(&[("--out", &file("raw"))]);
    assert!(!names(&bench.path("raw")).contains(&"rectified.json".to_owned()));

    bench.refused(&rectify(&[]), "--calib");
    bench.refused(&bench.arguments(&[("--alpha", "0")]), "--alpha");
    bench.refused(&bench.arguments(&[("--unit", "mm")]), "--unit");
    let bad =
        bench.put("bad.yml", opencv().replacen("-0.2, 0.", "0.2, 0.", 1).as_bytes()).display().to_string();
    bench.refused(&rectify(&[("--calib", &bad)]), "swapped");
    let below =
        bench.put("below.yml", opencv().replacen("-0.2, 0.", "0., -0.2", 1).as_bytes()).display().to_string();
    bench.refused(&rectify(&[("--calib", &below)]), "below each other");
}

/// Without a calibration: a vertical offset that matches tell.
#[test]
fn rows_are_aligned_by_matches_alone() {
    let bench = Bench::new();
    let mut arguments = raw(&bench);
    let at = arguments.iter().position(|argument| argument == "--calib").expect("an option");
    arguments.drain(at..at + 2);
    bench.refused(&arguments, "--calib");
    let put = |name: &str, points: &dyn Fn(f64, f64, f64) -> (f64, f64), count: u32| {
        let line = |i: u32| {
            let (x, y) = (f64::from(30 + i * 17 % 60), f64::from(3 + i * 11 % 40));
            let (x2, y2) = points(x, y, f64::from(i * i % 7));
            format!("{x},{y},{x2},{y2}\n")
        };
        let text: String = ["x1,y1,x2,y2\n".to_owned()].into_iter().chain((0..count).map(line)).collect();
        bench.put(name, text.as_bytes()).display().to_string()
    };
    let beside = |x: f64, y: f64, near: f64| (x - 4.0 - 3.5 * near, y + f64::from(DOWN));
    let good = with(&arguments, "--matches", &put("good.csv", &beside, 40));
    let run = stereo(&good);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    assert!(text(&run.stdout).contains("without a calibration"), "{}", text(&run.stdout));
    let files = ["left.png", "rectified.json", "right.png", "valid_left.png", "valid_right.png"];
    assert_eq!(names(&bench.path("out")), files);
    let told = std::fs::read(bench.path("out/rectified.json")).expect("rectified.json");
    let told: Value = serde_json::from_slice(&told).expect("JSON");
    assert!(
        told["calibration"].is_null() && told["row_error_px"].as_f64().is_some_and(|px| px < 0.01),
        "{told}"
    );
    // The same point is in the same row, left of where it is in the left image.
    let image_of = |side: usize, x: f64, y: f64| {
        let h =
            |row: usize, column: usize| told["homographies"][side][row][column].as_f64().expect("a number");
        let row = |i: usize| h(i, 0) * x + h(i, 1) * y + h(i, 2);
        (row(0) / row(2), row(1) / row(2))
    };
    let (first, second) = (image_of(0, 50.0, 20.0), image_of(1, 43.0, 24.0));
    assert!((first.1 - second.1).abs() < 0.01 && first.0 > second.0, "{first:?} {second:?}");
    let shown = image::open(bench.path("out/valid_right.png")).expect("a mask").into_luma8();
    assert!(shown.iter().filter(|&&seen| seen == 255).count() > 96 * 48 / 2);
    // What is not seen has no answers, and nothing has a depth.
    let file = |name: &str| bench.path("out").join(name).display().to_string();
    let (left, right, cameras, out) =
        (file("left.png"), file("right.png"), file("rectified.json"), file("matched"));
    let matched = ["match", "--left", &left, "--right", &right, "--disparities", "32", "--out", &out];
    let run = stereo(matched.iter().chain(&["--calib", &cameras]));
    assert!(run.status.success() && text(&run.stderr).contains("of matches alone"), "{}", text(&run.stderr));
    let flags = image::open(bench.path("out/matched/flags.png")).expect("flags").into_luma8();
    let seen = image::open(bench.path("out/valid_left.png")).expect("a mask").into_luma8();
    assert!(seen.contains(&0));
    assert!(seen.iter().zip(flags.iter()).all(|(&seen, &flag)| seen != 0 || flag == 1));
    assert!(!bench.path("out/matched/depth.png").exists());
    let depths = [&matched[..], &["--calib", &cameras, "--max-depth", "5"]].concat();
    bench.refused(&depths, "knows no depths");

    let forward = |x: f64, y: f64, _| {
        let by = 1.01 + 0.012 * ((7.0 * x + 13.0 * y) % 11.0);
        (47.5 + (x - 47.5) * by, 23.5 + (y - 23.5) * by)
    };
    for (file, culprit) in [
        (put("few.csv", &beside, 5), "few.csv: "),
        (put("forward.csv", &forward, 40), "forward.csv: "),
        (put("outside.csv", &|x, y, _| (x + 90.0, y), 40), "outside"),
        (bench.path("none.csv").display().to_string(), "none.csv: cannot be read"),
    ] {
        bench.refused(&with(&arguments, "--matches", &file), culprit);
    }
    let both = with(&good, "--calib", &bench.path("stereo.yml").display().to_string());
    bench.refused(&both, "--calib");
    bench.refused(&with(&good, "--alpha", "0"), "--alpha");
}

/// Rows are far apart when the wrong camera is taken for the left one: nothing but the other order fits.
#[test]
fn swapped_raw_cameras_are_refused() {
    const DEEP: u32 = 20;
    let bench = Bench::new();
    let (left, right) = Scene::demo().render();
    let (width, height) = left.dimensions();
    let lower = GrayImage::from_fn(width, height, |x, y| *right.get_pixel(x, y.saturating_sub(DEEP)));
    let file = |name: &str, picture: &GrayImage| {
        bench.put(name, &encode(picture, ImageFormat::Png)).display().to_string()
    };
    let [left, right] = [file("demo.png", &left), file("lower.png", &lower)];
    let calib = opencv()
        .replace(&format!("image_width: {WIDTH}"), &format!("image_width: {width}"))
        .replace(&format!("image_height: {HEIGHT}"), &format!("image_height: {height}"))
        .replace("47.5", &format!("{}", f64::from(width - 1) / 2.0))
        .replace("23.5,", &format!("{},", f64::from(height - 1) / 2.0))
        .replace("27.5,", &format!("{},", f64::from(height - 1) / 2.0 + f64::from(DEEP)))
        .replace("100.,", &format!("{width}.,"));
    let calib = bench.put("deep.yml", calib.as_bytes()).display().to_string();
    let out = bench.path("out").display().to_string();
    let order = |left: &str, right: &str, more: &[&str]| {
        let words = ["match", "--rectify", "--calib", &calib, "--left", left, "--right", right];
        let search = ["--disparities", "64", "--method", "fast", "--out", &out];
        [&words[..], &search, more].concat().into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    bench.refused(&order(&right, &left, &[]), "exchange left and right, or give --force");
    for good in [order(&left, &right, &[]), order(&right, &left, &["--force"])] {
        let run = stereo(&good);
        assert!(run.status.success(), "{}", text(&run.stderr));
    }
}
