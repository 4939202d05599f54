//! What `match` says of a calibration that cannot be that of its images.

use super::pair::arguments;
use super::results::json;
use super::support::{Bench, calibration, stereo, text};
use stereopsis_host::scene::Scene;

#[test]
fn a_calibration_of_another_size_is_said() {
    let bench = Bench::new();
    let mut args = arguments(&bench, "a.png", "b.png", "64");
    let (width, height) = (f64::from(Scene::demo().width()), f64::from(Scene::demo().height()));
    let kitti = |cx: f64, cy: f64| {
        format!("P0: 500 0 {cx} 0 0 500 {cy} 0 0 0 1 0\nP1: 500 0 {cx} -50 0 500 {cy} 0 0 0 1 0\n")
    };
    let calib = bench.put("calib.txt", kitti(width / 2.0, height / 2.0).as_bytes()).display().to_string();
    args.extend(["--calib".to_owned(), calib.clone()]);
    let said = |args: &[String]| text(&stereo(args).stderr);
    assert!(said(&args).is_empty());
    bench.put("calib.txt", kitti(width, height).as_bytes());
    assert!(said(&args).contains("calib.txt: its principal point"), "{}", said(&args));
    let warnings = json(&bench.path("out/summary.json"))["pair"]["warnings"].to_string();
    assert!(warnings.contains("images of another size"), "{warnings}");
    let size = format!("{width}x{height}");
    let check = text(&stereo(["calib", "check", "--calib", &calib, "--size", &size]).stdout);
    assert!(check.contains("warning: the left principal point"), "{check}");
    let q = "Q: [[1, 0, 0, -319.5], [0, 1, 0, -239.5], [0, 0, 0, 500], [0, 0, 12.5, 0]]\n";
    let q = bench.put("q.yml", q.as_bytes()).display().to_string();
    let check = text(&stereo(["calib", "check", "--calib", &q, "--size", "100x100"]).stdout);
    assert!(check.contains("warning: the left principal point"), "{check}");
    bench.put("calib.txt", calibration(96, 48).as_bytes());
    bench.refused(&["calib", "check", "--calib", &calib, "--size", &size], "width says 96");
    let xml = bench.path("none.xml").display().to_string();
    let convert = ["calib", "convert", "--calib", &calib, "--to", "opencv", "--out", &xml];
    bench.refused(&convert, "--to opencv writes YAML");
}

#[test]
fn the_size_of_rectified_images_is_kept() {
    let bench = Bench::new();
    let convert = |calib: &str, size: &[&str]| {
        let out = bench.path("out.yml").display().to_string();
        let args = ["calib", "convert", "--calib", calib, "--to", "opencv", "--out", &out];
        let run = stereo([&args, size].concat());
        assert!(run.status.success(), "{}", text(&run.stderr));
        out
    };
    let matched = |calib: &str| stereo(bench.arguments(&[("--calib", calib)]));
    let p = |n: u32, shift: u32| format!("P{n}: [90, 0, 48, -{shift}, 0, 90, 24, 0, 0, 0, 1, 0]\n");
    let q = "Q: [[1, 0, 0, -48], [0, 1, 0, -24], [0, 0, 0, 90], [0, 0, 2, 0]]\n";
    let size = |width: u32| format!("image_width: {width}\nimage_height: 48\n");
    for matrices in [p(1, 0) + &p(2, 45), q.to_owned()] {
        let calib = bench.put("rig.yml", (size(96) + &matrices).as_bytes()).display().to_string();
        assert!(matched(&calib).status.success(), "{matrices}: {}", text(&matched(&calib).stderr));
        let converted = convert(&calib, &[]);
        assert!(matched(&converted).status.success(), "{}", text(&matched(&converted).stderr));
        // Of images of another size, also through another format.
        bench.put("rig.yml", (size(192) + &matrices).as_bytes());
        bench.refused(&bench.arguments(&[("--calib", calib.as_str())]), "width says 192");
        let converted = convert(&calib, &[]);
        bench.refused(&bench.arguments(&[("--calib", converted.as_str())]), "width says 192");
    }
}

#[test]
fn calibrations_that_do_not_go_together_are_refused() {
    let bench = Bench::new();
    let put = |name: &str, content: &str| bench.put(name, content.as_bytes()).display().to_string();
    let ros = |cx: &str| {
        let k = format!("[100, 0, {cx}, 0, 100, 24, 0, 0, 1]");
        format!(
            "image_width: 96\nimage_height: 48\ncamera_matrix: {{rows: 3, cols: 3, data: {k}}}\n\
             distortion_model: plumb_bob\n\
             distortion_coefficients: {{rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}}\n\
             rectification_matrix: {{rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}}\n\
             projection_matrix: {{rows: 3, cols: 4, data: [100, 0, 48, 0, 0, 100, 24, 0, 0, 0, 1, 0]}}\n"
        )
    };
    let whole = put("whole.txt", &calibration(96, 48));
    let marked = put("marked.txt", &format!("\u{feff}{}", calibration(96, 48)));
    let [one, broken, not_ros] =
        [("one.yaml", ros("48")), ("broken.yaml", ros("[")), ("not.yaml", "a: 1\n".into())]
            .map(|(name, content)| put(name, &content));
    let with = |first: &str, second: Option<&str>| {
        let second = second.map(|second| ("--calib", second));
        let mut args = bench.arguments(&[("--calib", first)]);
        args.extend(second.into_iter().flat_map(|(option, file)| [option.to_owned(), file.to_owned()]));
        args
    };
    bench.refused(&with(&whole, Some(&one)), "whole.txt: describes both cameras by itself");
    bench.refused(&with(&one, Some(&whole)), "whole.txt: describes both cameras by itself");
    bench.refused(&with(&one, Some(&broken)), "broken.yaml: is not well-formed");
    bench.refused(&with(&one, Some(&not_ros)), "not.yaml: is no camera_info");
    bench.refused(&with(&one, None), "one.yaml: is the camera_info of one camera");
    let run = stereo(with(&marked, None));
    assert!(run.status.success(), "{}", text(&run.stderr));
    let scaled = put("scaled.txt", &calibration(96, 48).replace("0 0 1]", "0 0 2]"));
    bench.refused(&with(&scaled, None), "cam0: its last row has to be 0 0 1");
}

#[test]
fn cameras_one_above_the_other_are_told() {
    let bench = Bench::new();
    let camera =
        |n: u32| format!("K{n}: [200., 0., 119.5, 0., 200., 89.5, 0., 0., 1.]\nD{n}: [0., 0., 0., 0., 0.]\n");
    let told = |t: &str| {
        let size = "image_width: 240\nimage_height: 180\n";
        let rest = format!("R: [1., 0., 0., 0., 1., 0., 0., 0., 1.]\nT: [{t}]\n");
        let path = bench.put("rig.yml", (size.to_owned() + &camera(1) + &camera(2) + &rest).as_bytes());
        let run = stereo(["calib", "check", "--calib", &path.display().to_string()]);
        assert!(run.status.success(), "{}", text(&run.stderr));
        text(&run.stdout)
    };
    assert!(told("-0.06, 0., 0.").contains("nothing looks wrong"));
    let above = told("0., -0.06, 0.");
    assert!(above.contains("warning: the cameras stand one above the other"), "{above}");
}
