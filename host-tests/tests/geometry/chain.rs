//! From matches, some of them wrong, to the pose and the points: every stage after the other.

use crate::views::{Views, mixed, off_degrees, seeded};
use proptest::prelude::*;
use stereopsis::geometry::{
    robust::{RobustConfig, robust_fundamental},
    two_view::{Essential, TwoViews},
};

const THRESHOLD: f64 = 1.5;

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn matches_become_the_pose_and_the_points(seed in any::<u64>(), sigma in 0.0..0.5_f64,
        share in 0.0..0.5_f64) {
        let views = Views::scene(seed, 150);
        let (seen, right): (Vec<_>, Vec<_>) = mixed(&views.seen, sigma, share, seed).into_iter().unzip();
        let mut inliers = vec![false; seen.len()];
        let config = RobustConfig { seed, ..RobustConfig::new(THRESHOLD) };
        let found = robust_fundamental(&seen, &config, &mut inliers).expect("an estimate").fundamental;
        let camera = views.camera;
        let start = Essential::from_fundamental(&found, &camera, &camera).expect("rank 2");
        let essential = start.refined(&seen, &camera, &camera, THRESHOLD).expect("rank 2");
        let kept = seen.iter().zip(&inliers).filter(|&(_, &inlier)| inlier).map(|(s, _)| *s);
        let recovered = essential.recover_pose(kept, &camera, &camera).expect("a pose");

        // The errors grow with the noise; a wrong match that is on its line by chance does its part without
        // any.
        let (rotation, direction) = off_degrees(&recovered.pose.in_baselines(), &views.pose);
        prop_assert!(rotation < 0.5 + 2.0 * sigma, "{rotation} degrees, noise of {sigma} px");
        prop_assert!(direction < 3.0 + 12.0 * sigma, "{direction} degrees, noise of {sigma} px");

        // With the baseline known, points are where they are, along their sights as far as the noise lets
        // them.
        let pose = recovered.pose.with_baseline(views.pose.translation().norm()).expect("a length");
        let triangulated = TwoViews::new(camera, camera, pose).expect("a baseline");
        let mut points = views.points.iter();
        let mut off = Vec::new();
        for (s, _) in seen.iter().zip(&right).filter(|&(_, &right)| right) {
            let point = points.next().expect("a point for every right match");
            if let Ok(found) = triangulated.optimal(s) {
                off.push((found.point - point).norm() / point.coords.norm());
            }
        }
        prop_assert!(off.len() >= 140, "{} of 150 points", off.len());
        off.sort_by(f64::total_cmp);
        let median = off[off.len() / 2];
        prop_assert!(median < 0.05 + 0.9 * sigma,
            "points are {median} of their distance off, noise of {sigma} px");
    }
}
