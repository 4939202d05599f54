//! `fundamental` and `pose`: matches in, one JSON file out, or one line and nothing.

use super::support::{Bench, encode, stereo, text};
use image::{GrayImage, ImageFormat, Rgb, imageops};
use serde_json::Value;
use std::fmt::Write;

/// Focal length and principal point of both cameras, px.
const CAMERA: (f64, f64, f64) = (500.0, 320.0, 240.0);

/// Matches of a scene before two cameras that look alike, the second one 0.8 to the right and 0.6 ahead: t =
/// (0.8, 0, 0.6), R = 1. Every fifth match is wrong when asked; `flat` puts the scene on a wall.
pub fn matches(count: usize, wrong: bool, flat: bool) -> String {
    let (f, cx, cy) = CAMERA;
    let mut text = "x1,y1,x2,y2\n".to_owned();
    for i in 0..count {
        let fraction = |step: f64| (i as f64 * step).fract();
        let (x, y) = (4.0 * fraction(0.618_034) - 2.0, 3.0 * fraction(0.754_877) - 1.5);
        let z = if flat { 6.0 + 0.4 * x - 0.3 * y } else { 5.0 + 3.0 * fraction(0.569_840) };
        let (mut u, v) = (f * (x - 0.8) / (z - 0.6) + cx, f * y / (z - 0.6) + cy);
        let mut below = v;
        if wrong && i % 5 == 0 {
            (u, below) = (640.0 * fraction(0.414_214), 480.0 * fraction(0.732_051));
        }
        writeln!(text, "{:.6},{:.6},{u:.6},{below:.6}", f * x / z + cx, f * y / z + cy).expect("to a string");
    }
    text
}

fn calibration() -> String {
    let (f, cx, cy) = CAMERA;
    format!("cam0=[{f} 0 {cx}; 0 {f} {cy}; 0 0 1]\ncam1=[{f} 0 {cx}; 0 {f} {cy}; 0 0 1]\n")
}

pub fn arguments(bench: &Bench, command: &str, extra: &[&str]) -> Vec<String> {
    let file = |name: &str| bench.path(name).display().to_string();
    let mut all =
        vec![command.to_owned(), "--matches".into(), file("m.csv"), "--out".into(), file("out/answer.json")];
    if command == "pose" {
        all.extend(["--calib".to_owned(), file("calib.txt")]);
    }
    all.extend(extra.iter().map(|&option| option.to_owned()));
    all
}

fn answer(bench: &Bench, command: &str, extra: &[&str]) -> Value {
    let run = stereo(arguments(bench, command, extra));
    assert!(run.status.success() && run.stderr.is_empty(), "{command} {extra:?}: {}", text(&run.stderr));
    let json = std::fs::read(bench.path("out/answer.json")).expect("the answer");
    serde_json::from_slice(&json).expect("an object")
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list").iter();
    list.flat_map(|v| if v.is_array() { numbers(v) } else { vec![v.as_f64().expect("a number")] }).collect()
}

/// The bools, as how many of the right and of the wrong matches are kept.
fn kept(value: &Value) -> (usize, usize) {
    let list = value["inliers"].as_array().expect("a list").iter().enumerate();
    let of = |wrong: bool| {
        list.clone().filter(|(i, v)| (i % 5 == 0) == wrong && v.as_bool().expect("true or false")).count()
    };
    (of(false), of(true))
}

pub fn bench(matches: &str) -> Bench {
    let bench = Bench::new();
    bench.put("m.csv", matches.as_bytes());
    bench.put("calib.txt", calibration().as_bytes());
    bench
}

#[test]
fn fundamental_finds_the_wrong_ones() {
    let bench = bench(&matches(100, true, false));
    let first = answer(&bench, "fundamental", &["--seed", "7"]);
    let (right, wrong) = kept(&first);
    assert!(right == 80 && wrong <= 3, "{right} {wrong}");
    // F = K^-T [t]x K^-1 with t = (0.8, 0, 0.6): p^T F p' = 0 for (320, 240) of the one and (320 - 400/5.4
    // ...) says the file itself: every right line.
    let f = numbers(&first["fundamental"]);
    for line in matches(100, true, false)
        .lines()
        .skip(1)
        .enumerate()
        .filter(|(i, _)| i % 5 != 0)
        .map(|(_, line)| line)
    {
        let m: Vec<f64> = line.split(',').map(|word| word.parse().expect("a number")).collect();
        let (p, q) = ([m[0], m[1], 1.0], [m[2], m[3], 1.0]);
        let along = |row: usize| (0..3).map(|j| f[3 * row + j] * q[j]).sum::<f64>();
        let slope = along(0).hypot(along(1));
        let residual: f64 = (0..3).map(|i| p[i] * along(i)).sum();
        assert!((residual / slope).abs() < 0.01, "{line}: {} px", residual / slope);
    }
    assert!(first["time_us"].as_f64().expect("a number") > 0.0);
    assert!(first["miss_probability"].as_f64().expect("a number") <= 1e-3);
    let again = answer(&bench, "fundamental", &["--seed", "7"]);
    assert_eq!(first["fundamental"], again["fundamental"]);
    assert_eq!(first["inliers"], again["inliers"]);
}

#[test]
fn fundamental_by_eight_points() {
    let bench = bench(&matches(40, false, false));
    let found = answer(&bench, "fundamental", &["--method", "eight-point", "--threshold", "0.01"]);
    assert_eq!(kept(&found), (32, 8));
    assert!(found.get("samples").is_none());
}

#[test]
fn a_picture_of_epipolar_lines() {
    let bench = bench(&matches(100, true, false));
    let put = |name, width, height| {
        bench.put(name, &encode(&GrayImage::new(width, height), ImageFormat::Png)).display().to_string()
    };
    let (left, right, small) = (put("l.png", 640, 480), put("r.png", 640, 500), put("small.png", 200, 480));
    let lines = bench.path("out/lines.png").display().to_string();
    answer(&bench, "fundamental", &["--left", &left, "--right", &right, "--picture", &lines]);
    let drawn = image::open(&lines).expect("a picture").into_rgb8();
    assert_eq!(drawn.dimensions(), (1284, 500));
    // Wrong ones in red at both ends, lines from the left edge to the right edge of both images.
    let red = |p: &Rgb<u8>| p.0 == [230, 40, 40];
    for begin in [0, 644] {
        let image = imageops::crop_imm(&drawn, begin, 0, 640, 480).to_image();
        assert!(image.pixels().filter(|p| red(p)).count() > 15 * 8);
        for column in [0, 639] {
            let crossing = (0..480).filter(|&y| image.get_pixel(column, y).0 != [0; 3]).count();
            assert!(crossing >= 10, "{crossing} lines reach column {column}");
        }
    }
    let missing = bench.path("missing.png").display().to_string();
    let out = bench.path("out/answer.json").display().to_string();
    for (images, culprit) in [
        (["--left", &small, "--right", &right, "--picture", &lines].as_slice(), "--left"),
        (&["--left", &left, "--right", &small, "--picture", &lines], "--right"),
        (&["--left", &left, "--right", &missing, "--picture", &lines], "missing.png"),
        (&["--left", &left, "--right", &right, "--picture", &out], "--picture"),
        (&["--left", &left, "--right", &right], "--picture"),
        (&["--left", &left, "--picture", &lines], "--right"),
        (&["--picture", &lines], "--left"),
    ] {
        bench.refused(&arguments(&bench, "fundamental", images), culprit);
    }
}

#[test]
fn pose_of_the_second_camera() {
    for (flat, model) in [(false, "fundamental"), (true, "homography")] {
        let bench = bench(&matches(100, true, flat));
        let found = answer(&bench, "pose", &[]);
        assert_eq!(found["model"], model);
        let (right, wrong) = kept(&found);
        assert!(right == 80 && wrong <= 3, "{right} {wrong}");
        let t = numbers(&found["translation"]);
        assert!((t.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-9, "{t:?}");
        assert_eq!(found["points"].as_array().expect("a list").len(), 100);
        if flat {
            // Of a wall two poses have all points in front: either is an answer.
            continue;
        }
        let rotation = numbers(&found["rotation"]);
        let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        assert!(rotation.iter().zip(identity).all(|(a, b)| (a - b).abs() < 1e-4), "{rotation:?}");
        assert!(t.iter().zip([0.8, 0.0, 0.6]).all(|(a, b)| (a - b).abs() < 1e-3), "{t:?}");
        // E = [t]x R, over its sign.
        let e = numbers(&found["essential"]);
        let expected = [0.0, -0.6, 0.0, 0.6, 0.0, -0.8, 0.0, 0.8, 0.0];
        let sign = e[3].signum();
        assert!(e.iter().zip(expected).all(|(a, b)| (sign * a - b).abs() < 1e-3), "{e:?}");
        // The second match, in baselines of length one.
        let point = numbers(&found["points"][1]);
        let (x, y) = (4.0 * 0.618_034 - 2.0, 3.0 * 0.754_877 - 1.5);
        let z = 5.0 + 3.0 * 0.569_840;
        assert!(point.iter().zip([x, y, z]).all(|(a, b)| (a - b).abs() < 0.01 * z), "{point:?}");
    }
}

/// One camera for both images, whose lens draws in what is `r` from the middle to `r - 0.3 r^3`, and no
/// farther than 0.7.
fn with_a_lens(matches: &str) -> (String, String) {
    let (f, cx, cy) = CAMERA;
    let mut lines = matches.lines();
    let mut text = format!("{}\n", lines.next().expect("a header"));
    for line in lines {
        let [a, b, c, d]: [f64; 4] = std::array::from_fn(|i| {
            line.split(',').nth(i).and_then(|number| number.parse().ok()).expect("a number")
        });
        let [(a, b), (c, d)] = [(a, b), (c, d)].map(|(u, v)| {
            let (x, y) = ((u - cx) / f, (v - cy) / f);
            let scale = 1.0 - 0.3 * (x * x + y * y);
            (f * x * scale + cx, f * y * scale + cy)
        });
        writeln!(text, "{a:.6},{b:.6},{c:.6},{d:.6}").expect("to a string");
    }
    let calibration = format!(
        "image_width: 640\nimage_height: 480\ncamera_name: c\ncamera_matrix: {{rows: 3, cols: 3, data: \
         [{f}, 0, {cx}, 0, {f}, {cy}, 0, 0, 1]}}\ndistortion_model: plumb_bob\ndistortion_coefficients: \
         {{rows: 1, cols: 5, data: [-0.3, 0, 0, 0, 0]}}\n"
    );
    (text, calibration)
}

#[test]
fn a_match_that_the_lens_has_no_sight_for_is_no_inlier() {
    let (file, calibration) = with_a_lens(&matches(100, true, false));
    let bench = bench(&file);
    bench.put("calib.txt", calibration.as_bytes());
    let without = answer(&bench, "pose", &[]);
    let (right, wrong) = kept(&without);
    assert!(right == 80 && wrong <= 3, "{right} {wrong}");
    let (header, rest) = file.split_once('\n').expect("lines");
    bench.put("m.csv", format!("{header}\n1200,240,320,240\n{rest}320,240,320,900\n").as_bytes());
    let run = stereo(arguments(&bench, "pose", &[]));
    let said = text(&run.stderr);
    assert!(run.status.success() && said.contains("no sight for 2 of 102 matches"), "{said}");
    let json = std::fs::read(bench.path("out/answer.json")).expect("the answer");
    let mut with: Value = serde_json::from_slice(&json).expect("an object");
    for list in ["inliers", "points"] {
        let list = with[list].as_array_mut().expect("a list");
        assert_eq!(list.len(), 102);
        let ends = [list.remove(0), list.pop().expect("the last")];
        assert!(ends.iter().all(|end| *end == Value::Null || *end == Value::Bool(false)), "{ends:?}");
    }
    assert_eq!(with, without);
    bench.put("m.csv", format!("{header}\n{}", "1200,240,320,240\n".repeat(20)).as_bytes());
    bench.refused(&arguments(&bench, "pose", &[]), "no sight for any of 20 matches");
}

#[test]
fn what_may_agree_by_chance_is_said() {
    // So many right ones, and ten that are wrong.
    for (right, is_doubtful) in [(13, true), (18, false)] {
        let (all, wrong) = (matches(right, false, false), matches(50, true, false));
        let wrong = wrong.lines().skip(1).step_by(5).map(|line| format!("{line}\n"));
        let bench = bench(&(all + &wrong.collect::<String>()));
        for command in ["fundamental", "pose"] {
            let run = stereo(arguments(&bench, command, &[]));
            let said = text(&run.stderr);
            assert!(run.status.success(), "{command}, {right}: {said}");
            assert_eq!(said.contains("sets of unrelated ones"), is_doubtful, "{command}, {right}: {said}");
            let json = std::fs::read(bench.path("out/answer.json")).expect("the answer");
            let answer: Value = serde_json::from_slice(&json).expect("an object");
            let log10 = answer["log10_false_alarms"].as_f64().expect("a number");
            assert_eq!((-2.0..0.0).contains(&log10), is_doubtful, "{command}, {right}: {log10}");
        }
    }
}
