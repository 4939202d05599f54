//! From boards to a rig, and from a rig to its files and back.

mod boards;
mod record;
mod rigs;

use nalgebra::{Rotation3, Vector3};
use stereopsis::geometry::camera::{Camera, Distortion, ImageSize, Pose, StereoRig};
use stereopsis_host::calibrate::board::{Dictionary, Markers, Pattern};

const SIZE: ImageSize = ImageSize { width: 320, height: 240 };

fn pattern(columns: usize, rows: usize) -> Pattern {
    Pattern::new(columns, rows).expect("a pattern")
}

/// A rig of 90 degrees across with a strong barrel, 61 mm long.
fn rig() -> StereoRig<f64> {
    let camera = |f: f64, cx: f64, lens: [f64; 5]| {
        let camera = Camera::new(f, f * 1.004, cx, 121.3).expect("a camera");
        camera.with_distortion(Distortion::from_opencv(lens)).expect("a lens")
    };
    let left = camera(165.0, 158.1, [-0.28, 0.075, 0.0006, -0.0004, -0.008]);
    let right = camera(167.5, 162.4, [-0.27, 0.070, -0.0005, 0.0007, -0.007]);
    let pose = Pose::new(turn([0.012, -0.02, 0.015]), Vector3::new(0.061, 0.0007, -0.0011)).expect("a pose");
    StereoRig::new([left, right], pose, [SIZE; 2]).expect("a rig")
}

fn markers(name: &str, share: f64) -> Markers {
    Markers { dictionary: Dictionary::named(name).expect("a dictionary"), share, begins_white: false }
}

fn turn(axis: [f64; 3]) -> nalgebra::Matrix3<f64> {
    Rotation3::new(Vector3::from(axis)).into_inner()
}

/// A board turned so, whose middle is at `x`, `y` of the plane Z = 1 and `z` squares away; the same board in
/// the right camera, where a square is `square_m` long.
fn stand(pattern: Pattern, axis: [f64; 3], [x, y, z]: [f64; 3], square_m: f64) -> [Pose<f64>; 2] {
    let r = turn(axis);
    let middle = Vector3::new(pattern.columns() as f64 - 1.0, pattern.rows() as f64 - 1.0, 0.0) / 2.0;
    let left = Pose::new(r, Vector3::new(x, y, 1.0) * z - r * middle).expect("a pose");
    let rig = rig();
    let beside = Pose::new(*rig.pose().rotation(), rig.pose().translation() / square_m).expect("a pose");
    [left, beside.inverse().then(&left)]
}

/// Ways to hold the board: tilted to all sides, at all corners of the image.
const STANDS: [([f64; 3], [f64; 3]); 10] = [
    ([0.4, 0.0, 0.1], [0.0, 0.0, 9.0]),
    ([-0.4, 0.1, -0.2], [-0.35, -0.25, 10.0]),
    ([0.0, 0.5, 0.3], [0.35, -0.25, 10.0]),
    ([0.1, -0.5, 0.0], [-0.35, 0.2, 10.0]),
    ([0.3, 0.4, 1.5], [0.4, 0.2, 11.0]),
    ([-0.3, -0.4, 3.0], [0.0, 0.2, 8.5]),
    ([0.5, -0.3, -1.2], [0.1, -0.2, 12.0]),
    ([-0.5, 0.3, 0.5], [-0.5, 0.0, 13.0]),
    ([0.2, 0.6, -0.4], [0.45, 0.0, 12.0]),
    ([0.0, 0.0, 0.0], [0.05, 0.05, 14.0]),
];

/// Ways to hold a board near the camera, so that it reaches over the borders of the image.
const CLOSE_STANDS: [([f64; 3], [f64; 3]); 6] = [
    ([0.3, 0.1, 0.1], [0.05, 0.0, 5.0]),
    ([-0.3, 0.2, 1.4], [-0.45, -0.3, 5.0]),
    ([0.1, 0.4, 0.3], [0.5, -0.3, 4.5]),
    ([0.2, -0.4, -2.6], [-0.45, 0.25, 5.0]),
    ([-0.2, -0.3, 3.0], [0.45, 0.3, 4.5]),
    ([0.0, 0.0, -0.6], [0.0, 0.1, 4.0]),
];
