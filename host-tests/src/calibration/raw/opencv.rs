//! OpenCV's FileStorage: the matrices by the names that calibration programs give them.

use super::tree::{Tree, list, numbers, size};
use super::{Fault, Found, Model, camera, pose_of};
use serde_json::{Value, json};

/// Names of a camera's matrix without its number or side, and of its lens, in small letters without signs between.
const MATRIX: [&str; 7] = ["m", "k", "a", "cameramatrix", "cammatrix", "intrinsicmatrix", "mtx"];
const LENS: [&str; 7] =
    ["d", "dist", "distcoeffs", "distcoeff", "distortioncoefficients", "distortioncoeffs", "distortion"];
const SIDES: [&[&str]; 2] = [&["1", "l", "left"], &["2", "r", "right"]];
const ROTATION: [&str; 4] = ["r", "rotation", "rotationmatrix", "rmat"];
const TRANSLATION: [&str; 4] = ["t", "translation", "translationvector", "tvec"];
const SIZE: [&str; 3] = ["imagesize", "imgsize", "size"];

/// Whether one of the matrices of two cameras is there.
pub(super) fn is_one(tree: &Tree) -> bool {
    let names = MATRIX.iter().chain(&LENS);
    let mut both = names.flat_map(|name| SIDES.map(|side| sided(tree, name, side)));
    both.any(|found| found.is_some()) || (plain(tree, &ROTATION).is_some() && plain(tree, &TRANSLATION).is_some())
}

pub(super) fn read(trees: &[Tree], unit_m: f64) -> Result<Found, Fault> {
    let of_camera = |names: &[&str], side: usize, key: &'static str, form| {
        let found = trees.iter().flat_map(|tree| names.iter().filter_map(|name| sided(tree, name, SIDES[side])));
        found.into_iter().next().ok_or_else(|| Fault::Missing(key.into(), form))
    };
    let of_rig = |names: &[&str], key: &'static str, form| {
        trees.iter().find_map(|tree| plain(tree, names)).ok_or_else(|| Fault::Missing(key.into(), form))
    };
    // As OpenCV's own program of calibration marks its files, and as others name the model.
    let is_fisheye = trees.iter().any(|tree| {
        let flag = plain(tree, &["fisheyemodel", "fisheye"])
            .is_some_and(|(_, flag)| flag.as_bool().or_else(|| flag.as_f64().map(|flag| flag != 0.0)).unwrap_or(false));
        let name = plain(tree, &["model", "distortionmodel", "cameramodel"]).and_then(|(_, name)| name.as_str());
        flag || name.is_some_and(|name| ["fisheye", "equidistant"].contains(&name.to_lowercase().as_str()))
    });
    let model = if is_fisheye { Model::Fisheye } else { Model::BrownConrady };
    let one = |side: usize, matrix_key: &'static str, lens_key: &'static str| {
        let (key, value) = of_camera(&MATRIX, side, matrix_key, "the 3x3 camera matrix")?;
        let [fx, _, cx, _, fy, cy, _, _, scale] = numbers::<9>(key, value)?;
        if scale != 1.0 {
            return Err(Fault::Key { key: key.into(), problem: "the last element of a camera matrix is 1".into() });
        }
        let (lens_key, lens) = of_camera(&LENS, side, lens_key, "the lens's coefficients k1, k2, p1, p2, k3")?;
        camera(key, [fx, fy, cx, cy], model, &list(lens_key, lens)?)
    };
    let cameras = [one(0, "K1", "D1")?, one(1, "K2", "D2")?];
    let (r_key, r) = of_rig(&ROTATION, "R", "the 3x3 rotation from the first camera to the second")?;
    let (t_key, t) = of_rig(&TRANSLATION, "T", "the translation from the first camera to the second")?;
    let t = numbers::<3>(t_key, t)?.map(|x| x * unit_m);
    // Some programs write a rotation vector.
    let r = match list(r_key, r)?.as_slice() {
        [x, y, z] => {
            let turn = nalgebra::Rotation3::new(nalgebra::Vector3::new(*x, *y, *z));
            turn.transpose().matrix().as_slice().try_into().unwrap_or([0.0; 9])
        }
        _ => numbers::<9>(r_key, r)?,
    };
    Ok(Found {
        format: "OpenCV",
        cameras,
        pose: pose_of(r_key, r, t)?,
        size: trees.iter().find_map(sides).map(|(key, value)| size(key, &value)).transpose()?,
        baseline_key: "T",
    })
}

/// A key of a camera: `K1`, `cameraMatrixLeft`, `left_camera_matrix`.
fn sided<'a>(tree: &'a Tree, name: &str, sides: &[&str]) -> Option<(&'a str, &'a Value)> {
    let is_it = |key: &str| {
        let key = simple(key);
        sides.iter().any(|side| {
            key.strip_suffix(side) == Some(name) || (side.len() > 1 && key.strip_prefix(side) == Some(name))
        })
    };
    tree.as_object()?.iter().find(|(key, _)| is_it(key)).map(|(key, value)| (key.as_str(), value))
}

fn plain<'a>(tree: &'a Tree, names: &[&str]) -> Option<(&'a str, &'a Value)> {
    let found = tree.as_object()?.iter().find(|(key, _)| names.contains(&simple(key).as_str()));
    found.map(|(key, value)| (key.as_str(), value))
}

/// The images' columns and rows, in one key or in two.
fn sides(tree: &Tree) -> Option<(&str, Value)> {
    if let Some((key, value)) = plain(tree, &SIZE) {
        let value = match (value.get("width"), value.get("height")) {
            (Some(w), Some(h)) => json!([w, h]),
            _ => value.clone(),
        };
        return Some((key, value));
    }
    let (_, w) = plain(tree, &["imagewidth", "width"])?;
    let (_, h) = plain(tree, &["imageheight", "height"])?;
    Some(("image_width and image_height", json!([w, h])))
}

/// A key in small letters, without signs.
fn simple(key: &str) -> String {
    key.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}
