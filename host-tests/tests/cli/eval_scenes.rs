//! `stereo eval`: scenes that are matched here, beside `stereo match` and OpenCV, and numbered results.

use super::eval::{evaluated, put, steps};
use super::support::{Bench, FAR, HEIGHT, NEAR, WIDTH, encode, pair, stereo, text};
use image::{ImageFormat, imageops};
use serde_json::Value;
use std::fs;
use stereopsis_host::pfm;

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

/// A picture in two colours of one luma by the weights of Rec. 709, by those of BT.601 not: an image in
/// another grey than the matcher's has nothing left to match.
#[test]
fn no_noise_changes_nothing_of_a_picture_in_colours() {
    let bench = Bench::new();
    let (scenes, _) = squares(&bench);
    for (file, grey) in ["left.png", "right.png"].into_iter().zip(<[_; 2]>::from(pair())) {
        let colours = image::RgbImage::from_fn(WIDTH, HEIGHT, |x, y| {
            let red = grey[(x, y)].0[0];
            image::Rgb([red, (166.0 - 0.2973 * f64::from(red)).round() as u8, 40])
        });
        let mut bytes = std::io::Cursor::new(Vec::new());
        colours.write_to(&mut bytes, ImageFormat::Png).expect("memory");
        put(&bench, &format!("scenes/squares/{file}"), &bytes.into_inner());
    }
    let arguments = ["--scenes", &scenes, "--method", "block"];
    let plain = evaluated(&arguments);
    assert!(plain["mean"]["missed"].as_f64().is_some_and(|missed| missed < 0.3), "{plain}");
    let same = evaluated(&[&arguments[..], &["--altered", "noise:0"]].concat());
    assert_eq!(by_name(&same), by_name(&plain));
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
    fs::write(&python, "#!/bin/sh\n").expect("a file");
    bench.refused(&["eval", "--scenes", &scenes, "--opencv", &python], "is no Python: it prints no version");
}
