//! The robust essential matrix of known cameras: views far apart, planes, what is refused.

use crate::views::{Views, mixed, narrow, noisy, off_degrees};
use nalgebra::{Point3, Rotation3, Vector3};
use stereopsis::geometry::{
    camera::{Camera, Pose},
    robust::{RobustConfig, RobustError, RobustEssential, robust_essential, robust_fundamental},
    two_view::{Correspondence, Essential, Fundamental},
};
use stereopsis_host::scene::Random;

const THRESHOLD: f64 = 1.5;

/// Two cameras that look at a box 6 m away from places so many degrees apart, as seen from there.
fn far_apart(seed: u64, degrees: f64, count: usize, flat: f64) -> Views {
    let mut random = Random::new(seed);
    let middle = Vector3::new(0.0, 0.0, 6.0);
    let turn = Rotation3::new(Vector3::new(0.1 * random.unit(), -degrees.to_radians(), 0.1 * random.unit()));
    let pose = Pose::new(*turn.matrix(), middle - turn * middle).expect("a rotation");
    Views::of(&mut random, count, pose, |random: &mut Random| {
        let mut number = |size: f64| size * (2.0 * random.unit() - 1.0);
        Point3::new(number(2.0), number(1.5), 6.0 + number(flat))
    })
}

fn solve(
    seen: &[Correspondence<f64>],
    camera: &Camera<f64>,
    seed: u64,
) -> Result<(RobustEssential<f64>, Vec<bool>), RobustError> {
    let mut inliers = vec![false; seen.len()];
    let config = RobustConfig { seed, ..RobustConfig::new(THRESHOLD) };
    robust_essential(seen, camera, camera, &config, &mut inliers).map(|found| (found, inliers))
}

/// How far a matrix's pose is off, degrees: the larger of the turn and the direction.
fn off(e: &Essential<f64>, seen: &[Correspondence<f64>], inliers: &[bool], views: &Views) -> f64 {
    let kept = seen.iter().zip(inliers).filter(|&(_, &kept)| kept).map(|(s, _)| *s);
    let Ok(found) = e.recover_pose(kept, &views.camera, &views.camera) else { return 180.0 };
    let (turn, direction) = off_degrees(&found.pose.in_baselines(), &views.pose);
    turn.max(direction)
}

#[test]
fn views_far_apart() {
    // Of 40 pairs each, half of whose matches are wrong.
    for degrees in [25.0, 40.0, 55.0] {
        let (mut failures, mut of_f, mut errors) = (0, 0, Vec::new());
        for seed in 0..40 {
            let views = far_apart(seed, degrees, 60, 1.0);
            let (seen, _): (Vec<_>, Vec<_>) = mixed(&views.seen, 0.5, 0.5, seed).into_iter().unzip();
            let error = solve(&seen, &views.camera, seed)
                .map_or(180.0, |(e, kept)| off(&e.essential, &seen, &kept, &views));
            failures += usize::from(error > 5.0);
            errors.push(error);
            let mut kept = vec![false; seen.len()];
            let config = RobustConfig { seed, ..RobustConfig::new(THRESHOLD) };
            let f = robust_fundamental(&seen, &config, &mut kept);
            let error = f
                .ok()
                .and_then(|f| Essential::from_fundamental(&f.fundamental, &views.camera, &views.camera).ok());
            let error = error.and_then(|e| e.refined(&seen, &views.camera, &views.camera, THRESHOLD).ok());
            of_f += usize::from(error.is_none_or(|e| off(&e, &seen, &kept, &views) > 5.0));
        }
        errors.sort_by(f64::total_cmp);
        println!(
            "{degrees} degrees: {failures} of 40 fail, by way of F {of_f}; median {:.3} degrees",
            errors[20]
        );
        assert!(
            failures <= 1 && failures <= of_f && errors[20] < 0.5,
            "{degrees}: {failures} {}",
            errors[20]
        );
    }
}

#[test]
fn a_plane_with_few_points_off_it() {
    // A plane leaves E open between two: what is off it chooses.
    for share in [0.05, 0.1, 0.2] {
        let mut failures = 0;
        for seed in 0..20 {
            let flat = far_apart(seed, 15.0, 150, 0.0);
            let deep = far_apart(seed, 15.0, (150.0 * share / (1.0 - share)) as usize, 1.5);
            let views = Views { seen: [flat.seen, deep.seen].concat(), ..flat };
            let (seen, _): (Vec<_>, Vec<_>) = mixed(&views.seen, 0.3, 0.2, seed).into_iter().unzip();
            let error = solve(&seen, &views.camera, seed)
                .map_or(180.0, |(e, kept)| off(&e.essential, &seen, &kept, &views));
            failures += usize::from(error > 5.0);
        }
        println!("{:.0} % off the plane: {failures} of 20 fail", 100.0 * share);
        assert!(failures <= 1, "{share}: {failures}");
    }
}

#[test]
fn in_f32_as_in_f64() {
    let views = far_apart(3, 30.0, 80, 1.0);
    let seen = noisy(&views.seen, 0.3, 3);
    let (wide, _) = solve(&seen, &views.camera, 1).expect("an estimate");
    let camera = Camera::new(600.0_f32, 600.0, 320.0, 240.0).expect("a camera");
    let (seen, mut inliers) = (narrow(&seen), vec![false; seen.len()]);
    let config = RobustConfig { seed: 1, ..RobustConfig::new(THRESHOLD as f32) };
    let single = robust_essential(&seen, &camera, &camera, &config, &mut inliers).expect("an estimate");
    let (a, b) = (single.essential.matrix().cast::<f64>(), wide.essential.matrix());
    assert!((a - b).amax().min((a + b).amax()) < 1e-3, "{a} {b}");
    assert!(single.inliers.abs_diff(wide.inliers) <= 1);
}

#[test]
fn what_is_said_of_an_estimate_is_so() {
    let views = far_apart(5, 30.0, 80, 1.0);
    let (seen, _): (Vec<_>, Vec<_>) = mixed(&views.seen, 0.4, 0.3, 5).into_iter().unzip();
    let (found, inliers) = solve(&seen, &views.camera, 1).expect("an estimate");
    let f = Fundamental::from_essential(&found.essential, &views.camera, &views.camera);
    let mut squares = 0.0;
    for (s, &inlier) in seen.iter().zip(&inliers) {
        let squared = f.sampson_squared_px2(s);
        assert_eq!(inlier, squared <= THRESHOLD * THRESHOLD);
        squares += if inlier { squared } else { 0.0 };
    }
    assert_eq!(found.inliers, inliers.iter().filter(|&&inlier| inlier).count());
    assert!((found.rms_px - (squares / found.inliers as f64).sqrt()).abs() < 1e-9, "{}", found.rms_px);
    assert!(found.miss_probability <= 1e-3 && (16..200).contains(&found.samples), "{found:?}");
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let views = far_apart(1, 20.0, 20, 1.0);
    let refused = |seen: &[Correspondence<f64>], config: RobustConfig<f64>, room: usize| {
        robust_essential(seen, &views.camera, &views.camera, &config, &mut vec![false; room]).err()
    };
    let config = RobustConfig::new(THRESHOLD);
    assert_eq!(refused(&views.seen[..7], config, 7), Some(RobustError::TooFew));
    assert_eq!(refused(&views.seen, config, 19), Some(RobustError::Inliers(20)));
    assert_eq!(refused(&views.seen, RobustConfig::new(0.0), 20), Some(RobustError::Threshold));
    assert_eq!(
        refused(&views.seen, RobustConfig { most_samples: 0, ..config }, 20),
        Some(RobustError::NoSamples)
    );
    assert_eq!(refused(&[views.seen[0]; 12], config, 12), Some(RobustError::NoAgreement));
}
