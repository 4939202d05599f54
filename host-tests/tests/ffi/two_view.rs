//! Two views from C are those of Rust to the bit, and bad input has a status.

use super::stereopsis_c::{
    stereopsis_eight_point, stereopsis_fundamental, stereopsis_pose_of, stereopsis_triangulate,
};
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::ptr::{null, null_mut};
use stereopsis::ffi::{CAgreement, CMatch, CPinhole, CPoint, CPose, Status};
use stereopsis::geometry::camera::{Camera, Pose};
use stereopsis::geometry::robust::{RobustConfig, robust_fundamental};
use stereopsis::geometry::two_view::{Correspondence, Essential, TwoViews, eight_point};

static FIRST: CPinhole = CPinhole { fx: 400.0, fy: 410.0, cx: 160.0, cy: 120.0 };
static SECOND: CPinhole = CPinhole { fx: 390.0, fy: 395.0, cx: 150.0, cy: 118.0 };
const MATCHES: usize = 60;
const NONE: CMatch = CMatch { u: 0.0, v: 0.0, u2: 0.0, v2: 0.0 };
const NO_POSE: CPose = CPose { rotation: [0.0; 9], translation: [0.0; 3] };
const UNWRITTEN: CAgreement = CAgreement { inliers: 77, rms_px: 0.0, miss_probability: 0.0 };

fn camera(c: &CPinhole) -> Camera<f32> {
    Camera::new(c.fx, c.fy, c.cx, c.cy).expect("a camera")
}

/// The second camera beside the first.
fn pose() -> Pose<f32> {
    let rotation = Rotation3::from_euler_angles(0.02, -0.1, 0.03);
    Pose::new(*rotation.matrix(), Vector3::new(0.3, 0.02, 0.05)).expect("a pose")
}

/// Matches of points in a box before both cameras, every fifth one wrong, and which of them are right.
fn matches() -> ([CMatch; MATCHES], Vec<bool>) {
    let (first, second, pose) = (camera(&FIRST), camera(&SECOND), pose());
    let mut seen = [NONE; MATCHES];
    let mut right = Vec::new();
    for (i, seen) in seen.iter_mut().enumerate() {
        let step = |prime: usize| (i * prime % 61) as f32 / 61.0 - 0.5;
        let point = Vector3::new(2.0 * step(17), 1.5 * step(23), 3.0 + 2.0 * step(29));
        let beyond = pose.rotation().transpose() * (point - pose.translation());
        let pixel = |c: &Camera<f32>, p: Vector3<f32>| c.project(&p.into()).expect("in front");
        let (p, q) = (pixel(&first, point), pixel(&second, beyond));
        let wrong = if i % 5 == 4 { 40.0 + i as f32 } else { 0.0 };
        right.push(i % 5 != 4);
        *seen = CMatch { u: p.x, v: p.y, u2: q.x, v2: q.y + wrong };
    }
    (seen, right)
}

fn in_rust(seen: &[CMatch]) -> Vec<Correspondence<f32>> {
    seen.iter().map(|m| Correspondence::new(m.u, m.v, m.u2, m.v2)).collect()
}

fn rows(matrix: &Matrix3<f32>) -> [f32; 9] {
    matrix.transpose().as_slice().try_into().expect("nine")
}

#[test]
fn the_results_are_those_of_rust() {
    let (seen, right) = matches();
    let rust = in_rust(&seen);
    let (mut f, mut inliers, mut agreement) = ([0.0; 9], [7_u8; MATCHES], UNWRITTEN);
    // SAFETY: all arrays have the lengths that are said.
    let status = unsafe {
        stereopsis_fundamental(
            seen.as_ptr(),
            MATCHES,
            1.0,
            9,
            f.as_mut_ptr(),
            inliers.as_mut_ptr(),
            &raw mut agreement,
        )
    };
    assert_eq!(status, Status::Ok);
    let mut expected = [false; MATCHES];
    let config = RobustConfig { seed: 9, ..RobustConfig::new(1.0) };
    let found = robust_fundamental(&rust, &config, &mut expected).expect("an estimate");
    assert_eq!(expected.as_slice(), right, "the estimate is right");
    assert_eq!(inliers, expected.map(u8::from));
    assert_eq!(f, rows(found.fundamental.matrix()));
    assert_eq!((agreement.inliers as usize, agreement.rms_px), (found.inliers, found.rms_px));
    assert_eq!(agreement.miss_probability, found.miss_probability);

    let mut found_pose = NO_POSE;
    let (first, second) = (&raw const FIRST, &raw const SECOND);
    // SAFETY: as above.
    let status = unsafe {
        stereopsis_pose_of(
            seen.as_ptr(),
            inliers.as_ptr(),
            MATCHES,
            f.as_ptr(),
            first,
            second,
            &raw mut found_pose,
        )
    };
    assert_eq!(status, Status::Ok);
    let cameras = (camera(&FIRST), camera(&SECOND));
    let essential =
        Essential::from_fundamental(&found.fundamental, &cameras.0, &cameras.1).expect("of rank two");
    let agreeing = rust.iter().zip(&right).filter(|(_, right)| **right).map(|(seen, _)| *seen);
    let expected = essential.recover_pose(agreeing, &cameras.0, &cameras.1).expect("a pose").pose;
    let turn = (expected.rotation().transpose() * pose().rotation() - Matrix3::identity()).amax();
    assert!(turn < 0.01, "the pose is right: {turn}");
    // F went through nine numbers, and is made singular again.
    let close = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
    assert!(close(&found_pose.rotation, &rows(expected.rotation())), "{found_pose:?}");
    assert!(close(&found_pose.translation, expected.direction().as_slice()), "{found_pose:?}");

    let mut points = [CPoint { x_m: 7.0, y_m: 7.0, z_m: 7.0 }; MATCHES];
    // SAFETY: as above.
    let status = unsafe {
        stereopsis_triangulate(
            seen.as_ptr(),
            MATCHES,
            first,
            second,
            &raw const found_pose,
            points.as_mut_ptr(),
        )
    };
    assert_eq!(status, Status::Ok);
    let rotation = Matrix3::from_row_slice(&found_pose.rotation);
    let rust_pose = Pose::new(rotation, Vector3::from(found_pose.translation)).expect("a pose");
    let views = TwoViews::new(cameras.0, cameras.1, rust_pose).expect("two views");
    let mut there = 0;
    for (point, seen) in points.iter().zip(&rust) {
        let expected = views.optimal(seen).map_or([0.0; 3], |found| found.point.coords.into());
        assert_eq!([point.x_m, point.y_m, point.z_m], expected);
        there += usize::from(point.z_m > 0.0);
    }
    assert!(there >= 48, "{there} points");
}

#[test]
fn eight_points_are_those_of_rust() {
    let (seen, right) = matches();
    let right: Vec<CMatch> = seen.iter().zip(right).filter(|(_, right)| *right).map(|(m, _)| *m).collect();
    for count in [8, right.len()] {
        let mut f = [0.0; 9];
        // SAFETY: as many matches are there, and nine numbers.
        let status = unsafe { stereopsis_eight_point(right.as_ptr(), count, f.as_mut_ptr()) };
        assert_eq!(status, Status::Ok);
        assert_eq!(f, rows(eight_point(&in_rust(&right[..count])).expect("determined").matrix()));
    }
}

#[test]
fn what_is_wrong_has_a_status_and_changes_nothing() {
    let (seen, _) = matches();
    let good = {
        let mut f = [0.0; 9];
        // SAFETY: the first eight, of which one is wrong, have a matrix all the same.
        assert_eq!(unsafe { stereopsis_eight_point(seen.as_ptr(), 8, f.as_mut_ptr()) }, Status::Ok);
        f
    };
    let eight = |seen: *const CMatch, count: usize| {
        let mut f = [7.0; 9];
        // SAFETY: as many matches are there, or the pointer is not followed.
        let status = unsafe { stereopsis_eight_point(seen, count, f.as_mut_ptr()) };
        assert_eq!(f, [7.0; 9]);
        status
    };
    assert_eq!(eight(null(), 8), Status::Null);
    assert_eq!(eight(seen.as_ptr().cast::<u8>().wrapping_add(2).cast(), 8), Status::Misaligned);
    assert_eq!(eight(seen.as_ptr(), usize::MAX), Status::TooMany);
    assert_eq!(eight(seen.as_ptr(), 7), Status::TooFewMatches);
    let with = |change: fn(&mut CMatch, usize)| {
        let mut seen = seen;
        seen.iter_mut().enumerate().for_each(|(i, m)| change(m, i));
        seen
    };
    let nan = with(|m, i| {
        if i == 3 {
            m.v = f32::NAN
        }
    });
    assert_eq!(eight(nan.as_ptr(), MATCHES), Status::MatchNotFinite);
    let plane = with(|m, _| (m.u2, m.v2) = (m.u + 9.0, m.v));
    assert_eq!(eight(plane.as_ptr(), MATCHES), Status::MatchesOnPlane);
    let one = with(|m, _| *m = CMatch { u: 1.0, v: 2.0, u2: 3.0, v2: 4.0 });
    assert_eq!(eight(one.as_ptr(), MATCHES), Status::MatchesDegenerate);

    let robust = |seen: &[CMatch; MATCHES], threshold_px: f32| {
        let (mut f, mut inliers, mut agreement) = ([7.0; 9], [7_u8; MATCHES], UNWRITTEN);
        let inliers = inliers.as_mut_ptr();
        // SAFETY: all arrays have the lengths that are said.
        let status = unsafe {
            stereopsis_fundamental(
                seen.as_ptr(),
                MATCHES,
                threshold_px,
                0,
                f.as_mut_ptr(),
                inliers,
                &raw mut agreement,
            )
        };
        assert!(f == [7.0; 9] && agreement == UNWRITTEN);
        status
    };
    assert_eq!(robust(&seen, 0.0), Status::MatchThreshold);
    assert_eq!(robust(&seen, f32::NAN), Status::MatchThreshold);
    assert_eq!(robust(&nan, 1.0), Status::MatchNotFinite);
    assert_eq!(robust(&one, 1.0), Status::MatchesDisagree);

    let recovered = |f: [f32; 9], first: CPinhole, pose: *mut CPose| {
        let (first, second) = (&raw const first, &raw const SECOND);
        // SAFETY: all is there, or null.
        unsafe { stereopsis_pose_of(seen.as_ptr(), null(), MATCHES, f.as_ptr(), first, second, pose) }
    };
    let mut pose = NO_POSE;
    assert_eq!(recovered(good, FIRST, null_mut()), Status::Null);
    assert_eq!(recovered([0.0; 9], FIRST, &raw mut pose), Status::FundamentalRank);
    assert_eq!(recovered(good, CPinhole { fx: -1.0, ..FIRST }, &raw mut pose), Status::PinholeNumbers);
    assert_eq!(pose, NO_POSE);

    let triangulated = |pose: CPose, points: *mut CPoint| {
        let (first, second) = (&raw const FIRST, &raw const SECOND);
        // SAFETY: as many points are there, or the pointer is not followed.
        unsafe { stereopsis_triangulate(seen.as_ptr(), MATCHES, first, second, &raw const pose, points) }
    };
    let mut points = [CPoint { x_m: 7.0, y_m: 7.0, z_m: 7.0 }; MATCHES];
    assert_eq!(triangulated(NO_POSE, points.as_mut_ptr()), Status::PoseNumbers);
    let still = CPose { rotation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], translation: [0.0; 3] };
    assert_eq!(triangulated(still, points.as_mut_ptr()), Status::PoseNumbers);
    let apart = CPose { translation: [0.1, 0.0, 0.0], ..still };
    assert_eq!(triangulated(apart, seen.as_ptr().cast_mut().cast()), Status::Overlap);
    assert!(points.iter().all(|p| p.x_m == 7.0));
}
