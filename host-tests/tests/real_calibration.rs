//! Rigs from real pictures of chessboards beside OpenCV's, of the folder in `STEREO_DATA`.
//!
//! Built by the feature `real-data`, which `cargo xtask test` sets when `STEREO_DATA` is.

use serde_json::Value;
use std::path::{Path, PathBuf};
use stereopsis::geometry::ImageSize;
use stereopsis_host::calibrate::board::{Board, Pattern, find};
use stereopsis_host::calibrate::{Calibrated, View, solve};

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
        View { corners: [left.corners, right.corners] }
    });
    let views: Vec<_> = views.collect();
    let square_m = number(&reference["square"]);
    solve(pattern, square_m, ImageSize { width, height }, &views).expect("a rig")
}

#[test]
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
        let t: Vec<f64> = reference["T"].as_array().expect("T").iter().map(|x| x.as_f64().expect("a number")).collect();
        let baseline = t.iter().map(|x| x * x).sum::<f64>().sqrt();
        let off = found.rig.baseline_m() / baseline - 1.0;
        assert!(off.abs() < 0.005, "{name}: {} m, OpenCV {baseline} m", found.rig.baseline_m());
    }
}
