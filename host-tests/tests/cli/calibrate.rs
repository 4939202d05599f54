//! `stereo calibrate` and `stereo calib`: their files, and what they say when they cannot.

use super::support::{Bench, encode, names, program, stereo, text};
use image::ImageFormat;
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::io::Write;
use std::process::Stdio;
use stereopsis::geometry::camera::{Camera, Distortion, ImageSize, Pose, StereoRig};
use stereopsis_host::calibrate::board::Pattern;
use stereopsis_host::calibrate::scene::BoardCamera;
use stereopsis_host::scene::Random;

const SIZE: ImageSize = ImageSize { width: 240, height: 180 };
const VIEWS: [[f64; 6]; 5] = [
    [0.4, 0.0, 0.1, 0.08, 0.0, 10.0],
    [-0.4, 0.2, -0.2, 0.0, -0.1, 11.0],
    [0.1, 0.5, 0.3, 0.2, -0.1, 11.0],
    [0.2, -0.5, 0.0, 0.0, 0.1, 11.0],
    [-0.3, -0.4, 1.5, 0.15, 0.05, 11.0],
];

fn rig() -> StereoRig<f64> {
    let camera = |f: f64, k1: f64| {
        let camera = Camera::new(f, f, 119.0, 91.0).expect("a camera");
        camera.with_distortion(Distortion::from_opencv([k1, 0.05, 0.0, 0.0, 0.0])).expect("a lens")
    };
    let pose = Pose::new(Matrix3::identity(), Vector3::new(0.06, 0.001, 0.0)).expect("a pose");
    StereoRig::new([camera(180.0, -0.2), camera(181.0, -0.19)], pose, [SIZE; 2]).expect("a rig")
}

/// Pairs of a board with squares of 30 mm, `left1.png` to `right5.png`, and one with nothing to see.
pub fn pictures(bench: &Bench) {
    let (pattern, mut random) = (Pattern::new(6, 5).expect("a pattern"), Random::new(7));
    let cameras = BoardCamera::pair(&rig());
    let middle = Vector3::new(2.5, 2.0, 0.0);
    for (n, [a, b, c, x, y, z]) in (1..).zip(VIEWS) {
        let r = Rotation3::new(Vector3::new(a, b, c)).into_inner();
        let left = Pose::new(r, Vector3::new(x, y, 1.0) * z - r * middle).expect("a pose");
        let beside = Pose::new(Matrix3::identity(), rig().pose().translation() / 0.03).expect("a pose");
        for ((camera, side), board) in
            cameras.iter().zip(["left", "right"]).zip([left, beside.inverse().then(&left)])
        {
            camera.corners(pattern, &board).expect("all in the image");
            let picture = camera.picture(pattern, &board, 1.0, &mut random);
            bench.put(&format!("{side}{n}.png"), &encode(&picture, ImageFormat::Png));
        }
    }
    for side in ["left", "right"] {
        let blank = image::GrayImage::new(240, 180);
        bench.put(&format!("{side}6.png"), &encode(&blank, ImageFormat::Png));
    }
}

pub fn arguments(bench: &Bench, change: &[(&str, &str)]) -> Vec<String> {
    let file = |name: &str| bench.path(name).display().to_string();
    let mut options = std::collections::BTreeMap::from([
        ("--left", file("left?.png")),
        ("--right", file("right?.png")),
        ("--pattern", "6x5".into()),
        ("--square-mm", "30".into()),
        ("--out", file("stereo.yml")),
    ]);
    options.extend(change.iter().map(|(option, value)| (*option, (*value).to_owned())));
    let options = options.into_iter().flat_map(|(option, value)| [option.to_owned(), value]);
    ["calibrate".to_owned()].into_iter().chain(options).collect()
}

#[test]
fn a_rig_is_calibrated_checked_and_converted() {
    let bench = Bench::new();
    pictures(&bench);
    let file = |name: &str| bench.path(name).display().to_string();
    let run = stereo(arguments(&bench, &[("--report", &file("report"))]));
    let (said, notes) = (text(&run.stdout), text(&run.stderr));
    assert!(run.status.success(), "{notes}");
    // The sixth has no board.
    assert!(notes.contains("left6.png: no board with 6 x 5 inner corners is seen"), "{notes}");
    assert!(said.contains("5 of 6 views, 240 x 180 px\n"), "{said}");
    // The boards stay near the middle of these pictures.
    let covered: Vec<f64> = said
        .lines()
        .find_map(|line| line.strip_prefix("coverage"))
        .expect("a line of the coverage")
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    assert!(covered[..2].iter().all(|&percent| (20.0..100.0).contains(&percent)), "{said}");
    let is_little = covered[0].min(covered[1]) < 60.0;
    assert_eq!(notes.contains("note: the boards reach only"), is_little, "{said}");
    let baseline: f64 = said
        .lines()
        .find_map(|line| line.strip_prefix("baseline")?.trim().split(' ').next()?.parse().ok())
        .unwrap_or_else(|| panic!("{said}"));
    assert!((baseline - 60.0).abs() < 0.6, "{said}");
    let drawn = ["index.html", "view001.png", "view002.png", "view003.png", "view004.png", "view005.png"];
    assert_eq!(names(&bench.path("report")), drawn);
    let page = std::fs::read_to_string(bench.path("report/index.html")).expect("a page");
    assert!(page.contains("The stronger the colour") && page.matches("<svg ").count() == 2, "{page}");
    assert!(page.contains("baseline ") && page.contains("What would make it better"), "{page}");
    // Boards in the middle tell the turn along the baseline and the principal points not apart well.
    let yaw = said.lines().find(|line| line.starts_with("yaw ")).unwrap_or_else(|| panic!("{said}"));
    let [.., sigma, _] = yaw.split(' ').collect::<Vec<_>>()[..] else { panic!("{yaw}") };
    let is_weak = sigma.parse::<f64>().expect("a number") > 0.2;
    assert_eq!(notes.contains("(yaw) is weakly determined"), is_weak, "{said}");

    // It is read by all that read calibrations.
    let check = |name: &str| {
        let run = stereo(["calib", "check", "--calib", &file(name)]);
        assert!(run.status.success(), "{}", text(&run.stderr));
        text(&run.stdout)
    };
    let words = check("stereo.yml");
    assert!(
        words.starts_with("OpenCV calibration, images of 240 x 180 px\n") && words.contains("right of"),
        "{words}"
    );
    assert!(words.contains("nothing looks wrong"), "{words}");
    assert!(words.contains("\nfirmware     RemapPair<240, "), "{words}");
    let convert = |from: &str, to: &str, out: &str| {
        let run = stereo(["calib", "convert", "--calib", &file(from), "--to", to, "--out", &file(out)]);
        assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
        std::fs::read(bench.path(out)).expect("a file")
    };
    assert_eq!(convert("stereo.yml", "record", "rig.bin").len(), 328);
    assert!(text(&convert("rig.bin", "rust", "rig.rs")).contains("pub const STEREO_RIG: [u8; 328]"));
    assert!(
        text(&convert("rig.bin", "c", "rig.h")).contains("static const uint8_t stereo_rig[STEREO_RIG_BYTES]")
    );
    convert("rig.bin", "opencv", "again.yml");
    let rest = |words: &str| words.split_once('\n').map(|(_, rest)| rest.to_owned());
    assert_eq!(rest(&check("again.yml")), rest(&words));
    assert!(check("rig.bin").starts_with("record calibration"));

    // A record of raw cameras is no calibration of rectified images.
    let record = file("rig.bin");
    let (left, right, out) = (file("left1.png"), file("right1.png"), file("out"));
    let matched = [
        "match",
        "--left",
        &left,
        "--right",
        &right,
        "--disparities",
        "16",
        "--calib",
        &record,
        "--out",
        &out,
    ];
    bench.refused(&matched.map(str::to_owned), "rig.bin: says how the cameras are mounted");
    // What is swapped in a file is noticed by all that read it.
    let yaml = std::fs::read_to_string(bench.path("stereo.yml")).expect("text");
    let (head, tail) = yaml.split_once("T: ").expect("T");
    bench.put("exchanged.yml", format!("{head}T: {}", tail.replacen("[ -", "[ ", 1)).as_bytes());
    let (exchanged, none) = (file("exchanged.yml"), file("none.bin"));
    let convert = ["calib", "convert", "--calib", &exchanged, "--to", "record", "--out", &none];
    bench.refused(&convert.map(str::to_owned), "exchanged.yml: the second camera stands left of the first");
    bench.refused(&["calib", "check", "--calib", &exchanged].map(str::to_owned), "swapped");

    // Other lenses, from the same images.
    for lens in ["rational", "fisheye"] {
        let run = stereo(arguments(&bench, &[("--lens", lens), ("--out", &file("lens.yml"))]));
        let said = text(&run.stdout);
        assert!(run.status.success() && said.contains("5 of 6 views"), "{lens}: {said}{}", text(&run.stderr));
        let written = std::fs::read_to_string(bench.path("lens.yml")).expect("a file");
        assert_eq!(written.contains("fisheye"), lens == "fisheye", "{written}");
    }
    bench.refused(&arguments(&bench, &[("--lens", "wide")]), "--lens");

    // Swapped: the left camera stands right.
    let swapped = [("--left", file("right?.png")), ("--right", file("left?.png"))];
    let swapped = swapped.each_ref().map(|(option, value)| (*option, value.as_str()));
    bench.refused(&arguments(&bench, &swapped), "swapped");

    // A record that is broken, or cut.
    let record = std::fs::read(bench.path("rig.bin")).expect("a record");
    let mut broken = record.clone();
    broken[100] ^= 8;
    for (bytes, culprit) in [(&broken[..], "checksum"), (&record[..100], "328 bytes")] {
        let bad = bench.put("bad.bin", bytes).display().to_string();
        bench.refused(&["calib", "check", "--calib", &bad], culprit);
        bench
            .refused(&["calib", "convert", "--calib", &bad, "--to", "c", "--out", &file("x.h")], "bad.bin: ");
    }
}

#[test]
fn options_that_are_wrong_are_named() {
    let bench = Bench::new();
    let file = |name: &str| bench.path(name).display().to_string();
    for (option, values) in [
        ("--pattern", &["", "9", "9x", "2x6", "9x65", "ax6"][..]),
        ("--square-mm", &["0", "-25", "nan", "1001", "x"]),
        ("--left", &["/nowhere/left*.png", "["]),
        ("--out", &["/proc", "/"]),
    ] {
        for value in values {
            bench.refused(&arguments(&bench, &[(option, value)]), option);
        }
    }
    bench.refused(&arguments(&bench, &[("--square-mm", "0.025")]), "is it in metres?");
    let pair = [("--left", file("left.png")), ("--right", file("right.png"))];
    let one = pair.each_ref().map(|(option, value)| (*option, value.as_str()));
    bench.refused(&arguments(&bench, &one), "0 views are too few");
    let bad = bench.put("bad.png", b"no picture").display().to_string();
    bench.refused(&arguments(&bench, &[("--left", &bad), ("--right", &file("right.png"))]), "bad.png");
    let uneven = [("--left", file("*.png")), ("--right", file("right.png"))];
    let uneven = uneven.each_ref().map(|(option, value)| (*option, value.as_str()));
    bench.refused(&arguments(&bench, &uneven), "as many of both");

    bench.refused(&["calib"], "check");
    bench.refused(&["calib", "check"], "--calib");
    let calib = bench.put("stereo.yml", b"cam0=[1 0 1; 0 1 1; 0 0 1]\n").display().to_string();
    bench.refused(&["calib", "check", "--calib", &calib], "cam1 is missing");
    bench.refused(&["calib", "convert", "--calib", &calib, "--to", "word", "--out", &file("x")], "--to");
    bench.refused(&["calib", "check", "--calib", &calib, "--size", "640"], "--size");
}

#[test]
fn what_looks_wrong_is_said() {
    let bench = Bench::new();
    let yaml = |t: &str, unit: &str, cx: f64, size: &str| {
        let camera = |n: u32| {
            format!("K{n}: [200., 0., {cx}, 0., 210., 90., 0., 0., 1.]\nD{n}: [0., 0., 0., 0., 0.]\n")
        };
        format!(
            "{size}{}{}{unit}R: [1., 0., 0., 0., 1., 0., 0., 0., 1.]\nT: [{t}, 0., 0.]\n",
            camera(1),
            camera(2)
        )
    };
    let size = "image_width: 240\nimage_height: 180\n";
    let check = |content: String, more: &[&str]| {
        let path = bench.put("rig.yml", content.as_bytes()).display().to_string();
        let arguments: Vec<_> =
            ["calib", "check", "--calib", &path].into_iter().chain(more.iter().copied()).collect();
        let run = stereo(&arguments);
        if run.status.success() { text(&run.stdout) } else { text(&run.stderr) }
    };
    let words = check(yaml("-0.06", "", 119.5, size), &[]);
    assert!(words.contains("baseline     60.00 mm") && words.contains("pixels are not square"), "{words}");
    assert!(check(yaml("-0.06", "", 40.0, size), &[]).contains("far from the middle"));
    // 60 of something: millimetres.
    assert!(check(yaml("-60.0", "", 119.5, size), &[]).contains("--unit mm"));
    assert!(check(yaml("-60.0", "", 119.5, size), &["--unit", "mm"]).contains("60.00 mm"));
    assert!(check(yaml("-60.0", "length_unit: mm\n", 119.5, size), &[]).contains("60.00 mm"));
    assert!(
        check(yaml("-60.0", "length_unit: mm\n", 119.5, size), &["--unit", "m"]).contains("leave --unit out")
    );
    assert!(check(yaml("-60.0", "length_unit: feet\n", 119.5, size), &[]).contains("m, cm or mm"));
    assert!(check(yaml("-6.0", "", 119.5, size), &[]).contains("was T in another unit?"));
    assert!(check(yaml("0.06", "", 119.5, size), &[]).contains("swapped"));
    assert!(check(yaml("-0.06", "", 119.5, ""), &[]).contains("--size"));
    assert!(check(yaml("-0.06", "", 119.5, ""), &["--size", "240x180"]).contains("240 x 180"));
    assert!(check(yaml("-0.06", "", 119.5, size), &["--size", "240x181"]).contains("height says 180"));
}

/// A calibration through a pipe, which can be read once only.
#[cfg(unix)]
#[test]
fn a_calibration_comes_through_a_pipe() {
    const KITTI: &str = "P0: 700 0 600 0 0 700 180 0 0 0 1 0\nP1: 700 0 600 -350 0 700 180 0 0 0 1 0\n";
    let piped = |bytes: &[u8]| {
        let mut check = program();
        check.args(["calib", "check", "--calib", "/dev/stdin"]);
        check.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut check = check.spawn().expect("the program starts");
        check.stdin.take().expect("a pipe").write_all(bytes).expect("the program reads");
        check.wait_with_output().expect("the program ends")
    };
    let run = piped(KITTI.as_bytes());
    assert!(run.status.success() && text(&run.stdout).contains("500.00 mm"), "{}", text(&run.stderr));
    let record = rig().to_record();
    let run = piped(&record);
    assert!(run.status.success() && text(&run.stdout).contains("baseline"), "{}", text(&run.stderr));
    let run = piped(b"");
    assert!(!run.status.success() && text(&run.stderr).contains("/dev/stdin"), "{}", text(&run.stderr));
}

#[test]
fn markers_are_given_as_the_board_has_them() {
    let bench = Bench::new();
    pictures(&bench);
    for (case, fault) in [
        (("--marker-mm", "29"), "a marker's side is .4 to .9 of the side of a square, 30 mm here"),
        (("--pattern", "15x9"), "16 x 10 squares hold 80 markers, and the dictionary has 50"),
        (("--lens", "brown"), "eight corners and markers that agree"),
    ] {
        bench.refused(&arguments(&bench, &[("--markers", "4x4_50"), ("--marker-mm", "22"), case]), fault);
    }
}
