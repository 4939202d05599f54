//! Matches of unrelated images agree by chance, and are found to.

use nalgebra::Point2;
use stereopsis::geometry::robust::{RobustConfig, robust_fundamental};
use stereopsis::geometry::two_view::Correspondence;
use stereopsis_host::chance::log10_false_alarms;
use stereopsis_host::scene::Random;
use stereopsis_host::two_view::{Views, mixed};

/// Matches anywhere in two images of 640 x 480 px.
fn unrelated(random: &mut Random, n: usize) -> Vec<Correspondence<f64>> {
    let mut place = || Point2::new(640.0 * random.unit(), 480.0 * random.unit());
    (0..n).map(|_| Correspondence { first: place(), second: place() }).collect()
}

/// The logarithm of false alarms of the best matrix of some matches.
fn found(seen: &[Correspondence<f64>], threshold_px: f64) -> Option<f64> {
    let mut inliers = vec![false; seen.len()];
    robust_fundamental(seen, &RobustConfig::new(threshold_px), &mut inliers).ok()?;
    Some(log10_false_alarms(seen, inliers.iter().filter(|&&inlier| inlier).count(), threshold_px))
}

#[test]
fn unrelated_matches_are_known_for_what_they_are() {
    let mut random = Random::new(7);
    for (n, threshold_px) in [(20, 1.0), (71, 1.0), (71, 3.0), (300, 1.0)] {
        let logs: Vec<_> = (0..60).filter_map(|_| found(&unrelated(&mut random, n), threshold_px)).collect();
        let taken = logs.iter().filter(|&&log10| log10 <= 0.0).count();
        println!(
            "{n} at {threshold_px} px: {taken} of {} taken, least {:?}",
            logs.len(),
            logs.iter().copied().reduce(f64::min)
        );
        // Noise has a best matrix too: without one there would be nothing to take.
        assert!(logs.len() >= 55, "{} of 60 sets of {n} at {threshold_px} px have a matrix", logs.len());
        assert!(20 * taken <= logs.len(), "{taken} of {} sets of {n} at {threshold_px} px", logs.len());
    }
}

#[test]
fn matches_of_one_scene_agree_for_a_reason() {
    for seed in 0..20 {
        // Half of them wrong.
        let mixed = mixed(&Views::scene(seed, 40).seen, 0.3, 0.5, seed);
        let seen: Vec<_> = mixed.into_iter().map(|(s, _)| s).collect();
        let log10 = found(&seen, 1.0).expect("a matrix");
        assert!(log10 < -6.0, "seed {seed}: {log10}");
    }
}
