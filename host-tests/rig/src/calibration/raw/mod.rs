//! Rigs that are not rectified, from the files of the programs that calibrate them.
//!
//! In: one file, or two of ROS. Out: a [`RawCalibration`], in metres. The formats are told apart by content:
//!
//! * `opencv`: FileStorage as YAML, XML or JSON, with K1, D1, K2, D2, R and T by their usual names; `P' = R P
//!   + T`.
//! * `ros`: a camera_info for each camera; where the second stands is in its rectification and projection
//!   matrices.
//! * `kalibr`: a camchain with `cam0`, `cam1` and `T_cn_cnm1`, which carries a point of cam0 into cam1.
//! * `record`: the core's own, as it stands in flash.
//! * Middlebury's and KITTI's calib.txt, whose cameras are rectified.
//!
//! `tree` reads the first three's syntax; `aligned` reads what they say of rectified images, [`cameras`] of
//! the cameras alone.

mod aligned;
mod kalibr;
mod opencv;
mod record;
mod ros;
mod tree;

use super::{Calibration, CalibrationError, Fault, kitti, load_all, middlebury};
use nalgebra::{Matrix3, Vector3};
use std::path::{Path, PathBuf};
use stereopsis::geometry::{
    camera::{Camera, Distortion, Fisheye, ImageSize, Lens, Pose, StereoRig},
    rectify::{Crop, Rectification, RectifyError},
};
use tree::Tree;

pub(super) use aligned::read as rectified_rig;
pub(super) use record::read as recorded;

/// Baselines beyond these are taken for a wrong unit, m.
const LIKELY_M: std::ops::RangeInclusive<f64> = 1e-3..=10.0;

/// A rig from a file.
#[derive(Clone, PartialEq, Debug)]
pub struct RawCalibration {
    /// The file; the first of two.
    pub path: PathBuf,
    /// The format's name.
    pub format: &'static str,
    /// The two cameras, their lenses, where they stand and the sizes of their images.
    pub rig: StereoRig<f64>,
}

/// A camera of a file, and where the second stands, before all is checked together.
struct Found {
    format: &'static str,
    cameras: [Camera<f64>; 2],
    pose: Pose<f64>,
    /// Where the file says it.
    size: Option<[u64; 2]>,
    /// What names the baseline in the file.
    baseline_key: &'static str,
}

impl RawCalibration {
    /// Reads a rig for images of `images` px, or of the size that the file says where none is given. Lengths
    /// of OpenCV's files are in units of `unit_m` metres where the file does not say `length_unit`, and
    /// in metres where neither does; the other formats say theirs.
    pub fn open(
        paths: &[PathBuf],
        images: Option<ImageSize>,
        unit_m: Option<f64>,
    ) -> Result<Self, CalibrationError> {
        let path = paths.first().cloned().unwrap_or_default();
        if let [one] = paths
            && let Some(record) = record::read(one)
        {
            let read =
                record.and_then(|rig| Self::checked(path.clone(), "record", rig, images, "the record"));
            return read.map_err(|fault| CalibrationError { path: path.clone(), fault });
        }
        let texts = load_all(paths)?;
        check_two(paths, &texts)?;
        let read = || -> Result<Self, Fault> {
            let found = find(paths, &texts, unit_m)?;
            let images = match (images, found.size) {
                (Some(images), _) => images,
                (None, Some([width, height])) => {
                    let [width, height] = [width, height].map(|side| u16::try_from(side).unwrap_or(u16::MAX));
                    ImageSize { width, height }
                }
                (None, None) => return Err(Fault::NoSize),
            };
            let size = found.size.map_or(images, |size| {
                let [width, height] = size.map(|side| u16::try_from(side).unwrap_or(u16::MAX));
                ImageSize { width, height }
            });
            let rig = StereoRig::new(found.cameras, found.pose, [size; 2]).map_err(Fault::StereoRig)?;
            Self::checked(path.clone(), found.format, rig, Some(images), found.baseline_key)
        };
        read().map_err(|fault| CalibrationError { path: path.clone(), fault })
    }

    fn checked(
        path: PathBuf,
        format: &'static str,
        rig: StereoRig<f64>,
        images: Option<ImageSize>,
        baseline_key: &'static str,
    ) -> Result<Self, Fault> {
        for (images, size) in images.iter().flat_map(|images| rig.sizes().map(|size| (images, size))) {
            let sides = [("width", size.width, images.width), ("height", size.height, images.height)];
            if let Some((which, calibrated, image)) = sides.into_iter().find(|(_, a, b)| a != b) {
                return Err(Fault::Size { which, calibrated, image });
            }
        }
        likely(format, baseline_key, rig.baseline_m())?;
        // All else that rectification may refuse is fine elsewhere.
        if let Err(error @ RectifyError::Swapped(_)) = Rectification::new(&rig, Crop::Natural, rig.sizes()[0])
        {
            return Err(Fault::Swapped(error));
        }
        Ok(Self { path, format, rig })
    }
}

/// Refuses what is rather in another unit.
pub(super) fn likely(format: &str, key: &str, baseline_m: f64) -> Result<(), Fault> {
    if LIKELY_M.contains(&baseline_m) {
        return Ok(());
    }
    let advice = match format {
        "OpenCV" => "where it is in millimetres, say --unit mm",
        "Middlebury" => "this format has it in millimetres",
        _ => "this format has lengths in metres",
    };
    Err(Fault::Unit { key: key.into(), baseline_m, advice })
}

/// The documents of files that are trees; what is of another format has none.
fn trees(texts: &[String]) -> Result<Vec<Tree>, Fault> {
    let mut trees = Vec::new();
    for text in texts.iter().filter(|text| !kitti::counts_from_one(text)) {
        match tree::read(text) {
            Ok(found) => trees.extend(found),
            Err(error) if text.trim_start().starts_with(['%', '<', '{']) => return Err(Fault::Syntax(error)),
            Err(_) => {}
        }
    }
    Ok(trees)
}

/// The cameras alone, wherever they stand; one twice where the files say of one only. Nothing where the files
/// are of none of these formats.
pub(super) fn cameras(texts: &[String]) -> Result<Option<[Camera<f64>; 2]>, Fault> {
    let trees = trees(texts)?;
    let both = match trees.as_slice() {
        [one, ..] if kalibr::is_one(one) => kalibr::cameras(one)?,
        [one, two] if ros::is_one(one) && ros::is_one(two) => [ros::camera_of(one)?, ros::camera_of(two)?],
        [one] if ros::is_one(one) => [ros::camera_of(one)?; 2],
        trees if trees.iter().any(opencv::is_one) => opencv::cameras(trees)?,
        trees => match (aligned::find_pair(trees)?, trees.iter().find(|tree| opencv::is_one_camera(tree))) {
            (Some(pair), _) => {
                let [left, right] =
                    pair.cameras.map(|c| camera(c.key, [c.fx, c.fy, c.cx, c.cy], Model::BrownConrady, &[]));
                [left?, right?]
            }
            (None, Some(tree)) => [opencv::camera_of(tree)?; 2],
            (None, None) => return Ok(None),
        },
    };
    Ok(Some(both))
}

/// Refuses two files that do not go together.
pub(super) fn check_two(paths: &[PathBuf], texts: &[String]) -> Result<(), CalibrationError> {
    if texts.len() < 2 {
        return Ok(());
    }
    let mut are_of_ros = Vec::new();
    for (path, text) in paths.iter().zip(texts) {
        let failed = |fault| Err(CalibrationError { path: path.clone(), fault });
        if middlebury::is_one(text) || kitti::has_numbers_of_both(text) {
            return failed(Fault::Whole);
        }
        match tree::read(text) {
            Ok(trees) => are_of_ros.push(trees.iter().any(ros::is_one)),
            Err(error) => return failed(Fault::Syntax(error)),
        }
    }
    let odd = are_of_ros.iter().position(|is_one| !is_one).filter(|_| are_of_ros.contains(&true));
    odd.map_or(Ok(()), |i| Err(CalibrationError { path: paths[i].clone(), fault: Fault::NotTheOther }))
}

fn find(paths: &[PathBuf], texts: &[String], unit_m: Option<f64>) -> Result<Found, Fault> {
    let mut trees = Vec::new();
    let mut fault = None;
    for (path, text) in paths.iter().zip(texts) {
        if kitti::counts_from_one(text) {
            return rectified(std::slice::from_ref(path), unit_m);
        }
        match tree::read(text) {
            Ok(found) => trees.extend(found),
            Err(error) => fault = Some(error),
        }
        if trees.iter().all(|tree| !is_tree(tree)) && (middlebury::is_one(text) || kitti::is_one(text)) {
            return rectified(std::slice::from_ref(path), unit_m);
        }
    }
    match trees.as_slice() {
        [one, ..] if kalibr::is_one(one) => kalibr::read(one),
        [one, two] if ros::is_one(one) && ros::is_one(two) => ros::read(one, two),
        [one, ..] if ros::is_one(one) => Err(Fault::OneOfTwo),
        [one, rest @ ..] if opencv::is_one(one) || rest.iter().any(opencv::is_one) => {
            opencv::read(&trees, unit_m)
        }
        [_, ..] if aligned::find_pair(&trees)?.is_some() => rectified(paths, unit_m),
        _ => Err(fault.map_or(Fault::UnknownRaw, Fault::Syntax)),
    }
}

fn is_tree(tree: &Tree) -> bool {
    kalibr::is_one(tree) || ros::is_one(tree) || opencv::is_one(tree)
}

/// The cameras of a file that says how they are after rectification.
fn rectified(paths: &[PathBuf], unit_m: Option<f64>) -> Result<Found, Fault> {
    // The files themselves stand for the left image, whose place says which of KITTI's pairs is meant.
    let left = paths.first().map_or(Path::new(""), PathBuf::as_path);
    let calibration = Calibration::open_all(paths, left, unit_m).map_err(|error| error.fault)?;
    let rig = &calibration.rig;
    let (f, (cx, cy)) = (f64::from(rig.focal_px()), rig.principal_point());
    let offset = f64::from(rig.disparity_offset_px());
    let one = |key: &str, cx: f64| camera(key, [f, f, cx, f64::from(cy)], Model::BrownConrady, &[]);
    let pose = Pose::new(Matrix3::identity(), Vector3::new(f64::from(rig.baseline_m()), 0.0, 0.0));
    Ok(Found {
        format: calibration.format,
        cameras: [one("the left camera", f64::from(cx))?, one("the right camera", f64::from(cx) + offset)?],
        pose: pose.map_err(|error| Fault::Key { key: "the baseline".into(), problem: error.to_string() })?,
        size: calibration.width.zip(calibration.height).map(|(w, h)| [w.into(), h.into()]),
        baseline_key: "the baseline",
    })
}

/// How a lens's coefficients act.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Model {
    /// k1, k2, p1, p2, k3, k4, k5, k6 in OpenCV's order; what comes after them has to be zero.
    BrownConrady,
    /// k1, k2, k3, k4 of the angle to the axis.
    Fisheye,
}

/// A camera of fx, fy, cx, cy and its lens.
fn camera(key: &str, [fx, fy, cx, cy]: [f64; 4], model: Model, lens: &[f64]) -> Result<Camera<f64>, Fault> {
    let wrong = |problem: &str| Err(Fault::Key { key: key.into(), problem: problem.into() });
    let lens = match (model, lens) {
        (Model::Fisheye, &[k1, k2, k3, k4]) => Lens::from(Fisheye::from_opencv([k1, k2, k3, k4])),
        (Model::Fisheye, _) => return wrong("a fisheye lens has four coefficients, k1, k2, k3, k4"),
        (Model::BrownConrady, lens) => {
            if lens.iter().skip(8).any(|&k| k != 0.0) {
                return wrong(
                    "a lens with thin prisms or a tilted sensor (coefficients from the ninth on) is not \
                     supported; calibrate with k1, k2, p1, p2, k3, k4, k5, k6 at most",
                );
            }
            let mut eight = [0.0; 8];
            eight.iter_mut().zip(lens).for_each(|(to, &k)| *to = k);
            Distortion::from_opencv_rational(eight).into()
        }
    };
    let camera = Camera::new(fx, fy, cx, cy).and_then(|c| c.with_distortion(lens));
    camera.map_err(|error| Fault::Camera { key: key.into(), error })
}

/// The pose of R and T as OpenCV writes them.
fn pose_of(keys: &str, r: [f64; 9], t: [f64; 3]) -> Result<Pose<f64>, Fault> {
    let pose = Pose::from_opencv(Matrix3::from_row_slice(&r), Vector3::from(t));
    pose.map_err(|error| Fault::Key { key: keys.into(), problem: error.to_string() })
}
