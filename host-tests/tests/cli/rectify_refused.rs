//! What `stereo rectify` says when it cannot.

use super::rectify::{opencv, raw, with};
use super::support::{Bench, HEIGHT, WIDTH, calibration, encode, stereo, text};
use image::{GrayImage, ImageFormat};

#[test]
fn a_calibration_that_is_wrong_is_named() {
    let bench = Bench::new();
    let arguments = raw(&bench);
    let good = opencv();
    let instead = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        good.replacen(from, to, 1)
    };
    let cases = [
        (good.split_at(good.find("T: ").expect("T")).0.to_owned(), "T is missing"),
        (instead("K2: !!opencv-matrix", "K3: !!opencv-matrix"), "K2 is missing"),
        (instead("100., 0., 47.5", ".Nan, 0., 47.5"), "K1"),
        (instead("[ -0.2, 0., 0. ]", "[ .Inf, 0., 0. ]"), "line 33"),
        (instead("[ -0.2, 0., 0. ]", "[ inf, 0., 0. ]"), "T: a number is not finite"),
        (instead("[ 1., 0., 0., 0., 1., 0.", "[ 2., 0., 0., 0., 1., 0."), "R: the matrix is no rotation"),
        (instead("[ -0.2, 0., 0. ]", "[ 0.2, 0., 0. ]"), "swapped"),
        (instead("[ -0.2, 0., 0. ]", "[ 0., 0., 0. ]"), "the baseline is zero"),
        (instead("[ -0.2, 0., 0. ]", "[ -200., 0., 0. ]"), "--unit mm"),
        (instead("image_width: 96", "image_width: 640"), "width says 640"),
        (instead("image_height: 48", "image_height: -48"), "no size of an image"),
        ("P0: 1 2 3\nP1: 1 2 3\n".into(), "P0"),
        (String::new(), "empty"),
        ("hello\n".into(), "no calibration of two cameras"),
    ];
    for (content, culprit) in cases {
        let file = bench.put("bad.yml", content.as_bytes()).display().to_string();
        bench.refused(&with(&arguments, "--calib", &file), culprit);
        bench.refused(&with(&arguments, "--calib", &file), "bad.yml: ");
    }
    let bytes = bench.put("bytes.yml", &[0; 4000]).display().to_string();
    bench.refused(&with(&arguments, "--calib", &bytes), "bytes.yml: is no text file");
    let missing = bench.path("none.yml").display().to_string();
    bench.refused(&with(&arguments, "--calib", &missing), "none.yml: cannot be read");
    // The second of two files.
    for (file, culprit) in [(&bytes, "bytes.yml: "), (&missing, "none.yml: ")] {
        let mut both = arguments.clone();
        both.extend(["--calib".to_owned(), file.clone()]);
        bench.refused(&both, culprit);
        both.extend(["--calib".to_owned(), file.clone()]);
        bench.refused(&both, "--calib: is given more than twice");
    }
    // Millimetres, when they are said to be.
    let file = bench
        .put("mm.yml", instead("[ -0.2, 0., 0. ]", "[ -200., 0., 0. ]").as_bytes())
        .display()
        .to_string();
    let run = stereo(with(&with(&arguments, "--calib", &file), "--unit", "mm"));
    assert!(run.status.success() && text(&run.stdout).contains("baseline 0.2000 m"), "{}", text(&run.stderr));
}

#[test]
fn options_and_places_that_are_wrong_are_named() {
    let bench = Bench::new();
    let arguments = raw(&bench);
    for option in ["--left", "--right", "--calib", "--out"] {
        let mut without = arguments.clone();
        let at = without.iter().position(|argument| argument == option).expect("an option");
        without.drain(at..at + 2);
        bench.refused(&without, option);
    }
    for alpha in ["-0.1", "1.1", "nan", "x", ""] {
        bench.refused(&with(&arguments, "--alpha", alpha), "--alpha");
    }
    bench.refused(&with(&arguments, "--unit", "inch"), "--unit");
    let missing = bench.path("missing.png").display().to_string();
    bench.refused(&with(&arguments, "--left", &missing), "missing.png");
    let small = bench.put("small.png", &encode(&GrayImage::new(WIDTH, HEIGHT - 1), ImageFormat::Png));
    bench.refused(&with(&arguments, "--right", &small.display().to_string()), "small.png");
    let file = bench.put("file", b"content").display().to_string();
    bench.refused(&with(&arguments, "--out", &file), "is not a folder");
    bench.refused(&with(&arguments, "--out", &format!("{file}/below")), "file/below");
    bench.refused(&with(&arguments, "--out", "/proc"), "/proc");
    std::fs::create_dir_all(bench.path("taken/rectified.json")).expect("a folder in the way");
    bench.refused(&with(&arguments, "--out", &bench.path("taken").display().to_string()), "rectified.json");
    // Rectified already: nothing is to be done, and it is.
    let calib = bench.put("calib.txt", calibration(WIDTH, HEIGHT).as_bytes()).display().to_string();
    let run = stereo(with(&arguments, "--calib", &calib));
    assert!(
        run.status.success() && text(&run.stdout).contains("Middlebury calibration"),
        "{}",
        text(&run.stderr)
    );
}
