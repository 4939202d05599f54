//! A rig in words.

use super::{Calibration, RawCalibration, Reach};
use crate::rectify::RemapCapacity;
use nalgebra::{Point2, Vector2};
use std::fmt::Write;
use stereopsis::geometry::{
    camera::{Camera, ImageSize, StereoRig},
    rectify::{Crop, Rectification, RectifyError},
};
use stereopsis_rig::plan::{Plan, Rig, Wanted, describe_search};

/// The distances at which errors are told, m.
const DISTANCES_M: [f64; 6] = [0.25, 0.5, 1.0, 2.0, 5.0, 10.0];

/// What a rig is asked.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Asked {
    /// How many whole disparities are searched where no range is given.
    pub disparities: u16,
    /// The nearest and the farthest depth that are wanted, m.
    pub range_m: Option<[f64; 2]>,
    /// The deviation of a depth that is wanted, at most, as a share of it.
    pub accuracy: f64,
}

/// What a calibration says, what the rig can tell with the search that is asked, what limits it and what
/// would help, and what looks wrong: lines of text, the last ones warnings. A rig that cannot be rectified is
/// refused.
pub fn describe(calibration: &RawCalibration, asked: &Asked) -> Result<String, RectifyError> {
    let RawCalibration { rig, format, .. } = calibration;
    let rectified = Rectification::new(rig, Crop::Natural, rig.sizes()[0])?;
    Ok(with_warnings(described(rig, &rectified, format, asked), warnings(rig, &rectified)))
}

/// What looks wrong with a rig and its rectification, as [`describe`] says it.
pub fn warnings(rig: &StereoRig<f64>, rectified: &Rectification<f64>) -> Vec<String> {
    let mut warnings = Vec::new();
    for (name, camera) in ["left", "right"].into_iter().zip(rig.cameras()) {
        camera_warnings(name, camera, rig.sizes()[0], &mut warnings);
    }
    warnings.extend(baseline_warning(rig.baseline_m()));
    if !rectified.axis().is_horizontal() {
        warnings.push(
            "the cameras stand one above the other: match takes them side by side; turn both cameras' images \
             by 90 degrees and calibrate again"
                .to_owned(),
        );
    }
    let angle = rig.pose().angle_rad().to_degrees();
    if angle > 10.0 {
        warnings.push(format!(
            "the cameras are turned against each other by {angle:.0} degrees: much of both images is lost"
        ));
    }
    let common = rectified.report().common;
    if common < 0.7 {
        warnings.push(format!("both cameras see only {:.0} % of the rectified image", 100.0 * common));
    }
    let [left, right] = rig.cameras().each_ref().map(|camera| camera.focal_px().0);
    if (left / right).max(right / left) > 1.1 {
        warnings.push(format!("the focal lengths of the two cameras differ: {left:.0} and {right:.0} px"));
    }
    warnings
}

/// What the firmware's remaps take, which has the rig in either type; `None` where a remap cannot be.
fn remap_capacity(rig: &StereoRig<f64>, rectified: &Rectification<f64>) -> Option<RemapCapacity> {
    let single = StereoRig::<f32>::from_record(&rig.to_record()).ok()?;
    let single = Rectification::new(&single, Crop::Natural, rectified.size()).ok()?;
    Some(RemapCapacity::of(rectified).ok()?.max(RemapCapacity::of(&single).ok()?))
}

/// What a rig is in words.
fn described(rig: &StereoRig<f64>, rectified: &Rectification<f64>, format: &str, asked: &Asked) -> String {
    let size = rectified.size();
    let (report, f, b) = (rectified.report(), rectified.camera().focal_px().0, rig.baseline_m());
    let mut text = String::new();
    let _ = writeln!(text, "{format} calibration, images of {} x {} px", size.width, size.height);
    for (name, camera) in ["left", "right"].into_iter().zip(rig.cameras()) {
        describe_camera(name, camera, size, &mut text);
    }
    let t = rig.pose().translation();
    let way = if rectified.axis().is_horizontal() { "right of" } else { "below" };
    let angle = rig.pose().angle_rad().to_degrees();
    let _ = writeln!(
        text,
        "baseline     {:.2} mm: the second camera stands {way} the first, {:.2} mm across and {:.2} mm ahead",
        1000.0 * b,
        1000.0 * if rectified.axis().is_horizontal() { t.y } else { t.x },
        1000.0 * t.z
    );
    let _ = writeln!(text, "turned       {angle:.2} degrees against each other");
    let [across, down] = report.field_of_view_rad.map(f64::to_degrees);
    let _ = writeln!(
        text,
        "rectified    f {f:.1} px, both see {:.0} % of the image: {across:.1} x {down:.1} degrees; a remap \
         holds about {} and {} rows",
        100.0 * report.common,
        report.rows[0],
        report.rows[1]
    );
    if let Some(capacity) = remap_capacity(rig, rectified) {
        let kilobytes = capacity.bytes().div_ceil(1024);
        let _ = writeln!(text, "firmware     {capacity} for Crop::Natural at this size, {kilobytes} KB");
    }
    let told = Rig { baseline_m: b, focal_px: f, offset_px: 0.0, width: size.width, height: size.height };
    depths(told, asked, &mut text);
    text
}

/// What a calibration of rectified images says, and what they can tell with the search that is asked: lines
/// of text, the last ones warnings. A range of depths takes a size.
pub fn describe_rectified(calibration: &Calibration, size: Option<ImageSize>, asked: &Asked) -> String {
    let rig = &calibration.rig;
    let (f, b) = (f64::from(rig.focal_px()), f64::from(rig.baseline_m()));
    let (cx, cy) = rig.principal_point();
    let offset_px = f64::from(rig.disparity_offset_px());
    let mut text = format!("{} calibration of rectified images", calibration.format);
    if let Some(ImageSize { width, height }) = size {
        let _ = write!(text, " of {width} x {height} px");
    }
    let _ = writeln!(text, "\nbaseline     {:.2} mm", 1000.0 * b);
    let _ = writeln!(
        text,
        "rectified    f {f:.1} px, centre {cx:.1}, {cy:.1}; depth is f b / (d {offset_px:+.2} px)"
    );
    let ImageSize { width, height } = size.unwrap_or(ImageSize { width: 0, height: 0 });
    depths(Rig { baseline_m: b, focal_px: f, offset_px, width, height }, asked, &mut text);
    let off = size.and_then(|size| off_middle((cx.into(), cy.into()), size));
    let off = off.map(|off| format!("{off}: was it made for images of another size?"));
    with_warnings(text, baseline_warning(b).into_iter().chain(off).collect())
}

/// The depths that a rig tells, what limits it and what would help, in the words of a plan.
fn depths(rig: Rig, asked: &Asked, text: &mut String) {
    let Asked { disparities, range_m, accuracy } = *asked;
    if let Some([nearest_m, farthest_m]) = range_m {
        let plan = Plan::new(rig, Wanted { nearest_m, farthest_m, accuracy, ..Wanted::default() });
        plan.describe_depths(text);
        plan.describe_limits(text);
        return;
    }
    let (fb_px_m, offset_px) = (rig.focal_px * rig.baseline_m, rig.offset_px);
    let reach = Reach { fb_px_m, offset_px, min_disparity: 0, disparities, sigma_px: Reach::SIGMA_PX };
    reach.describe(&DISTANCES_M, text);
    describe_search(&reach, rig.baseline_m, accuracy, text);
}

/// What is wrong with a principal point in the outer tenth of images of a size, or outside of them: it is
/// most likely that of images of another size, which KITTI's files do not say, and not all of OpenCV's.
pub fn off_middle((cx, cy): (f64, f64), ImageSize { width, height }: ImageSize) -> Option<String> {
    let is_inside = |c: f64, side: u16| {
        let side = f64::from(side);
        (0.1 * side..=0.9 * side).contains(&c)
    };
    (!is_inside(cx, width) || !is_inside(cy, height)).then(|| {
        format!(
            "its principal point ({cx:.1}, {cy:.1}) is not near the middle of the images, which are {width} \
             x {height} px"
        )
    })
}

/// What looks wrong with a baseline, m.
fn baseline_warning(b: f64) -> Option<String> {
    if b > 0.6 {
        return Some(format!(
            "a baseline of {b:.2} m is long for a small rig: was T in another unit? say --unit mm or cm"
        ));
    }
    let mm = 1000.0 * b;
    (b < 0.005).then(|| format!("a baseline of {mm:.2} mm is short: was T in another unit? say --unit"))
}

/// A text with its warnings, or that there are none.
fn with_warnings(mut text: String, warnings: Vec<String>) -> String {
    if warnings.is_empty() {
        text += "nothing looks wrong\n";
    }
    for warning in warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    text
}

/// By how many pixels a lens moves the corners of the image; `None` where one of them has no sight.
fn corners_moved_px(camera: &Camera<f64>, size: ImageSize) -> Option<[f64; 4]> {
    let (w, h) = (f64::from(size.width) - 1.0, f64::from(size.height) - 1.0);
    let mut moved_px = [0.0; 4];
    for (moved_px, corner) in moved_px.iter_mut().zip([[0.0, 0.0], [w, 0.0], [0.0, h], [w, h]]) {
        let corner = Point2::from(corner);
        *moved_px = (camera.undistort(&corner).ok()? - corner).norm();
    }
    Some(moved_px)
}

/// One camera in words.
fn describe_camera(name: &str, camera: &Camera<f64>, size: ImageSize, text: &mut String) {
    let ((fx, fy), (cx, cy)) = (camera.focal_px(), camera.principal_point());
    let (w, h) = (f64::from(size.width) - 1.0, f64::from(size.height) - 1.0);
    let sight = |x: f64, y: f64| camera.unproject(&Point2::new(x, y)).ok();
    let angle = |a: Option<nalgebra::Vector3<f64>>, b: Option<nalgebra::Vector3<f64>>| {
        a.zip(b).map_or_else(|| "unknown".to_owned(), |(a, b)| format!("{:.1}", a.angle(&b).to_degrees()))
    };
    let _ = writeln!(
        text,
        "{name:<12} f {fx:.1} x {fy:.1} px, centre {cx:.1}, {cy:.1}; sees {} x {} degrees",
        angle(sight(0.0, cy), sight(w, cy)),
        angle(sight(cx, 0.0), sight(cx, h))
    );
    if !camera.lens().is_none()
        && let Some(moved_px) = corners_moved_px(camera, size)
    {
        let most = moved_px.into_iter().fold(0.0, f64::max);
        let _ = writeln!(text, "{:<12} the lens moves a corner of the image by {most:.1} px", "");
    }
}

/// What looks wrong with one camera.
fn camera_warnings(name: &str, camera: &Camera<f64>, size: ImageSize, warnings: &mut Vec<String>) {
    if !camera.lens().is_none() && corners_moved_px(camera, size).is_none() {
        warnings.push(format!(
            "the {name} lens's coefficients describe no sight for a corner of the image: it stays black"
        ));
    }
    let ((fx, fy), (cx, cy)) = (camera.focal_px(), camera.principal_point());
    let (w, h) = (f64::from(size.width) - 1.0, f64::from(size.height) - 1.0);
    let off = Vector2::new((cx - w / 2.0) / w, (cy - h / 2.0) / h).amax();
    if off > 0.15 {
        warnings.push(format!(
            "the {name} principal point ({cx:.0}, {cy:.0}) is far from the middle of {} x {} px: was it \
             calibrated at another size?",
            size.width, size.height
        ));
    }
    if (fx / fy).max(fy / fx) > 1.02 {
        warnings.push(format!("the {name} camera's pixels are not square: fx {fx:.1}, fy {fy:.1} px"));
    }
}
