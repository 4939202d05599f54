//! The lecture's equations, each by a number that is worked by hand.
//!
//! Two cameras of 500 px, principal point (320, 240), the second 0.1 m to the right of the first. The point
//! (0.2, -0.1, 2) is seen by the first at u = 500 * 0.2 / 2 + 320 = 370, v = 500 * -0.1 / 2 + 240 = 215, by
//! the second, where it is (0.1, -0.1, 2), at (345, 215).

use nalgebra::{Matrix3, Matrix3x4, Point2, Point3, Vector3};
use stereopsis::geometry::{
    absolute::Projection,
    camera::{Camera, Pose, RectifiedRig},
    known_shape::Sighting,
    two_view::{Correspondence, Essential, Fundamental, TwoViews, eight_point},
};

fn camera() -> Camera<f64> {
    Camera::new(500.0, 500.0, 320.0, 240.0).expect("a camera")
}

fn pose() -> Pose<f64> {
    Pose::new(Matrix3::identity(), Vector3::new(0.1, 0.0, 0.0)).expect("a pose")
}

const SEEN: Correspondence<f64> = Correspondence::new(370.0, 215.0, 345.0, 215.0);

fn near(a: &Matrix3<f64>, b: &Matrix3<f64>) -> bool {
    // Of any scale, the sign too.
    let (a, b) = (a / a.norm(), b / b.norm());
    (a - b).amax() < 1e-12 || (a + b).amax() < 1e-12
}

#[test]
fn projection_matrices() {
    let first = Projection::new(&camera(), &Pose::identity());
    let second = Projection::new(&camera(), &pose());
    assert_eq!(first.project(&Point3::new(0.2, -0.1, 2.0)), Some(SEEN.first));
    assert_eq!(second.project(&Point3::new(0.2, -0.1, 2.0)), Some(SEEN.second));
    // -K t = (-50, 0, 0).
    let expected = Matrix3x4::new(500.0, 0.0, 320.0, -50.0, 0.0, 500.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0);
    assert!((second.matrix() - expected).amax() < 1e-12);
}

#[test]
fn an_object_of_known_size() {
    // 500 * 0.4 / 20 = 10 m.
    let ends = [Point2::new(320.0, 230.0), Point2::new(320.0, 250.0)];
    let seen = Sighting::of_length(&camera(), &ends, 0.4, 0.5).expect("a distance");
    assert!((seen.distance_m - 10.0).abs() < 1e-12);
}

#[test]
fn depth_of_a_disparity() {
    // 0.1 * 500 / (370 - 345) = 2 m.
    let rig = RectifiedRig::new(500.0, 0.1, 320.0, 240.0).expect("a rig");
    assert!((rig.depth_m(25.0).expect("in front") - 2.0).abs() < 1e-6);
    // Q: (370 - 320, 215 - 240, 500) / (25 / 0.1) = (0.2, -0.1, 2).
    let point = rig.reproject(370.0, 215.0, 25.0).expect("in front");
    assert!((point - Point3::new(0.2, -0.1, 2.0)).norm() < 1e-6);
}

#[test]
fn least_reprojection_error() {
    let views = TwoViews::new(camera(), camera(), pose()).expect("a baseline");
    // The second is 2 px lower: both rows meet in the middle, one px off each.
    let seen = Correspondence::new(370.0, 214.0, 345.0, 216.0);
    let best = views.optimal(&seen).expect("a point");
    assert!((best.point - Point3::new(0.2, -0.1, 2.0)).norm() < 1e-9);
    // Root of the sum of the squares 1 + 1.
    assert!((best.residual_px - 2.0_f64.sqrt()).abs() < 1e-9, "{}", best.residual_px);
}

#[test]
fn the_epipolar_plane() {
    // t x p' = (0.1, 0, 0) x (0.05, -0.05, 1) = (0, -0.1, -0.005); times p = (0.1, -0.05, 1): 0.005 - 0.005 =
    // 0.
    let (p, q) = (Vector3::new(0.1, -0.05, 1.0), Vector3::new(0.05, -0.05, 1.0));
    let essential = Essential::from_pose(&pose()).expect("a baseline");
    assert!(essential.residual(&p, &q).abs() < 1e-15);
    // A row lower, 0.002 of Z = 1: t x (0.05, -0.048, 1) = (0, -0.1, -0.0048), times p: 0.0002, over |t|
    // 0.002.
    assert!((essential.residual(&p, &Vector3::new(0.05, -0.048, 1.0)).abs() - 0.002).abs() < 1e-12);
}

#[test]
fn the_essential_matrix() {
    let essential = Essential::from_pose(&pose()).expect("a baseline");
    let expected = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    assert!(near(essential.matrix(), &expected));
    // Singular values 3, 1, 1 to 2, 2, 0.
    let nearest = Essential::nearest(&Matrix3::from_diagonal(&Vector3::new(3.0, 1.0, 0.5))).expect("rank 2");
    assert!(near(nearest.matrix(), &Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0))));
}

#[test]
fn the_fundamental_matrix() {
    let essential = Essential::from_pose(&pose()).expect("a baseline");
    let fundamental = Fundamental::from_essential(&essential, &camera(), &camera());
    // Rows of a rectified pair: v = v'.
    let expected = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    assert!(near(fundamental.matrix(), &expected), "{}", fundamental.matrix());
    assert!(fundamental.residual(&SEEN).abs() < 1e-12);
    // F (345, 215, 1) = (0, -1, 215): v = 215.
    let line = fundamental.line_in_first(&SEEN.second).expect("a line");
    assert!((line.distance_px(&Point2::new(0.0, 218.0)).abs() - 3.0).abs() < 1e-9);
    let line = fundamental.line_in_second(&SEEN.first).expect("a line");
    assert!((line.distance_px(&Point2::new(639.0, 211.0)).abs() - 4.0).abs() < 1e-9);
    // Both epipoles are at infinity, along u.
    for epipole in [fundamental.epipole_in_first(), fundamental.epipole_in_second()] {
        assert_eq!(epipole.pixel(), None);
        assert!((epipole.homogeneous().x.abs() - 1.0).abs() < 1e-12);
    }
    let again = Essential::from_fundamental(&fundamental, &camera(), &camera()).expect("rank 2");
    assert!(near(again.matrix(), essential.matrix()));
    // One of its four poses is the pose.
    let right = again.poses().into_iter().filter(|found| {
        (found.rotation() - pose().rotation()).amax() < 1e-9 && (found.direction().x - 1.0).abs() < 1e-9
    });
    assert_eq!(right.count(), 1);
}

#[test]
fn a_camera_that_goes_forward() {
    // t = (0, 0, 1): both epipoles are the principal point, and all lines go through it.
    let pose = Pose::new(Matrix3::identity(), Vector3::z()).expect("a pose");
    let fundamental = Fundamental::from_cameras(&pose, &camera(), &camera()).expect("a baseline");
    for epipole in [fundamental.epipole_in_first(), fundamental.epipole_in_second()] {
        assert!((epipole.pixel().expect("finite") - Point2::new(320.0, 240.0)).norm() < 1e-9);
    }
    // Of (320 + 30, 240 + 40): the line through (320, 240) with the normal (4, -3) / 5.
    let line = fundamental.line_in_first(&Point2::new(350.0, 280.0)).expect("a line");
    assert!((line.distance_px(&Point2::new(325.0, 240.0)).abs() - 4.0).abs() < 1e-9);
}

#[test]
fn eight_points() {
    // Corners of a box of 2 m at 4 and 5 m, but for one that is nearer, by the cameras above: F is theirs.
    let corner = |k: usize| {
        let side = |bit: usize| -> f64 { if k >> bit & 1 == 1 { 1.0 } else { -1.0 } };
        Point3::new(side(0), side(1), if k == 7 { 3.0 } else { 4.5 + 0.5 * side(2) } + 0.1 * k as f64)
    };
    let seen: [_; 8] = core::array::from_fn(|k| Correspondence {
        first: camera().project(&corner(k)).expect("in front"),
        second: camera().project(&pose().inverse_transform(&corner(k))).expect("in front"),
    });
    let found = eight_point(&seen).expect("eight are enough");
    let expected = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    let (a, b) = (found.matrix() / found.matrix().m32, expected);
    assert!((a - b).amax() < 1e-6, "{a}");
}

#[test]
fn the_nearest_matrix_of_rank_two() {
    // 1 to 9 has rank 2: (1, -2, 1) is orthogonal to its rows.
    let singular = Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0);
    let of = |matrix: &Matrix3<f64>| *Fundamental::from_matrix(matrix).expect("rank 2").matrix();
    assert!(near(&of(&singular), &singular));
    // What is added to it is not farther from the nearest one than from that one.
    let added = singular + Matrix3::identity() * 1e-3;
    let nearest = of(&added) * added.norm();
    assert!(nearest.determinant().abs() < 1e-12);
    assert!((nearest - added).norm() <= 1e-3 * 3.0_f64.sqrt(), "{:e}", (nearest - added).norm());
}
