//! Matches of real pictures with known cameras, of the folder in `STEREO_DATA`.
//!
//! `cargo xtask test` runs them when `STEREO_DATA` is set.

use image::GrayImage;
use nalgebra::{Matrix3, Vector3};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use stereopsis::geometry::camera::Pose;
use stereopsis_host::correspond::{Plan, correspond};
use stereopsis_host::two_view::off_degrees;

/// Pairs of pictures of the folder's fountain that are neighbours.
const NEIGHBOURS: [[u8; 2]; 5] = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]];
/// And those that are one farther on, turned by twice as much.
const NEXT: [[u8; 2]; 4] = [[0, 2], [1, 3], [2, 4], [3, 5]];
/// How far a match may lie from its true epipolar lines, px.
const INLIER_PX: f64 = 1.5;

fn folder() -> PathBuf {
    let data = std::env::var_os("STEREO_DATA").expect("set STEREO_DATA to the folder that holds two_view/");
    PathBuf::from(data).join("two_view").join("fountain-P11")
}

fn picture(number: u8) -> GrayImage {
    let path = folder().join(format!("image_{number:04}.png"));
    image::open(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).into_luma8()
}

/// What is known of a pair.
fn truth([left, right]: [u8; 2]) -> Value {
    let path = folder().join(format!("pair_{left:02}_{right:02}.json"));
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).expect("JSON")
}

/// The true fundamental matrix in OpenCV's order: `x2^T F x1 = 0`.
fn fundamental(pair: [u8; 2]) -> Matrix3<f64> {
    let json = truth(pair);
    matrix(&json["F"])
}

fn matrix(value: &Value) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| value[row][column].as_f64().expect("a number"))
}

/// The larger of the distances to the two epipolar lines, px.
fn distance_px(f: &Matrix3<f64>, [x1, y1, x2, y2]: [f32; 4]) -> f64 {
    let [p1, p2] = [[x1, y1], [x2, y2]].map(|[x, y]| Vector3::new(f64::from(x), f64::from(y), 1.0));
    let (l2, l1) = (f * p1, f.tr_mul(&p2));
    let residual = p2.dot(&l2).abs();
    residual / l1.xy().norm().min(l2.xy().norm())
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn matches_of_neighbours_lie_on_the_true_epipolar_lines() {
    let pictures: Vec<_> = (0..6).map(picture).collect();
    let mut table = String::new();
    for pair in NEIGHBOURS {
        let [left, right] = pair.map(|number| &pictures[usize::from(number)]);
        let found = correspond(&Plan::default(), left, right).expect("pictures within the capacity");
        let f = fundamental(pair);
        let mut distances: Vec<_> = found.points().map(|points| distance_px(&f, points)).collect();
        distances.sort_by(f64::total_cmp);
        let inliers = distances.partition_point(|&d| d < INLIER_PX);
        let (share, median) = (inliers as f64 / distances.len() as f64, distances[distances.len() / 2]);
        table += &format!(
            "{pair:?}: {} matches, {:.1} % inliers, median {median:.3} px\n",
            distances.len(),
            100.0 * share
        );
        assert!(distances.len() >= 800 && share >= 0.89 && median <= 0.25, "{table}");
    }
    println!("{table}");
}

/// Runs the program `stereo`; what it says.
fn stereo(arguments: &[&str]) -> String {
    let run =
        Command::new(env!("CARGO_BIN_EXE_stereo")).args(arguments).output().expect("the program starts");
    assert!(run.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&run.stderr));
    String::from_utf8_lossy(&run.stdout).into_owned()
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn the_programs_find_the_true_pose_of_two_pictures() {
    let bench = tempfile::tempdir().expect("a folder");
    let file = |name: &str| bench.path().join(name).display().to_string();
    let (matches, calibration, answer) = (file("matches.csv"), file("calib.txt"), file("pose.json"));
    let mut table = String::new();
    for pair in NEIGHBOURS.into_iter().chain(NEXT) {
        let [left, right] =
            pair.map(|number| folder().join(format!("image_{number:04}.png")).display().to_string());
        stereo(&["features", "--left", &left, "--right", &right, "--out", &matches]);
        let truth = truth(pair);
        let cameras = ["K1", "K2"].map(|name| matrix(&truth[name]));
        let of = |k: &Matrix3<f64>| {
            format!("[{} 0 {}; 0 {} {}; 0 0 1]", k[(0, 0)], k[(0, 2)], k[(1, 1)], k[(1, 2)])
        };
        let text = format!("cam0={}\ncam1={}\n", of(&cameras[0]), of(&cameras[1]));
        fs::write(&calibration, text).expect("a file");
        stereo(&["pose", "--matches", &matches, "--calib", &calibration, "--out", &answer]);
        let found: Value = serde_json::from_slice(&fs::read(&answer).expect("a file")).expect("JSON");
        let vector = |value: &Value| Vector3::from_fn(|i, _| value[i].as_f64().expect("a number"));
        let found = Pose::new(matrix(&found["rotation"]), vector(&found["translation"])).expect("a rotation");
        let truth = Pose::from_opencv(matrix(&truth["R"]), vector(&truth["t"])).expect("a rotation");
        let (rotation, direction) = off_degrees(&found, &truth);
        table += &format!("{pair:?}: off by {rotation:.3} and {direction:.3} degrees\n");
        assert!(rotation < 0.2 && direction < 0.5, "{table}");
    }
    println!("{table}");
}
