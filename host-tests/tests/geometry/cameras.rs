//! Lenses there and back, and projection matrices.

use crate::views::{any_pose, seeded};
use nalgebra::{Matrix3x4, Point2, Point3, Rotation3, Vector3};
use proptest::prelude::*;
use stereopsis::geometry::{
    absolute::{Landmark, Projection, ResectionError},
    camera::{Camera, Distortion, Fisheye, Lens, Pose, ProjectionError, RectifiedRig},
};
use stereopsis_host::scene::Random;

/// Coefficients of lenses from a little to a lot of distortion, that turn nothing over in the image.
fn lenses() -> impl Strategy<Value = Distortion<f64>> {
    (-0.3..0.3, -0.05..0.1, -0.002..0.002, -0.002..0.002, 0.0..0.02, -0.05..0.3, 0.0..0.1, 0.0..0.01)
        .prop_map(|(k1, k2, p1, p2, k3, k4, k5, k6)| {
            Distortion::from_opencv_rational([k1, k2, p1, p2, k3, k4, k5, k6])
        })
}

/// Coefficients of wide lenses.
fn fisheyes() -> impl Strategy<Value = Fisheye<f64>> {
    (-0.1..0.1, -0.02..0.02, -0.005..0.005, 0.0..0.001)
        .prop_map(|(k1, k2, k3, k4)| Fisheye::from_opencv([k1, k2, k3, k4]))
}

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn a_pixel_there_and_back(lens in lenses(), x in -0.55..0.55_f64, y in -0.4..0.4_f64) {
        let camera = Camera::new(600.0, 580.0, 321.0, 243.0).and_then(|c| c.with_skew(1.5))
            .expect("a camera");
        let camera = camera.with_distortion(lens).expect("a lens");
        let pixel = camera.project(&Point3::new(2.0 * x, 2.0 * y, 2.0)).expect("in front");
        let sight = camera.unproject(&pixel).expect("it converges");
        prop_assert!((sight - Vector3::new(x, y, 1.0)).amax() < 1e-9, "{sight}");
        let straight = Camera::from_matrix(&camera.matrix()).expect("a camera");
        let undistorted = camera.undistort(&pixel).expect("it converges");
        prop_assert!((undistorted - straight.project(&Point3::new(x, y, 1.0)).expect("in front"))
            .norm() < 1e-6);
        // In f32 to two thousandths of a pixel.
        let narrow = Distortion::from_opencv_rational(lens.to_opencv().map(|k| k as f32));
        let narrow = Camera::new(600.0, 580.0, 321.0, 243.0_f32)
            .and_then(|c| c.with_skew(1.5)?.with_distortion(narrow));
        let again = narrow.expect("a camera").undistort(&pixel.map(|x| x as f32)).expect("it converges");
        prop_assert!((again.map(f64::from) - undistorted).norm() < 2e-3);
    }

    /// Up to 80 degrees from the axis.
    #[test]
    fn a_wide_pixel_there_and_back(lens in fisheyes(), angle in 0.0..1.4_f64, around in 0.0..6.3_f64) {
        let camera = Camera::new(300.0, 290.0, 321.0, 243.0).and_then(|c| c.with_distortion(lens))
            .expect("a camera");
        let point = Point3::new(angle.sin() * around.cos(), angle.sin() * around.sin(), angle.cos());
        let pixel = camera.project(&point).expect("in front");
        let sight = camera.unproject(&pixel).expect("it converges").normalize();
        prop_assert!((sight - point.coords).amax() < 1e-8, "{sight}");
        let narrow = Fisheye::from_opencv(lens.to_opencv().map(|k| k as f32));
        let narrow = Camera::new(300.0, 290.0, 321.0, 243.0_f32).and_then(|c| c.with_distortion(narrow))
            .expect("a camera");
        let sight = narrow.unproject(&pixel.map(|x| x as f32)).expect("it converges").normalize();
        prop_assert!((sight.map(f64::from) - point.coords).amax() < 2e-5, "{sight}");
    }

    #[test]
    fn composed_and_taken_apart(pose in any_pose(), fx in 100.0..2000.0_f64, fy in 100.0..2000.0_f64,
        skew in -5.0..5.0_f64) {
        let camera = Camera::new(fx, fy, 320.0, 240.0).and_then(|c| c.with_skew(skew)).expect("a camera");
        let (inner, place) = Projection::new(&camera, &pose).decompose().expect("a camera");
        prop_assert!((inner.matrix() - camera.matrix()).amax() < 1e-8);
        prop_assert!((place.rotation() - pose.rotation()).amax() < 1e-10);
        prop_assert!((place.translation() - pose.translation()).amax() < 1e-10);
    }

    #[test]
    fn landmarks_give_the_camera(pose in any_pose(), seed in any::<u64>(), count in 6..40_usize) {
        let camera = Camera::new(600.0, 580.0, 321.0, 243.0).expect("a camera");
        let landmarks = landmarks(&camera, &pose, seed, count, |p| p);
        let found = Projection::from_landmarks(&landmarks).expect("they are anywhere");
        for landmark in &landmarks {
            let off = found.project(&landmark.world).expect("in front") - landmark.pixel;
            prop_assert!(off.norm() < 1e-9, "{:e}", off.norm());
        }
        if count >= 12 {
            let (inner, place) = found.decompose().expect("a camera");
            prop_assert!((inner.matrix() - camera.matrix()).amax() < 1e-5);
            prop_assert!((place.translation() - pose.translation()).amax() < 1e-6);
        }
    }

    #[test]
    fn landmarks_on_a_plane_are_refused(pose in any_pose(), seed in any::<u64>(), count in 6..40_usize) {
        let camera = Camera::new(600.0, 580.0, 321.0, 243.0).expect("a camera");
        let flat = landmarks(&camera, &pose, seed, count, |p| Point3::new(p.x, p.y, 5.0 + 0.3 * p.x));
        prop_assert_eq!(Projection::from_landmarks(&flat), Err(ResectionError::Plane));
    }
}

/// `count` points before a camera, in the world, where `shape` moves them to in the camera.
fn landmarks(
    camera: &Camera<f64>,
    pose: &Pose<f64>,
    seed: u64,
    count: usize,
    shape: impl Fn(Point3<f64>) -> Point3<f64>,
) -> Vec<Landmark<f64>> {
    let mut random = Random::new(seed);
    let mut number = |size: f64| size * (2.0 * random.unit() - 1.0);
    let points = (0..count).map(|_| shape(Point3::new(number(2.0), number(1.5), 5.0 + number(2.0))));
    points
        .map(|p| Landmark { world: pose.transform(&p), pixel: camera.project(&p).expect("in front") })
        .collect()
}

#[test]
fn what_is_no_camera_is_refused() {
    let camera = Camera::new(600.0, 580.0, 321.0, 243.0).expect("a camera");
    let pose = Pose::new(*Rotation3::new(Vector3::new(0.1, 0.2, 0.3)).matrix(), Vector3::new(1.0, 2.0, 3.0));
    let good = landmarks(&camera, &pose.expect("a pose"), 1, 20, |p| p);
    let refused = |landmarks: &[Landmark<f64>]| Projection::from_landmarks(landmarks).err();
    assert_eq!(refused(&good), None);
    assert_eq!(refused(&good[..5]), Some(ResectionError::TooFew));
    let repeated: Vec<_> = good[..5].iter().cycle().take(20).copied().collect();
    assert_eq!(refused(&repeated), Some(ResectionError::TooFew));
    let mut wrong = good.clone();
    wrong[3].world.y = f64::NAN;
    assert_eq!(refused(&wrong), Some(ResectionError::NotFinite));
    let one: Vec<_> = good.iter().map(|l| Landmark { pixel: good[0].pixel, ..*l }).collect();
    assert_eq!(refused(&one), Some(ResectionError::Undetermined));
    // All but one on a plane.
    let mut flat = landmarks(&camera, &Pose::identity(), 2, 20, |p| Point3::new(p.x, p.y, 5.0));
    flat[0].world = Point3::new(0.0, 0.0, 8.0);
    flat[0].pixel = Point2::new(321.0, 243.0);
    assert_eq!(refused(&flat), Some(ResectionError::Undetermined));
    assert_eq!(Projection::from_matrix(&Matrix3x4::from_element(f64::NAN)), Err(ResectionError::NotFinite));
}

#[test]
fn outside_of_the_lens_model_is_refused() {
    let lens = Distortion { k1: -0.3, ..Distortion::NONE };
    let camera =
        Camera::new(500.0, 500.0, 320.0, 240.0_f64).and_then(|c| c.with_distortion(lens)).expect("a camera");
    // x (1 - 0.3 x^2) is at most 0.7027, at x = 1.054.
    assert!(camera.unproject(&Point2::new(320.0 + 350.0, 240.0)).is_ok());
    assert_eq!(camera.unproject(&Point2::new(320.0 + 352.0, 240.0)), Err(ProjectionError::NotConverged));
    assert_eq!(camera.unproject(&Point2::new(f64::NAN, 240.0)), Err(ProjectionError::NotFinite));
}

/// Where `cv2.projectPoints` and `cv2.fisheye.projectPoints` (OpenCV 5.0.0) see three points.
#[test]
fn lenses_are_those_of_opencv() {
    let rational = Distortion::from_opencv_rational([0.9, 0.3, 0.001, -0.002, 0.05, 1.2, 0.6, 0.1]);
    let fisheye = Fisheye::from_opencv([-0.02, 0.01, -0.004, 0.0006]);
    let points = [Point3::new(0.5, 0.3, 1.0), Point3::new(-0.9, 0.4, 1.0), Point3::new(1.5, -1.2, 1.0)];
    let seen: [(Lens<f64>, [Point2<f64>; 3]); 2] = [
        (
            rational.into(),
            [
                Point2::new(500.72848355676916, 351.45469738741303),
                Point2::new(36.65437591143194, 369.1238620847921),
                Point2::new(663.7854650091441, -42.81182130749818),
            ],
        ),
        (
            fisheye.into(),
            [
                Point2::new(500.18351022906165, 350.8128587908729),
                Point2::new(38.32913578069605, 368.31672703323846),
                Point2::new(655.5448036427063, -35.14673898701909),
            ],
        ),
    ];
    for (lens, pixels) in seen {
        let camera =
            Camera::new(400.0, 410.0, 320.0, 240.0).and_then(|c| c.with_distortion(lens)).expect("a camera");
        for (point, pixel) in points.iter().zip(pixels) {
            let found = camera.project(point).expect("in front");
            assert!((found - pixel).norm() < 1e-9, "{lens:?}: {found} {pixel}");
        }
    }
}

#[test]
fn a_rectified_rig_sees_the_same() {
    let rig = RectifiedRig::new(500.0, 0.1, 320.0, 240.0).expect("a rig");
    let camera = Camera::new(500.0, 500.0, 320.0, 240.0_f32).expect("a camera");
    let point = rig.reproject(400.0, 200.0, 25.0).expect("in front");
    let pixel = camera.project(&point).expect("in front");
    assert!((pixel - Point2::new(400.0, 200.0)).norm() < 1e-3, "{pixel}");
}
