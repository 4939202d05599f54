//! ROS's camera_info, one for each camera.

use super::tree::{Tree, list, need, numbers, size};
use super::{Fault, Found, Model, camera, pose_of};
use nalgebra::{Matrix3, Vector3};
use serde_json::json;

const FORM: &str = "a camera_info has image_width, camera_matrix, distortion_coefficients, \
                    rectification_matrix, projection_matrix";

pub(super) fn is_one(tree: &Tree) -> bool {
    tree.get("camera_matrix").is_some() && tree.get("projection_matrix").is_some()
}

/// The second camera's projection has `P[0, 3] = -f b` (or `P[1, 3]`, below each other), and both
/// rectification matrices turn into one frame, so `R = R2^T R1` and `T = R2^T (P[0, 3] / f, P[1, 3] / f, 0)`.
pub(super) fn read(first: &Tree, second: &Tree) -> Result<Found, Fault> {
    let [shift, other] =
        [projection(first)?, projection(second)?].map(|p| Vector3::new(p[3] / p[0], p[7] / p[5], 0.0));
    // In whatever order they were given: the first is the one that the projection counts from.
    if shift.norm() > 0.0 && other.norm() == 0.0 {
        return read(second, first);
    }
    let turns = [rotation(first)?, rotation(second)?];
    let r = turns[1].transpose() * turns[0];
    let t = turns[1].transpose() * (other - shift);
    let size = image_size([first, second])?;
    Ok(Found {
        format: "ROS",
        cameras: [one("the first camera", first)?, one("the second camera", second)?],
        pose: pose_of(
            "rectification_matrix",
            r.transpose().as_slice().try_into().unwrap_or([0.0; 9]),
            t.into(),
        )?,
        size,
        baseline_key: "projection_matrix",
    })
}

/// The size of the images, which is one for both cameras, where it is told.
pub(super) fn image_size(trees: [&Tree; 2]) -> Result<Option<[u64; 2]>, Fault> {
    const KEYS: &str = "image_width and image_height";
    let told = |tree: &Tree| {
        let sides = tree.get("image_width").zip(tree.get("image_height"));
        sides.map(|(w, h)| size(KEYS, &json!([w, h]))).transpose()
    };
    match [told(trees[0])?, told(trees[1])?] {
        [Some(one), Some(two)] if one != two => {
            let ([w, h], [w2, h2]) = (one, two);
            let problem =
                format!("{w} x {h} of one camera, {w2} x {h2} of the other; give those of one size");
            Err(Fault::Key { key: KEYS.into(), problem })
        }
        [one, two] => Ok(one.or(two)),
    }
}

pub(super) fn projection(tree: &Tree) -> Result<[f64; 12], Fault> {
    let p: [f64; 12] = numbers("projection_matrix", need(tree, "projection_matrix", FORM)?)?;
    if p[0] > 0.0 && p[5] > 0.0 {
        return Ok(p);
    }
    Err(Fault::FocalLength { key: "projection_matrix".into(), focal_px: p[0].min(p[5]) })
}

fn rotation(tree: &Tree) -> Result<Matrix3<f64>, Fault> {
    let r: [f64; 9] = numbers("rectification_matrix", need(tree, "rectification_matrix", FORM)?)?;
    // Checked by itself: the product of two wrong ones may be right.
    pose_of("rectification_matrix", r, [0.0; 3])?;
    Ok(Matrix3::from_row_slice(&r))
}

/// The camera of a camera_info.
pub(super) fn camera_of(tree: &Tree) -> Result<stereopsis::geometry::camera::Camera<f64>, Fault> {
    one("the camera", tree)
}

fn one(which: &str, tree: &Tree) -> Result<stereopsis::geometry::camera::Camera<f64>, Fault> {
    let model = match tree.get("distortion_model").and_then(Tree::as_str).unwrap_or("plumb_bob") {
        "plumb_bob" | "rational_polynomial" | "none" | "" => Model::BrownConrady,
        "equidistant" | "fisheye" => Model::Fisheye,
        found => {
            let problem = format!(
                "'{found}' is not supported; calibrate with plumb_bob, rational_polynomial or equidistant"
            );
            return Err(Fault::Key { key: "distortion_model".into(), problem });
        }
    };
    let k: [f64; 9] = numbers("camera_matrix", need(tree, "camera_matrix", FORM)?)?;
    let lens = list("distortion_coefficients", need(tree, "distortion_coefficients", FORM)?)?;
    camera(which, [k[0], k[4], k[2], k[5]], model, &lens)
}
