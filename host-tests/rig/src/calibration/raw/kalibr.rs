//! Kalibr's camchain.

use super::tree::{Tree, list, need, numbers, size};
use super::{Fault, Found, Model, camera, pose_of};
use stereopsis::geometry::camera::Camera;

const CAMERA: &str = "a camera with camera_model, intrinsics, distortion_model and distortion_coeffs";

pub(super) fn is_one(tree: &Tree) -> bool {
    tree.get("cam0").is_some_and(|cam| cam.get("intrinsics").is_some() || cam.get("camera_model").is_some())
}

/// Both cameras, or the one there is twice.
pub(super) fn cameras(tree: &Tree) -> Result<[Camera<f64>; 2], Fault> {
    let left = one("cam0", need(tree, "cam0", CAMERA)?)?;
    Ok([left, tree.get("cam1").map_or(Ok(left), |right| one("cam1", right))?])
}

pub(super) fn read(tree: &Tree) -> Result<Found, Fault> {
    let [left, right] = [need(tree, "cam0", CAMERA)?, need(tree, "cam1", CAMERA)?];
    let key = "T_cn_cnm1";
    let matrix = need(right, key, "in cam1, the 4x4 matrix that carries a point of cam0 into cam1")?;
    let [r00, r01, r02, t0, r10, r11, r12, t1, r20, r21, r22, t2, ..] = numbers::<16>(key, matrix)?;
    Ok(Found {
        format: "Kalibr",
        cameras: cameras(tree)?,
        pose: pose_of(key, [r00, r01, r02, r10, r11, r12, r20, r21, r22], [t0, t1, t2])?,
        size: left.get("resolution").map(|value| size("resolution", value)).transpose()?,
        baseline_key: key,
    })
}

fn one(name: &str, cam: &Tree) -> Result<Camera<f64>, Fault> {
    let key = |key: &str| format!("{name}: {key}");
    let text = |field: &str| Ok(need(cam, field, CAMERA)?.as_str().unwrap_or(""));
    let refused = |field: &str, found: &str, known: &str| {
        let problem = format!("'{found}' is not supported; calibrate with {known}");
        Err(Fault::Key { key: key(field), problem })
    };
    let found = text("camera_model")?;
    if found != "pinhole" {
        return refused("camera_model", found, "pinhole");
    }
    let model = match text("distortion_model")? {
        "radtan" | "none" => Model::BrownConrady,
        "equidistant" => Model::Fisheye,
        found => return refused("distortion_model", found, "radtan or equidistant"),
    };
    let inner = numbers(&key("intrinsics"), need(cam, "intrinsics", CAMERA)?)?;
    let lens = list(&key("distortion_coeffs"), need(cam, "distortion_coeffs", CAMERA)?)?;
    camera(name, inner, model, &lens)
}
