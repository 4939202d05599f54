//! Rectified cameras from the files of the programs that calibrate: what they say of the images after
//! rectification.
//!
//! * OpenCV: `P1` and `P2` of stereoRectify, or `Q`.
//! * ROS: the projection matrices of both camera_infos.
//! * `rectified.json`, which the command `rectify` writes.
//! * Any of them whose cameras stand as rectified ones do, without lenses.

use super::tree::{Tree, numbers};
use super::{Found, find, opencv, ros, trees};
use crate::calibration::{Calibration, Fault, Intrinsics, rig};
use nalgebra::Matrix3;
use std::path::PathBuf;

/// How far an element of the rotation between rectified cameras may be from the identity's: their files round
/// it.
const ROTATION_TOLERANCE: f64 = 1e-5;

/// The rectified rig, or nothing where the files are of none of these formats.
pub(in crate::calibration) fn read(
    paths: &[PathBuf],
    texts: &[String],
    told_m: Option<f64>,
) -> Result<Option<Calibration>, Fault> {
    let trees = trees(texts)?;
    let unit_m = opencv::unit(&trees, told_m)?;
    if let [one, two] = trees.as_slice()
        && ros::is_one(one)
        && ros::is_one(two)
    {
        let both = [ros::projection(one)?, ros::projection(two)?];
        let found = projections("ROS", ["projection_matrix"; 2], both)?;
        return found.calibration(1.0, ros::image_size([one, two])?).map(Some);
    }
    if let Some(found) = find_pair(&trees)? {
        let unit_m = if found.format == RECORD { 1.0 } else { unit_m };
        return found.calibration(unit_m, opencv::image_size(&trees)?).map(Some);
    }
    if !trees.iter().any(super::is_tree) {
        return Ok(None);
    }
    standing(find(paths, texts, told_m)?).map(Some)
}

/// Two rectified cameras as a file says them: the baseline in the file's unit.
pub(super) struct Pair<'a> {
    format: &'static str,
    pub(super) cameras: [Intrinsics<'a>; 2],
    baseline_key: &'a str,
    baseline: f64,
}

impl Pair<'_> {
    fn calibration(self, unit_m: f64, size: Option<[u64; 2]>) -> Result<Calibration, Fault> {
        let Self { format, cameras, baseline_key, baseline } = self;
        calibration(format, cameras, (baseline_key, baseline * unit_m), size)
    }
}

/// The format of the file that the command `rectify` writes, whose lengths are metres.
const RECORD: &str = "rectified.json";

/// The rectified cameras of `P1` and `P2`, of `Q`, or of `rectified.json`.
pub(super) fn find_pair(trees: &[Tree]) -> Result<Option<Pair<'_>>, Fault> {
    if let Some(tree) = trees.iter().find(|tree| tree.get("focal_px").is_some() && tree.get("q").is_some()) {
        return of_q(RECORD, "q", tree).map(Some);
    }
    let projection = |side| trees.iter().find_map(|tree| opencv::projection(tree, side));
    if let (Some((left_key, left)), Some((right_key, right))) = (projection(0), projection(1)) {
        let both = [numbers(left_key, left)?, numbers(right_key, right)?];
        return projections("OpenCV", [left_key, right_key], both).map(Some);
    }
    trees.iter().find(|tree| tree.get("Q").is_some()).map(|tree| of_q("OpenCV", "Q", tree)).transpose()
}

/// `P = K [1 | t]`, the second with `-f b` in its fourth column.
fn projections<'a>(format: &'static str, keys: [&'a str; 2], p: [[f64; 12]; 2]) -> Result<Pair<'a>, Fault> {
    // In whatever order they were given.
    let [left, right] = if p[0][3] < 0.0 && p[1][3] == 0.0 { [1, 0] } else { [0, 1] };
    if p[right][7] != p[left][7] {
        return Err(Fault::Below);
    }
    let camera = |i: usize| Intrinsics { key: keys[i], fx: p[i][0], fy: p[i][5], cx: p[i][2], cy: p[i][6] };
    // A focal length of 0 is refused by its name before the quotient counts.
    let baseline = (p[left][3] - p[right][3]) / p[left][0];
    Ok(Pair { format, cameras: [camera(left), camera(right)], baseline_key: keys[right], baseline })
}

/// `Q = [1 0 0 -cx; 0 1 0 -cy; 0 0 0 f; 0 0 1/b (cx' - cx)/b]`.
fn of_q<'a>(format: &'static str, key: &'a str, tree: &Tree) -> Result<Pair<'a>, Fault> {
    let wrong = || Fault::Key { key: key.into(), problem: "is no Q of cameras beside each other".into() };
    if tree.get("axis").and_then(Tree::as_str) == Some("vertical") {
        return Err(Fault::Below);
    }
    let q: [f64; 16] = numbers(key, tree.get(key).ok_or_else(wrong)?)?;
    let is_one = q[0] == 1.0
        && q[5] == 1.0
        && q[14] != 0.0
        && [1, 2, 4, 6, 8, 9, 10, 12, 13].iter().all(|&i| q[i] == 0.0);
    if !is_one {
        return Err(wrong());
    }
    let (f, cx, cy, baseline) = (q[11], -q[3], -q[7], 1.0 / q[14]);
    let camera = |cx| Intrinsics { key, fx: f, fy: f, cx, cy };
    let cameras = [camera(cx), camera(cx + q[15] * baseline)];
    Ok(Pair { format, cameras, baseline_key: key, baseline })
}

/// Cameras as they are mounted, where that is as rectified ones are.
fn standing(found: Found) -> Result<Calibration, Fault> {
    let pose = &found.pose;
    let is_aligned = (pose.rotation() - Matrix3::identity()).amax() <= ROTATION_TOLERANCE
        && pose.translation().yz().amax() <= ROTATION_TOLERANCE * pose.translation().norm()
        && found.cameras.iter().all(|camera| camera.lens().is_none());
    if !is_aligned {
        return Err(Fault::NotRectified);
    }
    let camera = |i: usize, key| {
        let ((fx, fy), (cx, cy)) = (found.cameras[i].focal_px(), found.cameras[i].principal_point());
        Intrinsics { key, fx, fy, cx, cy }
    };
    let both = [camera(0, "the left camera"), camera(1, "the right camera")];
    calibration(found.format, both, (found.baseline_key, pose.translation().x), found.size)
}

fn calibration(
    format: &'static str,
    [left, right]: [Intrinsics; 2],
    (key, baseline_m): (&str, f64),
    size: Option<[u64; 2]>,
) -> Result<Calibration, Fault> {
    let rig = rig(left, right, key, baseline_m)?;
    super::likely(format, key, f64::from(rig.baseline_m()))?;
    // Sides of at most 65535 px.
    let [width, height] = [0, 1].map(|side| size.map(|size| size[side] as u16));
    Ok(Calibration { path: PathBuf::new(), format, rig, width, height, disparities: None })
}
