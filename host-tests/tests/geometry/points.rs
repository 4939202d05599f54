//! Triangulation: the true point back, the least error, what is known of its error, what is refused.

use crate::twin;
use crate::views::{Views, noisy, seeded};
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};
use proptest::prelude::*;
use stereopsis::geometry::{
    camera::{Camera, Distortion, Pose},
    two_view::{Correspondence, Triangulated, TriangulationError, TwoViews},
};

fn views(of: &Views) -> TwoViews<f64> {
    TwoViews::new(of.camera, of.camera, of.pose).expect("a baseline")
}

fn all(
    views: &TwoViews<f64>,
    seen: &Correspondence<f64>,
) -> [Result<Triangulated<f64>, TriangulationError>; 3] {
    [views.midpoint(seen), views.linear(seen), views.optimal(seen)]
}

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn the_true_point_comes_back(seed in any::<u64>()) {
        let scene = Views::scene(seed, 10);
        for (seen, point) in scene.seen.iter().zip(&scene.points) {
            for found in all(&views(&scene), seen) {
                let found = found.expect("the sights meet in front");
                prop_assert!((found.point - point).norm() < 1e-9 * point.coords.norm(), "{found:?}, {point}");
                prop_assert!(found.residual_px < 1e-9);
                let (a, b) = (point.coords, point - Point3::from(*scene.pose.translation()));
                prop_assert!((found.angle_rad - a.angle(&b)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_optimum_is_the_least(seed in any::<u64>(), sigma in 0.1..5.0_f64) {
        let scene = Views::scene(seed, 10);
        for seen in noisy(&scene.seen, sigma, seed) {
            let [midpoint, linear, optimal] = all(&views(&scene), &seen);
            let (Ok(midpoint), Ok(linear), Ok(optimal)) = (midpoint, linear, optimal) else { continue };
            prop_assert!(optimal.residual_px <= midpoint.residual_px + 1e-9);
            prop_assert!(optimal.residual_px <= linear.residual_px + 1e-9);
            // To first order the least error is Sampson's distance.
            let sampson = scene.fundamental().sampson_px(&seen).abs();
            prop_assert!((optimal.residual_px - sampson).abs() < 1e-2 * (sampson + 0.01));
        }
    }

    #[test]
    fn the_optimum_is_the_twins(seed in any::<u64>()) {
        let scene = Views::scene(seed, 5);
        let views = views(&scene);
        for seen in noisy(&scene.seen, 1.0, seed) {
            let Ok(found) = views.optimal(&seen) else { continue };
            let twin = twin::least_error(&views, &scene.camera.matrix(), &seen, found.point);
            prop_assert!((found.point - twin).norm() < 1e-6 * twin.coords.norm(), "{} {twin}", found.point);
        }
    }

    #[test]
    fn a_larger_world_has_a_larger_point(seed in any::<u64>(), scale in 0.01..100.0_f64) {
        let scene = Views::scene(seed, 5);
        let larger = Pose::new(*scene.pose.rotation(), scene.pose.translation() * scale).expect("a pose");
        let larger = TwoViews::new(scene.camera, scene.camera, larger).expect("a baseline");
        for seen in noisy(&scene.seen, 1.0, seed) {
            for (a, b) in all(&views(&scene), &seen).into_iter().zip(all(&larger, &seen)) {
                let (Ok(a), Ok(b)) = (a, b) else { continue };
                prop_assert!((a.point * scale - b.point).norm() < 1e-8 * b.point.coords.norm());
                prop_assert!((a.residual_px - b.residual_px).abs() < 1e-8);
                prop_assert!((a.angle_rad - b.angle_rad).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn single_precision_is_near_double() {
    for seed in 0..50 {
        let scene = Views::scene(seed, 20);
        let camera = Camera::new(600.0, 600.0, 320.0, 240.0_f32).expect("a camera");
        let pose =
            Pose::new(scene.pose.rotation().map(|x| x as f32), scene.pose.translation().map(|x| x as f32));
        let single = TwoViews::new(camera, camera, pose.expect("a pose")).expect("a baseline");
        for (seen, point) in crate::views::narrow(&scene.seen).iter().zip(&scene.points) {
            // Z^2 / (f b) of a pixel.
            let per_px = point.z * point.z / (600.0 * scene.pose.translation().norm());
            for (found, share) in
                [(single.midpoint(seen), 1e-3), (single.optimal(seen), 1e-3), (single.linear(seen), 1e-2)]
            {
                let off = (found.expect("a point").point.map(f64::from) - point).norm();
                assert!(off < share * per_px, "seed {seed}: {off} of {per_px}");
            }
        }
    }
}

#[test]
fn the_covariance_is_that_of_many_tries() {
    let scene = Views::scene(7, 1);
    let (views, sigma) = (views(&scene), 0.3);
    let (seen, truth) = (vec![scene.seen[0]; 20_000], scene.points[0]);
    let mut sum = Matrix3::zeros();
    for seen in noisy(&seen, sigma, 7) {
        let off = views.optimal(&seen).expect("a point").point - truth;
        sum += off * off.transpose();
    }
    let (tries, told) = (sum / 20_000.0, views.covariance(&truth, sigma));
    // Of 20 000 tries a variance is known to 1 %.
    let off = (tries - told).amax() / told.amax();
    assert!(off < 0.04, "{tries} {told}");
    let (least, most) = (tries.symmetric_eigenvalues().min(), told.symmetric_eigenvalues().min());
    assert!((least / most - 1.0).abs() < 0.04, "{least} {most}");
}

#[test]
fn lenses_are_taken_out() {
    let lens = Distortion::from_opencv([-0.28, 0.07, 0.0002, 0.00002, 0.0]);
    let scene = Views::scene(11, 30);
    let camera = scene.camera.with_distortion(lens).expect("a lens");
    let views = TwoViews::new(camera, camera, scene.pose).expect("a baseline");
    for point in &scene.points {
        let seen = Correspondence {
            first: camera.project(point).expect("in front"),
            second: camera.project(&scene.pose.inverse_transform(point)).expect("in front"),
        };
        let found = views.optimal(&seen).expect("a point");
        assert!((found.point - point).norm() < 1e-8, "{found:?} {point}");
    }
    // x (1 - 0.3 x^2) is never more than 0.7027.
    let camera = scene.camera.with_distortion(Distortion { k1: -0.3, ..Distortion::NONE }).expect("a lens");
    let views = TwoViews::new(camera, camera, scene.pose).expect("a baseline");
    let outside = Correspondence::new(320.0 + 600.0 * 0.71, 240.0, 300.0, 240.0);
    assert_eq!(views.optimal(&outside), Err(TriangulationError::NotConverged));
}

#[test]
fn what_has_no_point_is_refused() {
    let scene = Views::scene(2, 1);
    let pose = Pose::new(*Rotation3::new(Vector3::new(0.0, 0.01, 0.0)).matrix(), Vector3::new(0.5, 0.0, 0.1));
    let views = TwoViews::new(scene.camera, scene.camera, pose.expect("a pose")).expect("a baseline");
    let seen = |point: &Point3<f64>| {
        let pixel = |p: Point3<f64>| Point3::from(scene.camera.matrix() * p.coords);
        let (p, q) = (pixel(*point), pixel(views.pose().inverse_transform(point)));
        Correspondence::new(p.x / p.z, p.y / p.z, q.x / q.z, q.y / q.z)
    };
    let refused = |seen: Correspondence<f64>| all(&views, &seen).map(Result::err);
    assert_eq!(refused(seen(&Point3::new(0.5, 0.3, 5.0))), [None; 3]);
    assert_eq!(refused(seen(&Point3::new(0.5, 0.3, -5.0))), [Some(TriangulationError::Behind); 3]);
    assert_eq!(refused(seen(&Point3::new(50.0, 30.0, 5000.0))), [Some(TriangulationError::SmallAngle); 3]);
    assert_eq!(
        refused(Correspondence::new(0.0, f64::NAN, 0.0, 0.0)),
        [Some(TriangulationError::NotFinite); 3]
    );
    let wider = views.with_min_angle(0.2);
    assert_eq!(wider.optimal(&seen(&Point3::new(0.5, 0.3, 5.0))).err(), Some(TriangulationError::SmallAngle));
    assert!(TwoViews::new(scene.camera, scene.camera, Pose::identity()).is_err(), "no baseline");
}
