//! Matches of real pictures with known cameras, of the folder in `STEREO_DATA`.
//!
//! Built by the feature `real-data`, which `cargo xtask test` sets when `STEREO_DATA` is.

use image::GrayImage;
use nalgebra::{Matrix3, Vector3};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use stereopsis_host::correspond::{Plan, correspond};

/// Pairs of pictures of the folder's fountain that are neighbours.
const NEIGHBOURS: [[u8; 2]; 5] = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]];
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

/// The true fundamental matrix in OpenCV's order: `x2^T F x1 = 0`.
fn fundamental([left, right]: [u8; 2]) -> Matrix3<f64> {
    let path = folder().join(format!("pair_{left:02}_{right:02}.json"));
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let json: Value = serde_json::from_str(&text).expect("JSON");
    Matrix3::from_fn(|row, column| json["F"][row][column].as_f64().expect("a number"))
}

/// The larger of the distances to the two epipolar lines, px.
fn distance_px(f: &Matrix3<f64>, [x1, y1, x2, y2]: [f32; 4]) -> f64 {
    let [p1, p2] = [[x1, y1], [x2, y2]].map(|[x, y]| Vector3::new(f64::from(x), f64::from(y), 1.0));
    let (l2, l1) = (f * p1, f.tr_mul(&p2));
    let residual = p2.dot(&l2).abs();
    residual / l1.xy().norm().min(l2.xy().norm())
}

#[test]
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
        table +=
            &format!("{pair:?}: {} matches, {:.1} % inliers, median {median:.3} px\n", distances.len(), 100.0 * share);
        assert!(distances.len() >= 700 && share >= 0.88 && median <= 0.35, "{table}");
    }
    println!("{table}");
}
