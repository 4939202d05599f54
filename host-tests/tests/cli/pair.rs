//! What `match` says of a pair before it matches it.

use super::results::json;
use super::support::{Bench, stereo, text};
use stereopsis_host::scene::Scene;

/// The options of `match` for two pictures of the demonstration scene.
pub fn arguments(bench: &Bench, left: &str, right: &str, disparities: &str) -> Vec<String> {
    let (of_left, of_right) = Scene::demo().render();
    of_left.save(bench.path("a.png")).expect("a picture");
    of_right.save(bench.path("b.png")).expect("a picture");
    let path = |name: &str| bench.path(name).display().to_string();
    let words = ["match", "--left", &path(left), "--right", &path(right), "--disparities", disparities];
    words.map(String::from).into_iter().chain(["--out".into(), path("out")]).collect()
}

#[test]
fn swapped_cameras_are_refused_unless_forced() {
    let bench = Bench::new();
    let mut swapped = arguments(&bench, "b.png", "a.png", "64");
    bench.refused(&swapped, "exchange left and right");
    swapped.push("--force".into());
    let run = stereo(&swapped);
    assert!(run.status.success() && text(&run.stderr).contains("swapped"), "{}", text(&run.stderr));
    assert_eq!(json(&bench.path("out/summary.json"))["pair"]["fault"], "swapped");
    // No search is found for them.
    for word in swapped.iter_mut().filter(|word| *word == "64") {
        *word = "auto".into();
    }
    bench.refused(&swapped, "give a number with --force");
}

#[test]
fn a_search_keeps_what_is_near() {
    // Everything is 210 to 380 px off, in images 800 px wide.
    let bench = Bench::new();
    let grey = |x: i64, y: u32| {
        let bits = (x as u64 / 3).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let bits = bits ^ u64::from(y / 3).wrapping_mul(0xbf58_476d);
        let bits = (bits ^ (bits >> 29)).wrapping_mul(0x94d0_49bb_1331_11eb);
        image::Luma([(bits >> 40) as u8])
    };
    let disparity = |y: u32| 210 + i64::from(y / 40 * 34);
    let picture =
        |by: i64| image::GrayImage::from_fn(800, 240, |x, y| grey(i64::from(x) + by * disparity(y), y));
    picture(0).save(bench.path("l.png")).expect("a picture");
    picture(1).save(bench.path("r.png")).expect("a picture");
    let run = stereo(arguments(&bench, "l.png", "r.png", "auto"));
    assert!(run.status.success(), "{}", text(&run.stderr));
    let summary = json(&bench.path("out/summary.json"));
    let [first, count] =
        ["min_disparity", "disparities"].map(|name| summary[name].as_i64().expect("a number"));
    assert!(first <= 210 && first + count > 380, "{first}, {count}: {}", text(&run.stderr));
}

#[test]
fn the_same_picture_twice_is_said() {
    let bench = Bench::new();
    let run = stereo(arguments(&bench, "a.png", "a.png", "64"));
    assert!(run.status.success() && text(&run.stderr).contains("same picture"), "{}", text(&run.stderr));
}

#[test]
fn a_short_search_is_said_and_auto_finds_one() {
    let bench = Bench::new();
    let run = stereo(arguments(&bench, "a.png", "b.png", "16"));
    let said = text(&run.stderr);
    let needed = json(&bench.path("out/summary.json"))["pair"]["search"].clone();
    assert!(said.contains(&format!("--min-disparity {} --disparities {}", needed[0], needed[1])), "{said}");
    let run = stereo(arguments(&bench, "a.png", "b.png", "auto"));
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let summary = json(&bench.path("out/summary.json"));
    assert_eq!((&summary["min_disparity"], &summary["disparities"]), (&needed[0], &needed[1]));
    assert!(summary["pair"]["fault"].is_null());
}

#[test]
fn figures_are_printed_as_json_or_not_at_all() {
    let bench = Bench::new();
    let arguments = arguments(&bench, "a.png", "b.png", "64");
    let with = |option: &str| stereo(arguments.iter().map(String::as_str).chain([option]));
    let run = with("--json");
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let printed: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
    assert_eq!(printed, json(&bench.path("out/summary.json")));
    assert_eq!(printed["command"][1], "match");
    assert_eq!(printed["inputs"].as_array().map(Vec::len), Some(2));
    let run = with("--quiet");
    assert!(run.status.success() && run.stdout.is_empty() && run.stderr.is_empty(), "{}", text(&run.stdout));
}

#[test]
fn a_calibration_of_rectified_images_is_checked_as_match_takes_it() {
    let bench = Bench::new();
    let file = "cam0=[999.421 0 294.182; 0 999.421 252.932; 0 0 1]\ncam1=[999.421 0 326.96; 0 999.421 \
                252.932; 0 0 1]\ndoffs=32.778\nbaseline=193.001\nwidth=741\nheight=497\n";
    let file = bench.put("calib.txt", file.as_bytes()).display().to_string();
    let run = stereo(["calib", "check", "--calib", &file, "--disparities", "64"]);
    let said = text(&run.stdout);
    // 999.421 px x 0.193001 m / (63 px + 32.778 px)
    assert!(run.status.success() && said.contains("from 2.014 m (63 px"), "{said}");
    // Parallaxes of 0 px + 32.778 px, where 5 % would be at 64.3 m, and of 127 px + 32.778 px.
    for line in [
        " of a search of 64) to 5.885 m (0 px)\n",
        "accuracy     within 5 % up to 5.88 m: one standard deviation\n",
        "limit        the search: depths are told from 2.014 m on\n",
        "change       --disparities 128 would begin at 1.207 m\n",
        "limit        the search: nothing lies beyond 5.885 m, at 0 px\n",
    ] {
        assert!(said.contains(line), "{line}{said}");
    }
    // A range is planned for as by `plan`: 63.67 px at 2 m and 5.8 px at 5 m.
    let range = ["calib", "check", "--calib", &file, "--nearest", "2", "--farthest", "5", "--accuracy", "1"];
    let said = text(&stereo(range).stdout);
    for line in [
        "search       --disparities 64 --min-disparity 2\n",
        "limit        none: all that is wanted is had\n",
        "both see     at  2.00 m  91 % of the columns, 1.36 m across\n",
    ] {
        assert!(said.contains(line), "{line}{said}");
    }
    let both =
        ["calib", "check", "--calib", &file, "--nearest", "2", "--farthest", "5", "--disparities", "64"];
    assert_eq!(stereo(both).status.code(), Some(2));
    let turned = stereo(["calib", "check", "--calib", &file, "--nearest", "5", "--farthest", "2"]);
    assert!(text(&turned.stderr).contains("--nearest 5: is not nearer than --farthest 2"));
}

#[test]
fn depths_and_colours_come_without_a_file() {
    let bench = Bench::new();
    let mut args = arguments(&bench, "a.png", "b.png", "64");
    args.extend(["--focal-px", "500", "--baseline-mm", "100", "--colour-range", "0:64"].map(String::from));
    let run = stereo(&args);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let depth = json(&bench.path("out/summary.json"))["depth"].clone();
    assert_eq!((depth["focal_px"].as_f64(), depth["png_unit_m"].as_f64()), (Some(500.0), Some(0.001)));
    // 500 px x 0.1 m / 62 px: the last disparity that is no ceiling
    assert!((depth["nearest_m"].as_f64().expect("a depth") - 50.0 / 62.0).abs() < 1e-3, "{depth}");
    let coloured = |args: &[String]| {
        assert!(stereo(args).status.success());
        image::open(bench.path("out/disparity_colour.png")).expect("a picture").into_rgb8()
    };
    let page_has_own = || {
        let page = std::fs::read_to_string(bench.path("out/report.html")).expect("a page");
        page.contains("2nd to the 98th percentile")
    };
    let given = coloured(&args);
    assert!(!page_has_own());
    args.truncate(args.len() - 2);
    // The search is the range where none is given, whatever the answers are; the page has their own.
    assert!(given == coloured(&args) && page_has_own());
    let narrow: Vec<_> = args.iter().cloned().chain(["--colour-range".into(), "0:32".into()]).collect();
    let light = |picture: &image::RgbImage| picture.iter().map(|&c| u64::from(c)).sum::<u64>();
    assert!(light(&coloured(&narrow)) > light(&given));
    let below: Vec<_> = args.iter().cloned().chain(["--colour-range".into(), "-8:64".into()]).collect();
    assert!(light(&coloured(&below)) > light(&given));
    for wrong in ["64:0", "1", "a:b", "0:0"] {
        let wrong: Vec<_> = args.iter().cloned().chain(["--colour-range".into(), wrong.into()]).collect();
        assert_eq!(stereo(&wrong).status.code(), Some(2));
    }
}

#[test]
fn a_field_of_view_stands_for_a_focal_length() {
    let bench = Bench::new();
    let with = |more: &[&str]| {
        let mut args = arguments(&bench, "a.png", "b.png", "64");
        args.extend(more.iter().map(|&arg| arg.to_owned()));
        stereo(&args)
    };
    for option in ["--field-of-view", "--fov"] {
        let run = with(&[option, "60", "--baseline-mm", "100"]);
        assert!(run.status.success(), "{}", text(&run.stderr));
        let summary = json(&bench.path("out/summary.json"));
        let width = summary["width"].as_f64().expect("a width");
        let focal = summary["depth"]["focal_px"].as_f64().expect("a focal length");
        assert!((focal - width / 2.0 * 3f64.sqrt()).abs() < 0.01, "{focal} px of {width} columns");
    }
    let both = ["--focal-px", "500", "--fov", "60", "--baseline-mm", "100"];
    for wrong in
        [&["--fov", "60"][..], &["--baseline-mm", "100"], &["--fov", "0", "--baseline-mm", "1"], &both]
    {
        assert_eq!(with(wrong).status.code(), Some(2), "{wrong:?}");
    }
}

#[test]
fn masks_take_answers_away() {
    let bench = Bench::new();
    let args = arguments(&bench, "a.png", "b.png", "64");
    let scene = Scene::demo();
    let (width, height) = (u32::from(scene.width()), u32::from(scene.height()));
    let left = image::GrayImage::from_fn(width, height, |_, y| image::Luma([255 * u8::from(y >= 20)]));
    left.save(bench.path("left.png")).expect("a mask");
    image::GrayImage::from_pixel(width, height, image::Luma([255]))
        .save(bench.path("right.png"))
        .expect("a mask");
    image::GrayImage::from_pixel(8, 8, image::Luma([255])).save(bench.path("small.png")).expect("a mask");
    let path = |name: &str| bench.path(name).display().to_string();
    let with = |right: &str| {
        let masks = ["--valid-left".to_owned(), path("left.png"), "--valid-right".to_owned(), path(right)];
        args.iter().cloned().chain(masks).collect::<Vec<_>>()
    };
    bench.refused(&with("small.png"), "small.png");
    image::GrayImage::new(width, height).save(bench.path("black.png")).expect("a mask");
    let black = text(&stereo(with("black.png")).stderr);
    assert!(black.contains("the mask of the right image is black") && !black.contains("features"), "{black}");
    let run = stereo(with("right.png"));
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let flags = image::open(bench.path("out/flags.png")).expect("flags").into_luma8();
    assert!(flags.enumerate_pixels().all(|(_, y, flag)| y >= 20 || flag.0[0] == 1));
    assert!(flags.enumerate_pixels().any(|(_, y, flag)| y >= 20 && flag.0[0] == 0));

    // Beside the cameras that rectify writes they are found.
    let rectified = "{\"width\": 640, \"height\": 480, \"focal_px\": 500, \"q\": [[1, 0, 0, -319.5], \
                     [0, 1, 0, -239.5], [0, 0, 0, 500], [0, 0, 12.5, 0]]}";
    let calib = bench.put("rectified.json", rectified.as_bytes()).display().to_string();
    std::fs::copy(bench.path("left.png"), bench.path("valid_left.png")).expect("a mask");
    std::fs::copy(bench.path("right.png"), bench.path("valid_right.png")).expect("a mask");
    let run = stereo(args.iter().chain([&"--calib".to_owned(), &calib]));
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    assert_eq!(image::open(bench.path("out/flags.png")).expect("flags").into_luma8(), flags);
}

#[test]
fn few_answers_are_explained() {
    let bench = Bench::new();
    let args = arguments(&bench, "white.png", "whiter.png", "64");
    for (name, grey) in [("white.png", 254), ("whiter.png", 255)] {
        image::GrayImage::from_pixel(160, 120, image::Luma([grey]))
            .save(bench.path(name))
            .expect("a picture");
    }
    let run = stereo(&args);
    let said = text(&run.stderr);
    assert!(run.status.success() && said.contains("only 0.0 % of the pixels have an answer"), "{said}");
    assert!(said.contains("100 % without texture, 100 % over-exposed"), "{said}");
    // Something covers the right lens.
    let (width, height) = image::image_dimensions(bench.path("left.png")).expect("a picture");
    let covered = image::GrayImage::from_pixel(width, height, image::Luma([3]));
    covered.save(bench.path("covered.png")).expect("a picture");
    let run = stereo(arguments(&bench, "left.png", "covered.png", "64"));
    let said = text(&run.stderr);
    assert!(said.contains("100 % without texture in the right image; flags"), "{said}");
    // What was asked for, and masks that show little.
    let mut asked = arguments(&bench, "a.png", "b.png", "64");
    asked.extend(["--min-confidence", "207"].map(String::from));
    let said = text(&stereo(&asked).stderr);
    assert!(
        said.contains("--min-confidence 207 refuses what is less sure") && !said.contains("filled"),
        "{said}"
    );
    let mut masked = arguments(&bench, "a.png", "b.png", "64");
    let (width, height) = image::image_dimensions(bench.path("a.png")).expect("a picture");
    image::GrayImage::new(width, height).save(bench.path("nothing.png")).expect("a mask");
    for side in ["--valid-left", "--valid-right"] {
        masked.extend([side.to_owned(), bench.path("nothing.png").display().to_string()]);
    }
    let said = text(&stereo(&masked).stderr);
    assert!(said.contains("100 % outside of the masks"), "{said}");
}
