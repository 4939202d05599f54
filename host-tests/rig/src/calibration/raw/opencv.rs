//! OpenCV's FileStorage: the matrices by the names that calibration programs give them.

use super::tree::{Tree, list, numbers, size};
use super::{Fault, Found, Model, camera, pose_of};
use serde_json::{Value, json};
use stereopsis::geometry::camera::Camera;

/// Names of a camera's matrix without its number or side, and of its lens, in small letters without signs
/// between.
const MATRIX: [&str; 7] = ["m", "k", "a", "cameramatrix", "cammatrix", "intrinsicmatrix", "mtx"];
const LENS: [&str; 7] =
    ["d", "dist", "distcoeffs", "distcoeff", "distortioncoefficients", "distortioncoeffs", "distortion"];
const PROJECTION: [&str; 3] = ["p", "projection", "projectionmatrix"];
const MATRIX_FORM: &str = "the 3x3 camera matrix";
const LENS_FORM: &str = "the lens's coefficients k1, k2, p1, p2, k3";
const SIDES: [&[&str]; 2] = [&["1", "l", "left"], &["2", "r", "right"]];
const ROTATION: [&str; 4] = ["r", "rotation", "rotationmatrix", "rmat"];
const TRANSLATION: [&str; 4] = ["t", "translation", "translationvector", "tvec"];
const SIZE: [&str; 3] = ["imagesize", "imgsize", "size"];

/// Whether one of the matrices of two cameras is there.
pub(super) fn is_one(tree: &Tree) -> bool {
    let names = MATRIX.iter().chain(&LENS);
    let mut both = names.flat_map(|name| SIDES.map(|side| sided(tree, name, side)));
    both.any(|found| found.is_some())
        || (plain(tree, &ROTATION).is_some() && plain(tree, &TRANSLATION).is_some())
}

/// Whether the matrix of a camera without a number or a side is there.
pub(super) fn is_one_camera(tree: &Tree) -> bool {
    plain(tree, &MATRIX).is_some()
}

/// That camera.
pub(super) fn camera_of(tree: &Tree) -> Result<Camera<f64>, Fault> {
    let needed =
        |names: &[&str], key: &str, form| plain(tree, names).ok_or_else(|| Fault::Missing(key.into(), form));
    let matrix = needed(&MATRIX, "camera_matrix", MATRIX_FORM)?;
    one(matrix, needed(&LENS, "distortion_coefficients", LENS_FORM)?, model(std::slice::from_ref(tree)))
}

/// The two cameras.
pub(super) fn cameras(trees: &[Tree]) -> Result<[Camera<f64>; 2], Fault> {
    let model = model(trees);
    let of_camera = |names: &[&str], side: usize, key: &'static str, form| {
        let found =
            trees.iter().flat_map(|tree| names.iter().filter_map(|name| sided(tree, name, SIDES[side])));
        found.into_iter().next().ok_or_else(|| Fault::Missing(key.into(), form))
    };
    let both = [("K1", "D1"), ("K2", "D2")];
    let camera = |side: usize| {
        let (matrix, lens) = both[side];
        let matrix = of_camera(&MATRIX, side, matrix, MATRIX_FORM)?;
        one(matrix, of_camera(&LENS, side, lens, LENS_FORM)?, model)
    };
    Ok([camera(0)?, camera(1)?])
}

fn one(
    (key, matrix): (&str, &Value),
    (lens_key, lens): (&str, &Value),
    model: Model,
) -> Result<Camera<f64>, Fault> {
    let [fx, _, cx, _, fy, cy, _, _, scale] = numbers::<9>(key, matrix)?;
    if scale != 1.0 {
        return Err(Fault::Key {
            key: key.into(),
            problem: "the last element of a camera matrix is 1".into(),
        });
    }
    camera(key, [fx, fy, cx, cy], model, &list(lens_key, lens)?)
}

/// As OpenCV's own program of calibration marks its files, and as others name the model.
fn model(trees: &[Tree]) -> Model {
    let is_fisheye = trees.iter().any(|tree| {
        let flag = plain(tree, &["fisheyemodel", "fisheye"]).is_some_and(|(_, flag)| {
            flag.as_bool().or_else(|| flag.as_f64().map(|flag| flag != 0.0)).unwrap_or(false)
        });
        let name =
            plain(tree, &["model", "distortionmodel", "cameramodel"]).and_then(|(_, name)| name.as_str());
        flag || name.is_some_and(|name| ["fisheye", "equidistant"].contains(&name.to_lowercase().as_str()))
    });
    if is_fisheye { Model::Fisheye } else { Model::BrownConrady }
}

/// A rectified camera's projection matrix, of 12 numbers: p1 and p2 are a lens's coefficients too.
pub(super) fn projection(tree: &Tree, side: usize) -> Option<(&str, &Value)> {
    let found = PROJECTION.iter().find_map(|name| sided(tree, name, SIDES[side]))?;
    // KITTI's are lines of text. What is a matrix and none of numbers is refused by who reads it.
    let is_matrix = found.1.is_array() || found.1.get("data").is_some();
    (is_matrix && list(found.0, found.1).map_or(true, |numbers| numbers.len() == 12)).then_some(found)
}

pub(super) fn read(trees: &[Tree], unit_m: Option<f64>) -> Result<Found, Fault> {
    let cameras = cameras(trees)?;
    let of_rig = |names: &[&str], key: &'static str, form| {
        trees.iter().find_map(|tree| plain(tree, names)).ok_or_else(|| Fault::Missing(key.into(), form))
    };
    let (r_key, r) = of_rig(&ROTATION, "R", "the 3x3 rotation from the first camera to the second")?;
    let (t_key, t) = of_rig(&TRANSLATION, "T", "the translation from the first camera to the second")?;
    let unit_m = unit(trees, unit_m)?;
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
        size: image_size(trees)?,
        baseline_key: "T",
    })
}

/// The images' columns and rows, where the file says them.
pub(super) fn image_size(trees: &[Tree]) -> Result<Option<[u64; 2]>, Fault> {
    trees.iter().find_map(sides).map(|(key, value)| size(key, &value)).transpose()
}

/// The unit of T, m: what the file says, or what is told, which must agree.
pub(super) fn unit(trees: &[Tree], told_m: Option<f64>) -> Result<f64, Fault> {
    let Some((key, value)) = trees.iter().find_map(|tree| plain(tree, &["lengthunit"])) else {
        return Ok(told_m.unwrap_or(1.0));
    };
    let wrong = |problem: String| Err(Fault::Key { key: key.into(), problem });
    let said_m = match value.as_str() {
        Some("m") => 1.0,
        Some("cm") => 0.01,
        Some("mm") => 0.001,
        _ => return wrong(format!("{value} is no unit; m, cm or mm is right")),
    };
    if told_m.is_some_and(|told| told != said_m) {
        return wrong(format!("the file says {value}, --unit something else; leave --unit out"));
    }
    Ok(said_m)
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
