//! `stereo focus`: its files, and what it says when it cannot.

use super::support::{Bench, encode, names, stereo, text};
use image::{GrayImage, ImageFormat, Luma, imageops};
use std::fs;
use stereopsis_host::pfm;

const WIDTH: u32 = 60;
const HEIGHT: u32 = 40;

/// Seven frames of spots in `stack`: sharp in the third on the left half, in the fifth on the right.
fn put_stack(bench: &Bench) -> String {
    let folder = bench.path("stack");
    fs::create_dir(&folder).expect("a folder");
    let spots = GrayImage::from_fn(WIDTH, HEIGHT, |x, y| {
        Luma([((x * x * 7 + y * y * 13 + x * y * 5) % 11 * 23) as u8])
    });
    for frame in 1..=7_u32 {
        let blurred = |best: u32| imageops::blur(&spots, 0.3 + 0.5 * frame.abs_diff(best) as f32);
        let (left, right) = (blurred(3), blurred(5));
        let all =
            GrayImage::from_fn(WIDTH, HEIGHT, |x, y| *if x < 30 { &left } else { &right }.get_pixel(x, y));
        fs::write(folder.join(format!("frame{frame}.png")), encode(&all, ImageFormat::Png)).expect("a file");
    }
    fs::write(folder.join("notes.txt"), "no frame").expect("a file");
    folder.display().to_string()
}

fn map(bench: &Bench, name: &str) -> pfm::FloatMap {
    let file = fs::read(bench.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    pfm::read(&mut file.as_slice()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

#[test]
fn frames_count_from_one_and_depth_needs_a_lens() {
    let bench = Bench::new();
    let (stack, out) = (put_stack(&bench), bench.path("new/out").display().to_string());
    let positions = |text: &str| bench.put("positions.csv", text.as_bytes()).display().to_string();
    // 4 mm behind the lens is infinity; 4.1 mm is 164 mm.
    let file = positions("frame,image_distance_mm\n1,4.05\n2,4.06\n3,4.07\n4,4.08\n5,4.09\n6,4.10\n7,4.11\n");
    let plain = ["focus", "--frames", &stack, "--out", &out];
    let mut with_lens = plain.to_vec();
    with_lens.extend(["--focal-length-mm", "4", "--positions", &file]);

    let run = stereo(&with_lens);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    assert!(text(&run.stdout).starts_with("7 frames of 60 x 40 pixels, "), "{}", text(&run.stdout));
    assert_eq!(
        names(&bench.path("new/out")),
        ["all_in_focus.png", "confidence.pfm", "depth.pfm", "index.pfm", "index_colour.png", "report.html"]
    );
    let index = map(&bench, "new/out/index.pfm");
    let confidence = map(&bench, "new/out/confidence.pfm");
    let depth = map(&bench, "new/out/depth.pfm");
    assert_eq!((index.width, index.height), (60, 40));
    for (x, frame, millimetres) in [(15, 3.0, 4.0 * 4.07 / 0.07), (45, 5.0, 4.0 * 4.09 / 0.09)] {
        let at = 20 * 60 + x;
        assert!((index.values[at] - frame).abs() < 0.3, "{}", index.values[at]);
        assert!(confidence.values[at] > 0.3 && confidence.values[at] <= 1.0, "{}", confidence.values[at]);
        assert!(
            (depth.values[at] * 1000.0 / millimetres - 1.0).abs() < 0.1,
            "{} {millimetres}",
            depth.values[at]
        );
    }
    // The same distances as those of what is in focus, and without a header.
    let same = |file: &str| {
        let mut arguments = plain.to_vec();
        arguments.extend(["--focal-length-mm", "4", "--positions", file]);
        let run = stereo(&arguments);
        assert!(run.status.success(), "{}", text(&run.stderr));
        let other = map(&bench, "new/out/depth.pfm");
        let pairs = depth.values.iter().zip(&other.values);
        assert!(pairs.clone().all(|(a, b)| a == b || (a / b - 1.0).abs() < 1e-3));
    };
    same(&positions("4.05\n4.06\n4.07\n4.08\n4.09\n4.10\n4.11\n"));
    let objects: Vec<String> = (5..=11)
        .map(|i| format!("{}\n", 4.0 * (4.0 + 0.01 * f64::from(i)) / (0.01 * f64::from(i))))
        .collect();
    same(&positions(&format!("focus_distance_mm\n{}", objects.concat())));
    same(&positions(&objects.concat()));

    // Without a lens there is no depth, and none is left of before.
    assert!(stereo(plain).status.success());
    assert_eq!(
        names(&bench.path("new/out")),
        ["all_in_focus.png", "confidence.pfm", "index.pfm", "index_colour.png", "report.html"]
    );
}

#[test]
fn what_cannot_be_done_is_named() {
    let bench = Bench::new();
    let (stack, out) = (put_stack(&bench), bench.path("out").display().to_string());
    let missing = bench.path("missing").display().to_string();
    let good = ["focus", "--frames", &stack, "--out", &out];
    bench.refused(&["focus", "--frames", &missing, "--out", &out], "missing");
    bench.refused(&good[..3], "--out");
    bench.refused(&["focus", "--out", &out], "--frames");
    let file = bench.put("file", b"").display().to_string();
    bench.refused(&["focus", "--frames", &stack, "--out", &file], "is not a folder");
    bench.refused(&["focus", "--frames", &file, "--out", &out], "file");
    let with = |focal: &str, positions: &str| {
        let mut arguments = good.to_vec();
        arguments.extend(["--focal-length-mm", focal, "--positions", positions]);
        arguments.iter().map(|a| (*a).to_owned()).collect::<Vec<_>>()
    };
    let lines = "4.05\n4.06\n4.07\n4.08\n4.09\n4.10\n";
    let positions = bench.put("positions.csv", format!("{lines}4.11\n").as_bytes()).display().to_string();
    for focal in ["0", "-4", "x", "nan", "1e9"] {
        bench.refused(&with(focal, &positions), "--focal-length-mm");
    }
    bench.refused(&good.iter().copied().chain(["--focal-length-mm", "4"]).collect::<Vec<_>>(), "--positions");
    bench.refused(
        &good.iter().copied().chain(["--positions", &positions]).collect::<Vec<_>>(),
        "--focal-length-mm",
    );
    for (text, culprit) in [
        (lines.to_owned(), "6 positions for 7 frames"),
        (format!("{lines}x\n"), "line 7"),
        (format!("{lines}4.0\n"), "line 7"),
        (format!("{lines}4.01\n"), "position 7"),
        (format!("{lines}4.11\n4.12\n"), "more than 7 positions"),
        (String::new(), "0 positions"),
    ] {
        let bad = bench.put("bad.csv", text.as_bytes()).display().to_string();
        bench.refused(&with("4", &bad), culprit);
        bench.refused(&with("4", &bad), "bad.csv");
    }
    bench.refused(&with("4", &missing), "missing");

    for (name, content) in [
        ("frame4.png", b"no picture".to_vec()),
        ("frame9.png", encode(&GrayImage::new(60, 41), ImageFormat::Png)),
        ("frame0.jpg", encode(&GrayImage::new(9, 9), ImageFormat::Jpeg)),
    ] {
        let path = bench.path("stack").join(name);
        let before = fs::read(&path).ok();
        fs::write(&path, content).expect("a file");
        bench.refused(&good, if name == "frame0.jpg" { "frame1.png" } else { name });
        match before {
            Some(content) => fs::write(&path, content).expect("a file"),
            None => fs::remove_file(&path).expect("a file"),
        }
    }
    for frame in 1..=5 {
        fs::remove_file(bench.path("stack").join(format!("frame{frame}.png"))).expect("a file");
    }
    bench.refused(&good, "has 2 images");
}

#[test]
fn frames_of_a_camera_that_moves_are_doubted() {
    let bench = Bench::new();
    let turn = bench.path("turn").display().to_string();
    let run = stereo(["walk", "--scene", "turn", "--frames", "12", "--width", "200", "--out", &turn]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let (frames, out) = (format!("{turn}/left"), bench.path("out").display().to_string());
    let run = stereo(["focus", "--force", "--frames", &frames, "--out", &out]);
    let said = text(&run.stderr);
    assert!(run.status.success() && said.contains("is it a focus stack?"), "{said}");
}
