//! `stereo odometry` and `stereo walk`: their files, and what they say when they cannot.

use super::support::{Bench, names, stereo, text};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::collections::HashMap;
use std::fs;
use std::path::Path;

pub fn walk(bench: &Bench, frames: &str) -> String {
    let street = bench.path("street").display().to_string();
    let run = stereo(["walk", "--out", &street, "--frames", frames, "--width", "200"]);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    street
}

fn poses(path: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(path).expect("poses");
    text.lines().map(|line| line.split(' ').map(|word| word.parse().expect("a number")).collect()).collect()
}

#[test]
fn a_line_for_every_frame() {
    let bench = Bench::new();
    walk(&bench, "5");
    let street = walk(&bench, "4");
    assert_eq!(names(&bench.path("street")), ["calib.txt", "left", "poses.txt", "right", "walk.json"]);
    assert_eq!(names(&bench.path("street/left")), ["000000.png", "000001.png", "000002.png", "000003.png"]);
    let calib = format!("{street}/calib.txt");
    let (out, way) = (bench.path("new/found.txt"), bench.path("new/way.svg"));
    let truth = format!("{street}/poses.txt");
    let arguments = ["odometry", "--sequence", &street, "--calib", &calib, "--out"];
    let mut with_all = arguments.map(str::to_owned).to_vec();
    with_all.extend([out.display().to_string(), "--picture".into(), way.display().to_string()]);
    with_all.extend(["--truth".into(), truth.clone()]);
    let run = stereo(&with_all);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let said = text(&run.stdout);
    assert!(
        said.starts_with("4 frames of 200 x 100 px, a pair, KITTI calibration\nframes       3 tracked\n"),
        "{said}"
    );
    assert!(said.contains("ATE ") && said.contains("RPE "), "{said}");
    let found = poses(&out);
    assert!(found.len() == 4 && found.iter().all(|line| line.len() == 12), "{found:?}");
    assert_eq!(found[0], [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let true_poses = poses(&bench.path("street/poses.txt"));
    let off = (0..3).map(|i| (found[3][4 * i + 3] - true_poses[3][4 * i + 3]).powi(2)).sum::<f64>().sqrt();
    assert!(off < 0.05, "{off} m of 1.5 m");
    let drawn = fs::read_to_string(way).expect("a drawing");
    assert!(drawn.starts_with("<svg ") && drawn.contains(">found<") && drawn.contains(">truth<"), "{drawn}");
    assert!(!drawn.contains(">lost, or"), "{drawn}");

    // The same in the other form, which is taken as a truth too.
    let (tum, times) = (bench.path("new/tum.txt").display().to_string(), "10\n10.1\n10.2\n10.35\n");
    let times = bench.put("times.txt", times.as_bytes()).display().to_string();
    let mut in_time = arguments.map(str::to_owned).to_vec();
    in_time.extend([tum.clone(), "--times".into(), times.clone()]);
    bench.refused(&in_time, "--times");
    in_time.extend(["--format".into(), "tum".into(), "--truth".into(), truth]);
    let run = stereo(&in_time);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let lines = poses(Path::new(&tum));
    assert!(lines.len() == 4 && lines.iter().all(|line| line.len() == 8), "{lines:?}");
    assert!(lines.iter().zip([10.0, 10.1, 10.2, 10.35]).all(|(line, time)| line[0] == time), "{lines:?}");
    for (found, line) in found.iter().zip(&lines) {
        assert!((0..3).all(|i| (found[4 * i + 3] - line[i + 1]).abs() < 1e-8), "{found:?} {line:?}");
    }
    let mut beside = arguments.map(str::to_owned).to_vec();
    beside.extend([out.display().to_string(), "--truth".into(), tum]);
    let run = stereo(&beside);
    assert!(text(&run.stdout).contains("ATE          0.0000 m"), "{}", text(&run.stdout));

    // One camera: the same frames without the right ones.
    fs::remove_dir_all(bench.path("street/right")).expect("the folder");
    with_all.truncate(6);
    with_all.push(out.display().to_string());
    let run = stereo(&with_all);
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert!(text(&run.stdout).contains("one camera"), "{}", text(&run.stdout));
    assert_eq!(poses(&out).len(), 4);
}

#[test]
fn what_is_wrong_is_named_and_nothing_is_left() {
    let bench = Bench::new();
    let street = walk(&bench, "3");
    let calib = format!("{street}/calib.txt");
    let out = bench.path("new/found.txt").display().to_string();
    let all = |sequence: &str, calib: &str, out: &str| {
        ["odometry", "--sequence", sequence, "--calib", calib, "--out", out].map(str::to_owned)
    };
    let refused = |culprit: &str| bench.refused(&all(&street, &calib, &out), culprit);
    bench.refused(&all("missing", &calib, &out), "missing");
    bench.refused(&all(&street, "missing.txt", &out), "missing.txt");
    bench.refused(&all(&street, &calib, &street), "--out");
    bench.refused(&["odometry", "--sequence", &street, "--calib", &calib], "--out");
    bench.refused(&["walk", "--out", &out, "--frames", "1"], "--frames");

    let (first, last) = (bench.path("street/right/000000.png"), bench.path("street/right/000002.png"));
    let kept = fs::read(&last).expect("a frame");
    fs::remove_file(&last).expect("a frame");
    refused("left/000002.png");
    fs::write(&last, b"no image").expect("room");
    refused("right/000002.png");
    let small = image::GrayImage::new(90, 50);
    small.save(&last).expect("room");
    refused("all frames must have one size");
    fs::write(&last, &kept).expect("room");
    // A calibration of frames twice as large.
    bench.put("large.txt", b"P0: 240 0 199 0 0 240 99 0 0 0 1 0\nP1: 240 0 199 -96 0 240 99 0 0 0 1 0\n");
    bench.refused(&all(&street, &bench.path("large.txt").display().to_string(), &out), "large.txt");
    bench.put("broken.txt", b"P0: 1 2 3\n");
    bench.refused(&all(&street, &bench.path("broken.txt").display().to_string(), &out), "broken.txt");
    let empty = bench.path("empty");
    fs::create_dir_all(empty.join("left")).expect("folders");
    bench.refused(&all(&empty.display().to_string(), &calib, &out), "has 0 images");
    fs::remove_dir_all(bench.path("street/left")).expect("the folder");
    refused("left");
    assert!(first.is_file() && !bench.path("new").exists());
}

/// The states of a scene that `walk` draws, as `--states` writes them, of a pair or of its left camera.
fn states(bench: &Bench, scene: &str, one_camera: bool) -> Vec<String> {
    let street = bench.path(scene);
    if !street.is_dir() {
        let to = street.display().to_string();
        let run = stereo(["walk", "--scene", scene, "--out", &to, "--frames", "4", "--width", "200"]);
        assert!(run.status.success(), "{}", text(&run.stderr));
    }
    if one_camera {
        fs::remove_dir_all(street.join("right")).expect("the folder");
    }
    let [sequence, calib] = [street.clone(), street.join("calib.txt")].map(|path| path.display().to_string());
    let [out, list] = ["found.txt", "states.csv"].map(|name| bench.path(name).display().to_string());
    let run = stereo([
        "odometry",
        "--sequence",
        &sequence,
        "--calib",
        &calib,
        "--out",
        &out,
        "--states",
        &list,
        "--window",
        "3",
    ]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let list = fs::read_to_string(list).expect("states");
    let mut lines = list.lines();
    assert_eq!(
        lines.next(),
        Some("frame,state,points,found,agree,sigma_turn_deg,sigma_step,rig_px,sigma_rig_px")
    );
    // What is not known of a step has no deviation; nor has one camera that stands still a unit for it.
    let unknown = ["turned", "step_unknown", "waiting", "lost", "restarted"];
    let state = |line: &str| {
        let words: Vec<_> = line.split(',').collect();
        assert_eq!(words.len(), 9, "{line}");
        let no_unit = one_camera && words[1] == "still";
        let known = !(no_unit || unknown.contains(&words[1]));
        assert_eq!(words[6].is_empty(), !known, "{line}");
        words[1].to_owned()
    };
    let found = lines.map(state).collect();
    if scene != "wall" {
        assert!(
            poses(&bench.path("found.txt"))
                .iter()
                .all(|line| [3, 7, 11].iter().all(|&i| line[i].abs() < 0.02))
        );
    }
    found
}

#[test]
fn what_is_undetermined_is_named() {
    let bench = Bench::new();
    assert_eq!(states(&bench, "still", false), ["first", "still", "still", "still"]);
    assert_eq!(states(&bench, "still", true), ["first", "still", "still", "still"]);
    assert_eq!(states(&bench, "turn", false), ["first", "tracked", "tracked", "tracked"]);
    assert_eq!(states(&bench, "turn", true), ["first", "turned", "turned", "turned"]);
    assert_eq!(states(&bench, "far", false), ["first", "step_unknown", "step_unknown", "step_unknown"]);
    assert_eq!(states(&bench, "far", true), ["first", "turned", "turned", "turned"]);
    assert_eq!(states(&bench, "wall", false), ["first", "tracked", "tracked", "tracked"]);
    // Two motions explain a plane: one camera waits until it is sure of one, which is the right one.
    assert_eq!(states(&bench, "wall", true), ["first", "waiting", "tracked", "tracked"]);
    let [x, y, z] = [3, 7, 11].map(|i| poses(&bench.path("found.txt"))[3][i]);
    assert!((z / x - 0.4).abs() < 0.05 && (y / x).abs() < 0.05, "{x} {y} {z}");
}

#[test]
fn views_of_a_street_stand_where_they_stood() {
    let bench = Bench::new();
    let street = bench.path("street").display().to_string();
    let run = stereo(["walk", "--out", &street, "--frames", "4", "--width", "320", "--step", "1"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let [images, calib] = [format!("{street}/left/*.png"), format!("{street}/calib.txt")];
    let out = bench.path("seen").display().to_string();
    let mut arguments =
        ["structure", "--images", &images, "--calib", &calib, "--out", &out].map(str::to_owned).to_vec();
    let run = stereo(&arguments);
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert!(text(&run.stdout).contains("which is not known"), "{}", text(&run.stdout));
    arguments.extend(["--baseline".into(), "1".into()]);
    let run = stereo(&arguments);
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert!(text(&run.stdout).starts_with("4 of 4 views stand somewhere"), "{}", text(&run.stdout));
    let written = [
        "cameras.txt",
        "cloud.ply",
        "images.txt",
        "points3D.txt",
        "poses.txt",
        "structure.json",
        "views.svg",
    ];
    assert_eq!(names(&bench.path("seen")), written);
    colmap_model_agrees(&bench.path("seen"));
    let (found, truth) = (poses(&bench.path("seen/poses.txt")), poses(&bench.path("street/poses.txt")));
    for (found, truth) in found.iter().zip(&truth) {
        let off = [3, 7, 11].iter().map(|&i| (found[i] - truth[i]).powi(2)).sum::<f64>().sqrt();
        assert!(off < 0.06, "{off} m of 3 m: {found:?} {truth:?}");
    }
    let json = fs::read_to_string(bench.path("seen/structure.json")).expect("json");
    assert!(json.contains("\"unit\": \"m\"") && json.contains("\"placed\""), "{json}");
    let cloud = fs::read(bench.path("seen/cloud.ply")).expect("a cloud");
    assert!(cloud.starts_with(b"ply\nformat binary_little_endian 1.0\ncomment m; X right"));
    let one = format!("{street}/left/000000.png");
    let other = bench.path("other").display().to_string();
    bench.refused(&["structure", "--images", &one, "--calib", &calib, "--out", &other], "2 to 60 are needed");
    // A calibration of images of another size.
    let wide = b"cam0=[200 0 160; 0 200 90; 0 0 1]\ncam1=[200 0 160; 0 200 90; 0 0 1]\ndoffs=0\n\
        baseline=100\nwidth=640\nheight=360\n";
    let wide = bench.put("wide.txt", wide).display().to_string();
    bench.refused(&["structure", "--images", &images, "--calib", &wide, "--out", &other], "wide.txt");
    // Twice the same picture.
    fs::copy(&one, bench.path("again.png")).expect("room");
    let again = bench.path("again.png").display().to_string();
    bench.refused(
        &["structure", "--images", &one, &again, "--calib", &calib, "--out", &other],
        "has not moved",
    );
    // The first camera's place twice tells no length.
    let [second, third, last] = [1, 2, 3].map(|number| format!("{street}/left/00000{number}.png"));
    let twice = [&one, &again, &second, &third, &last].map(String::as_str);
    let known = ["--calib", &calib, "--baseline", "1", "--out", &other];
    bench.refused(&[&["structure", "--images"][..], &twice, &known].concat(), "stand in one place");
    // Nor does one of another scene.
    let other_scene = bench.path("other scene.png").display().to_string();
    image::open(&one).expect("a picture").flipv().save(&other_scene).expect("room");
    let of_other = [&other_scene, &second, &third, &last].map(String::as_str);
    let refused = [&["structure", "--images"][..], &of_other, &known].concat();
    bench.refused(&refused, "other scene.png stands nowhere");
    assert!(!bench.path("other").exists());
}

/// Holds a model in COLMAP's text form to itself: every point of an image is one that exists, lies where the
/// camera sees it, and names the place back.
fn colmap_model_agrees(folder: &Path) {
    let lines = |name: &str| -> Vec<String> {
        let text = fs::read_to_string(folder.join(name)).expect(name);
        text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
    };
    let numbers = |text: &str| -> Vec<f64> { text.split(' ').filter_map(|x| x.parse().ok()).collect() };
    let camera = lines("cameras.txt");
    assert!(camera.len() == 1 && camera[0].starts_with("1 PINHOLE "), "{camera:?}");
    let [.., fx, fy, cx, cy] = numbers(&camera[0])[..] else { panic!("{camera:?}") };
    let points: HashMap<u64, Vec<f64>> =
        lines("points3D.txt").iter().map(|line| numbers(line)).map(|p| (p[0] as u64, p)).collect();
    let (images, mut observations) = (lines("images.txt"), 0);
    for pair in images.chunks_exact(2) {
        let [image, w, x, y, z, tx, ty, tz, ..] = numbers(&pair[0])[..] else { panic!("{}", pair[0]) };
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        for (at, seen) in numbers(&pair[1]).chunks_exact(3).enumerate() {
            let point = &points[&(seen[2] as u64)];
            let place = turn * Vector3::new(point[1], point[2], point[3]) + Vector3::new(tx, ty, tz);
            let off = (fx * place.x / place.z + cx - seen[0]).hypot(fy * place.y / place.z + cy - seen[1]);
            assert!(off <= 1.51, "{off} px");
            assert!(point[8..].chunks_exact(2).any(|t| t == [image, at as f64]), "{point:?}");
            observations += 1;
        }
    }
    let tracks: usize = points.values().map(|point| (point.len() - 8) / 2).sum();
    assert_eq!(observations, tracks);
    // Points are looked for in all four views.
    println!("{observations} observations of {} points", points.len());
    assert!(images.len() == 8 && observations >= 3 * points.len(), "{observations} {}", points.len());
}
