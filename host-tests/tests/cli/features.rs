//! `stereo features`: its file, its picture, and what it says when it cannot.

use super::support::{Bench, encode, names, stereo, text};
use image::{GrayImage, ImageFormat, Luma, imageops};
use std::fs;
use stereopsis_host::scene::Random;

/// Two pictures of spots whose greys do not repeat, the second one 7 columns to the left and 3 rows up.
fn put_spots(bench: &Bench) -> [String; 2] {
    let spots = GrayImage::from_fn(200, 150, |x, y| {
        let (cell, inside) = ([x / 9, y / 9], [x % 9, y % 9]);
        let grey = Random::new(u64::from(cell[0] * 100 + cell[1])).below(12) * 23;
        Luma([if inside[0] < 6 && inside[1] < 5 { grey as u8 } else { 40 }])
    });
    [("first.png", 0, 0), ("second.png", 7, 3)].map(|(name, x, y)| {
        let part = imageops::crop_imm(&spots, x, y, 180, 140).to_image();
        bench.put(name, &encode(&part, ImageFormat::Png)).display().to_string()
    })
}

#[test]
fn matches_are_lines_under_a_header() {
    let bench = Bench::new();
    let [left, right] = put_spots(&bench);
    let (out, picture) = (bench.path("new/matches.csv"), bench.path("new/matches.png"));
    let (out_text, picture_text) = (out.display().to_string(), picture.display().to_string());
    let mut arguments = vec!["features", "--left", &left, "--right", &right, "--out", &out_text];
    arguments.extend(["--picture", &picture_text, "--levels", "1"]);
    let run = stereo(&arguments);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    assert_eq!(names(&bench.path("new")), ["matches.csv", "matches.png"]);
    let drawn = image::open(&picture).expect("a picture").into_rgb8();
    assert_eq!(drawn.dimensions(), (364, 140));

    let lines = fs::read_to_string(&out).expect("a file");
    let mut lines = lines.lines();
    assert_eq!(lines.next(), Some("x1,y1,x2,y2"));
    let matches: Vec<[f32; 4]> = lines
        .map(|line| {
            let numbers: Vec<f32> = line.split(',').map(|n| n.parse().expect("a number")).collect();
            numbers.try_into().expect("four numbers")
        })
        .collect();
    assert!(matches.len() > 40, "{} matches", matches.len());
    assert!(text(&run.stdout).contains(&format!("{} matches\n", matches.len())), "{}", text(&run.stdout));
    let right = |[x1, y1, x2, y2]: &&[f32; 4]| (x1 - x2 - 7.0).abs() < 0.1 && (y1 - y2 - 3.0).abs() < 0.1;
    assert_eq!(matches.iter().filter(right).count(), matches.len());

    // Nothing else may match where partners lie in the same row.
    arguments.extend(["--rows-apart", "1"]);
    assert!(text(&stereo(&arguments).stdout).contains(" 0 matches\n"));
    assert_eq!(fs::read_to_string(&out).expect("a file"), "x1,y1,x2,y2\n");
}

#[test]
fn an_image_too_small_for_corners_has_none() {
    let bench = Bench::new();
    let [left, _] = put_spots(&bench);
    let small =
        bench.put("small.png", &encode(&GrayImage::new(1, 1), ImageFormat::Png)).display().to_string();
    let out = bench.path("matches.csv").display().to_string();
    let run = stereo(["features", "--left", &left, "--right", &small, "--out", &out]);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    assert!(text(&run.stdout).contains(" 0 matches\n"), "{}", text(&run.stdout));
}

#[test]
fn what_cannot_be_done_is_named() {
    let bench = Bench::new();
    let [left, right] = put_spots(&bench);
    let (out, folder) =
        (bench.path("matches.csv").display().to_string(), bench.path("").display().to_string());
    let missing = bench.path("missing.png").display().to_string();
    let broken = bench.put("broken.png", b"no picture").display().to_string();
    let below = format!("{left}/matches.csv");
    let good = ["features", "--left", &left, "--right", &right, "--out", &out];
    let change = |option: &str, value: &str| {
        let mut arguments: Vec<String> = good.iter().map(|&a| a.to_owned()).collect();
        match arguments.iter().position(|a| a == option) {
            Some(at) => arguments[at + 1] = value.to_owned(),
            None => arguments.extend([option.to_owned(), value.to_owned()]),
        }
        arguments
    };
    for (option, value, culprit) in [
        ("--left", missing.as_str(), "missing.png"),
        ("--right", &broken, "broken.png"),
        ("--out", &folder, "--out"),
        ("--out", &below, "first.png"),
        ("--out", "/proc/matches.csv", "/proc"),
        ("--picture", &folder, "--picture"),
        ("--picture", &out, "--picture"),
        ("--picture", &below, "first.png"),
        ("--corners", "49", "--corners"),
        ("--corners", "12001", "--corners"),
        ("--contrast", "0", "--contrast"),
        ("--contrast", "255", "--contrast"),
        ("--levels", "0", "--levels"),
        ("--levels", "9", "--levels"),
        ("--ratio", "101", "--ratio"),
        ("--ratio", "-1", "--ratio"),
        ("--rows-apart", "x", "--rows-apart"),
        ("--columns-apart", "4097", "--columns-apart"),
        ("--orientation", "sideways", "--orientation"),
        ("--method", "orb", "--method"),
    ] {
        bench.refused(&change(option, value), culprit);
    }
    bench.refused(&good[..5], "--out");
    bench.refused(&["features", "--left", &left, "--out", &out], "--right");
}
