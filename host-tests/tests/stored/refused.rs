//! What a constructor refuses is refused when it is read, in the constructor's words.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::fmt::Debug;
use stereopsis::features::Level;
use stereopsis::focus::{Breathing, FocusCalibration, MicroLens, ThinLens};
use stereopsis::geometry::absolute::Projection;
use stereopsis::geometry::camera::{Camera, Pose, RectifiedRig, StereoRig};
use stereopsis::geometry::known_shape::{Sighting, SquareMark};
use stereopsis::geometry::two_view::{Essential, Fundamental, Homography, RelativePose};

/// Reading `good` succeeds; with the value behind the JSON pointer `at` replaced it fails with `said` in its
/// words.
fn refused<T: DeserializeOwned + Debug>(good: &Value, at: &str, bad: impl Serialize, said: &str) {
    if let Err(error) = serde_json::from_value::<T>(good.clone()) {
        panic!("{good}: {error}");
    }
    let mut value = good.clone();
    let place = value.pointer_mut(at).unwrap_or_else(|| panic!("{good} has no {at}"));
    *place = json!(bad);
    match serde_json::from_value::<T>(value) {
        Ok(read) => panic!("{at} of {good} is taken: {read:?}"),
        Err(error) => assert!(error.to_string().contains(said), "{at}: {error}, not {said}"),
    }
}

/// A matrix as it is stored: its numbers, column by column.
const UNIT: [f32; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

fn pose() -> Value {
    json!({ "rotation": UNIT, "translation": [0.06, 0.0, 0.0] })
}

fn camera() -> Value {
    let lens = json!({ "Fisheye": { "k1": 0.0, "k2": 0.0, "k3": 0.0, "k4": 0.0 } });
    json!({ "fx": 500.0, "fy": 500.0, "cx": 320.0, "cy": 240.0, "skew": 0.0, "lens": lens })
}

#[test]
fn cameras_and_rigs() {
    let rig = json!({ "focal_px": 350.0, "baseline_m": 0.06, "cx": 160.0, "cy": 120.0, "cx_right": 160.0 });
    refused::<RectifiedRig>(&rig, "/focal_px", 0.0, "focal length must be greater than zero");
    refused::<RectifiedRig>(&rig, "/baseline_m", -0.06, "baseline must be greater than zero");
    refused::<RectifiedRig>(&rig, "/cx", 1e300, "finite");
    refused::<Camera<f32>>(&camera(), "/fx", 0.0, "focal lengths must be");
    refused::<Camera<f32>>(&camera(), "/cy", 2e6, "principal point");
    refused::<Camera<f64>>(&camera(), "/skew", 2e6, "skew");
    refused::<Camera<f32>>(&camera(), "/lens/Fisheye/k1", 1e300, "finite");
    refused::<Pose<f32>>(&pose(), "/rotation/0", 1.01, "the matrix is no rotation");
    refused::<Pose<f32>>(&pose(), "/rotation/0", -1.0, "the matrix is no rotation");
    let size = json!({ "width": 640, "height": 480 });
    let rig = json!({ "cameras": [camera(), camera()], "pose": pose(), "sizes": [size, size] });
    refused::<StereoRig<f32>>(&rig, "/pose/translation/0", 0.0, "the baseline is zero");
    refused::<StereoRig<f32>>(&rig, "/sizes/1/height", 1, "from 2 to 4096");
    refused::<StereoRig<f32>>(&rig, "/cameras/1/fx", -1.0, "focal lengths must be");
}

#[test]
fn lenses() {
    refused::<ThinLens<f32>>(&json!({ "focal": 0.004 }), "/focal", -0.004, "focal length");
    refused::<MicroLens>(&json!({ "focal_um": 4000 }), "/focal_um", 0, "focal length");
    refused::<Breathing>(&json!({ "scale": 65536 }), "/scale", 0, "");
    refused::<Breathing>(&json!({ "scale": 65536 }), "/scale", 131_073, "");
    let line = json!({ "lens": { "focal": 0.004 }, "zero_m": 1e-6, "per_step_m": 1e-7, "rms_m": 0.0 });
    refused::<FocusCalibration>(&line, "/per_step_m", 0.0, "step must be above zero");
    refused::<FocusCalibration>(&line, "/zero_m", 1e300, "not finite");
    refused::<FocusCalibration>(&line, "/lens/focal", 0.0, "focal length");
    refused::<Level>(&json!({ "index": 1, "scale": 1.5 }), "/scale", 0.5, "at least 1");
}

#[test]
fn matrices_and_directions() {
    let singular = json!({ "matrix": [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0] });
    refused::<Fundamental<f32>>(&singular, "/matrix/5", 0.0, "rank");
    refused::<Essential<f32>>(&singular, "/matrix/5", 0.0, "rank");
    refused::<Homography<f32>>(&json!({ "matrix": UNIT }), "/matrix/8", 0.0, "singular");
    let projection = json!({ "matrix": ([UNIT.as_slice(), &[0.0; 3]].concat()) });
    refused::<Projection<f32>>(&projection, "/matrix/4", 0.0, "infinity");
    let relative = json!({ "rotation": UNIT, "direction": [1.0, 0.0, 0.0] });
    refused::<RelativePose<f32>>(&relative, "/direction/0", 0.0, "direction");
    refused::<RelativePose<f32>>(&relative, "/rotation/4", -1.0, "rotation");
    refused::<SquareMark<f32>>(&json!({ "side_m": 0.1 }), "/side_m", 0.0, "side");
    let bearing = json!([0.0, 0.0, 1.0]);
    let seen = json!({ "distance_m": 1.0, "sigma_m": 0.1, "bearing": bearing, "angle_rad": 0.1 });
    refused::<Sighting<f32>>(&seen, "/bearing/2", 0.0, "bearing");
    for (field, number) in [("/distance_m", 0.0), ("/sigma_m", -0.1), ("/angle_rad", -1.0)] {
        refused::<Sighting<f32>>(&seen, field, number, "must be positive");
    }
}
