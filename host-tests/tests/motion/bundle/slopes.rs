//! Derivatives against central differences.

use super::scene::{calibrated, placed, radial, rig};
use nalgebra::{Point3, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::geometry::camera::{Camera, Pose};
use stereopsis::motion::bundle::{RectifiedView, View};

/// Central differences err by the square of the step, and by roundings over it: of pixels in thousands, a
/// millionth or so.
const STEP: f64 = 1e-5;

fn holds<V: View<f64, N>, const N: usize>(view: &V, eye: u16, point: &Point3<f64>, sizes: [f64; N]) {
    let jacobian = view.jacobian(eye, point).expect("seen");
    let seen = view.project(eye, point).expect("seen");
    assert!((jacobian.pixel - seen).amax() <= 1e-9 * (1.0 + seen.coords.amax()), "{} {seen}", jacobian.pixel);
    let by = |k: usize, h: f64| {
        let mut step = [0.0; N];
        step[k] = h * sizes[k];
        view.moved(&step).project(eye, point).expect("seen")
    };
    for (k, size) in sizes.iter().enumerate() {
        let off = (by(k, STEP) - by(k, -STEP)) / (2.0 * STEP * size);
        near(
            &[jacobian.by_view[0][k], jacobian.by_view[1][k]],
            &[off.x, off.y],
            &format!("view's number {k}"),
        );
    }
    for k in 0..3 {
        let mut shift = Vector3::zeros();
        shift[k] = STEP * 0.1;
        let at = |shift| view.project(eye, &(point + shift)).expect("seen");
        let off = (at(shift) - at(-shift)) / (2.0 * shift[k]);
        near(
            &[jacobian.by_point[0][k], jacobian.by_point[1][k]],
            &[off.x, off.y],
            &format!("point's number {k}"),
        );
    }
}

fn near(found: &[f64; 2], differences: &[f64; 2], what: &str) {
    for (a, b) in found.iter().zip(differences) {
        assert!((a - b).abs() <= 1e-4 * (1.0 + b.abs()), "{what}: {a} {b}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn of_a_camera((pose, point) in placed()) {
        holds(&calibrated::<f64>(0).with_pose(pose), 0, &point, [1.0; 6]);
    }

    #[test]
    fn of_a_rig((pose, point) in placed()) {
        let view = rig::<f64>(0).with_pose(pose);
        holds(&view, 0, &point, [1.0; 6]);
        holds(&view, 1, &point, [1.0; 6]);
    }

    #[test]
    fn of_a_rectified_pair((pose, point) in placed()) {
        let view = aligned(pose);
        holds(&view, 0, &point, [1.0; 6]);
        holds(&view, 1, &point, [1.0; 6]);
    }

    #[test]
    fn of_a_camera_with_its_lens((pose, point) in placed()) {
        let view = radial::<f64>(1).with_pose(pose);
        holds(&view, 0, &point, [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 100.0, 1.0, 1.0]);
        // Through the centre, behind the camera.
        let behind = pose.transform(&(-pose.inverse_transform(&point)));
        holds(&view, 0, &behind, [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 100.0, 1.0, 1.0]);
    }
}

fn aligned(pose: Pose<f64>) -> RectifiedView<f64> {
    RectifiedView { camera: Camera::new(500.0, 500.0, 320.0, 240.0).expect("a camera"), baseline: 0.12, pose }
}

#[test]
fn a_disparity_by_its_definition() {
    let view = aligned(Pose::identity());
    let point = Point3::new(0.3, -0.2, 4.0);
    // f b / Z = 500 x 0.12 / 4, whatever the column.
    let disparity = view.project(1, &point).expect("seen");
    assert!((disparity.x - 15.0).abs() < 1e-12 && disparity.y == 0.0, "{disparity}");
    assert!(view.project(1, &Point3::new(0.0, 0.0, -1.0)).is_err());
}

#[test]
fn what_is_behind_is_not_seen() {
    use stereopsis::geometry::camera::ProjectionError::Behind;
    let point = Point3::new(0.0, 0.0, -1.0);
    assert_eq!(calibrated::<f64>(0).jacobian(0, &point).err(), Some(Behind));
    assert_eq!(rig::<f64>(0).jacobian(1, &point).err(), Some(Behind));
    assert_eq!(rig::<f64>(0).project(1, &point), Err(Behind));
    let centre = Point3::from(*radial::<f64>(1).pose.translation());
    assert_eq!(radial::<f64>(1).jacobian(0, &centre).err(), Some(Behind));
}
