//! The pose out of an essential matrix, and its scale.

use crate::views::{Views, any_pose, noisy, seeded};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use stereopsis::geometry::{
    camera::Camera,
    two_view::{Correspondence, Essential, RecoverError, TwoViews, eight_point},
};

/// The angle between two rotations, radians.
fn between(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    let cosine = ((a.transpose() * b).trace() - 1.0) / 2.0;
    cosine.clamp(-1.0, 1.0).acos()
}

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn one_of_the_four_is_the_pose(pose in any_pose()) {
        let e = Essential::from_pose(&pose).expect("a baseline");
        let poses = e.poses();
        let right = |p: &&stereopsis::geometry::two_view::RelativePose<f64>| {
            (p.rotation() - pose.rotation()).amax() < 1e-9
                && (p.direction().into_inner() - pose.translation().normalize()).amax() < 1e-9
        };
        prop_assert_eq!(poses.iter().filter(right).count(), 1);
        for found in poses {
            prop_assert!((found.rotation().determinant() - 1.0).abs() < 1e-12);
            prop_assert!((found.rotation().transpose() * found.rotation() - Matrix3::identity())
                .amax() < 1e-12);
            let again = Essential::from_pose(&found.in_baselines()).expect("a baseline");
            let off = (again.matrix() - e.matrix()).amax().min((again.matrix() + e.matrix()).amax());
            prop_assert!(off < 1e-9, "{off}");
        }
    }

    #[test]
    fn the_vote_finds_it(seed in any::<u64>()) {
        let scene = Views::scene(seed, 20);
        let e = Essential::from_pose(&scene.pose).expect("a baseline");
        let found = e.recover_pose(scene.seen.iter().copied(), &scene.camera, &scene.camera).expect("a pose");
        prop_assert_eq!((found.in_front, found.voters), (20, 20));
        prop_assert!((found.pose.rotation() - scene.pose.rotation()).amax() < 1e-9);
        // The scale by the baseline, and by a length in the scene.
        let baseline = scene.pose.translation().norm();
        let metric = found.pose.with_baseline(baseline).expect("a length");
        prop_assert!((metric.translation() - scene.pose.translation()).amax() < 1e-9);
        let views = TwoViews::new(scene.camera, scene.camera, found.pose.in_baselines()).expect("a baseline");
        let point = |i: usize| views.optimal(&scene.seen[i]).expect("a point").point;
        let length = (scene.points[0] - scene.points[1]).norm();
        let metric = found.pose.with_length(&point(0), &point(1), length).expect("a length");
        prop_assert!((metric.translation() - scene.pose.translation()).amax() < 1e-6);
    }
}

#[test]
fn pixels_with_noise_give_the_pose() {
    for seed in 0..20 {
        let scene = Views::scene(seed, 200);
        let seen = noisy(&scene.seen, 0.5, seed);
        let f = eight_point(&seen).expect("a scene");
        let e = Essential::from_fundamental(&f, &scene.camera, &scene.camera).expect("rank 2");
        let found = e.recover_pose(seen.iter().copied(), &scene.camera, &scene.camera).expect("a pose");
        assert!(found.in_front >= 198, "seed {seed}: {found:?}");
        let turned = between(found.pose.rotation(), scene.pose.rotation()).to_degrees();
        let aside = found.pose.direction().angle(scene.pose.translation()).to_degrees();
        assert!(turned < 1.0 && aside < 5.0, "seed {seed}: {turned} and {aside} degrees");
    }
}

#[test]
fn a_vote_without_a_winner_is_refused() {
    let scene = Views::scene(4, 10);
    let (camera, e) = (scene.camera, Essential::from_pose(&scene.pose).expect("a baseline"));
    let vote = |seen: Vec<Correspondence<f64>>| e.recover_pose(seen, &camera, &camera).err();
    assert_eq!(vote(vec![]), Some(RecoverError::NoCorrespondence));
    // As many that are behind both cameras, and as many that are between.
    let mixed: Vec<_> = scene.seen.iter().flat_map(|s| [*s, s.swapped()]).collect();
    let straight = Essential::from_pose(
        &stereopsis::geometry::camera::Pose::new(Matrix3::identity(), Vector3::x()).expect("a pose"),
    );
    let straight = straight.expect("a baseline");
    let level: Vec<_> =
        mixed.iter().map(|s| Correspondence::new(s.first.x, 200.0, s.second.x, 200.0)).collect();
    assert_eq!(straight.recover_pose(level, &camera, &camera).err(), Some(RecoverError::Cheirality));
    let unit = Camera::new(1.0, 1.0, 0.0, 0.0).expect("a camera");
    let far = Correspondence::new(0.0, 0.0, 0.0, 0.0);
    // Parallel with R = 1; with the other rotation the axes are opposite, and as parallel.
    assert_eq!(straight.recover_pose([far], &unit, &unit).err(), Some(RecoverError::SmallAngle));
}
