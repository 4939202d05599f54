//! Rigs from real pictures of chessboards beside OpenCV's, of the folder in `STEREO_DATA`.
//!
//! `cargo xtask test` runs them when `STEREO_DATA` is set.

use image::GrayImage;
use serde_json::Value;
use std::path::{Path, PathBuf};
use stereopsis::geometry::{
    camera::ImageSize,
    rectify::{Crop, Rectification},
};
use stereopsis_host::calibrate::board::{Board, Pattern, find};
use stereopsis_host::calibrate::{Calibrated, LensModel, View, solve};
use stereopsis_host::calibration::RawCalibration;
use stereopsis_host::rectify::rectify;
use stereopsis_host::run::MemoryPair;

/// How far rows are apart after OpenCV's own remap, px.
const OPENCV_CHESSBOARD_PX: f64 = 0.1362;
const OPENCV_QQVGA_PX: f64 = 0.2392;

fn folder(name: &str) -> PathBuf {
    let data = std::env::var_os("STEREO_DATA").expect("set STEREO_DATA to the folder that holds calib/");
    PathBuf::from(data).join("calib").join(name)
}

fn reference(path: &Path) -> Value {
    let text = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_slice(&text).expect("JSON")
}

/// The rig of the views that OpenCV used.
fn calibrated(folder: &Path, reference: &Value) -> Calibrated {
    let pattern = Pattern::new(9, 6).expect("a pattern");
    let number = |value: &Value| value.as_f64().expect("a number");
    let [width, height] = [0, 1].map(|i| number(&reference["image_size"][i]) as u16);
    let look = |name: &str, like: Option<&Board>| {
        let path = folder.join(name);
        let picture = image::open(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).into_luma8();
        find(&picture, pattern, like).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    let names = reference["used_left"].as_array().expect("names");
    let views = names.iter().map(|name| {
        let name = name.as_str().expect("a name");
        let left = look(name, None);
        let right = look(&name.replace("left", "right"), Some(&left));
        View::new([left, right])
    });
    let views: Vec<_> = views.collect();
    let square_m = number(&reference["square"]);
    solve(LensModel::Brown, pattern, square_m, ImageSize { width, height }, &views).expect("a rig")
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn residuals_and_baselines_are_those_of_opencv() {
    for (name, file) in [
        ("opencv_chessboard", "derived_reference_calibration.json"),
        ("qqvga_class_270x180", "derived_reference_calibration_2.json"),
    ] {
        let folder = folder(name);
        let reference = reference(&folder.join(file));
        let found = calibrated(&folder, &reference);
        let rms = reference["rms"].as_f64().expect("a number");
        assert!(found.rms_px <= 1.02 * rms, "{name}: {} px, OpenCV {rms} px", found.rms_px);
        let t: Vec<f64> =
            reference["T"].as_array().expect("T").iter().map(|x| x.as_f64().expect("a number")).collect();
        let baseline = t.iter().map(|x| x * x).sum::<f64>().sqrt();
        let off = found.rig.baseline_m() / baseline - 1.0;
        assert!(off.abs() < 0.005, "{name}: {} m, OpenCV {baseline} m", found.rig.baseline_m());
    }
}

/// The root mean square of how far the rows of corresponding corners are apart in rectified views, px, and in
/// how many views all corners are shown.
fn rows_apart(views: impl Iterator<Item = [GrayImage; 2]>) -> (f64, usize) {
    let pattern = Pattern::new(9, 6).expect("a pattern");
    let (mut squares, mut corners, mut count) = (0.0, 0_usize, 0);
    for [left, right] in views {
        // A board at the border may be cut off by the crop.
        let Ok(left) = find(&left, pattern, None) else { continue };
        let Ok(right) = find(&right, pattern, Some(&left)) else { continue };
        squares += left.corners.iter().zip(&right.corners).map(|(a, b)| (a.y - b.y).powi(2)).sum::<f64>();
        corners += left.corners.len();
        count += 1;
    }
    ((squares / corners as f64).sqrt(), count)
}

/// OpenCV's calibration in our remap. What OpenCV's own remap gives was measured with OpenCV 5.0.0:
/// `stereoRectify` with its default crop on the reference's K1, D1, K2, D2, R and T,
/// `initUndistortRectifyMap` and a bilinear `remap` of all views, and in these pictures the corners as they
/// are found here.
#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn rows_agree_as_well_as_through_opencv() {
    for (name, file, opencv_px, least) in [
        ("opencv_chessboard", "derived_reference_calibration.json", OPENCV_CHESSBOARD_PX, 13),
        ("qqvga_class_270x180", "derived_reference_calibration_2.json", OPENCV_QQVGA_PX, 24),
    ] {
        let folder = folder(name);
        let path = folder.join(file);
        let reference = reference(&path);
        let rig = RawCalibration::open(&[path], None, None).unwrap_or_else(|e| panic!("{e}")).rig;
        let size = rig.sizes()[0];
        let both = Rectification::new(&rig, Crop::Natural, size).expect("rectified");
        let names = reference["used_left"].as_array().expect("names");
        let views = names.iter().map(|name| {
            let name = name.as_str().expect("a name");
            let raw = [name.to_owned(), name.replace("left", "right")].map(|name| {
                let path = folder.join(name);
                image::open(&path)
                    .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
                    .into_luma8()
                    .into_vec()
            });
            let [left, right] = raw;
            let pair = MemoryPair::new(size.width, left, right).expect("a pair");
            rectify(&both, pair).expect("rectified").pictures
        });
        let (apart, count) = rows_apart(views);
        println!("{name}: {apart:.4} px in {count} views, OpenCV {opencv_px} px");
        assert!(count >= least, "{name}: {count} views");
        assert!(apart <= opencv_px + 0.02, "{name}: {apart} px, OpenCV {opencv_px} px");
    }
}
