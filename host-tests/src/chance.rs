//! Whether matches agree on an epipolar geometry by chance: an a-contrario test (Moisan & Stival 2004).

use core::f64::consts::SQRT_2;
use nalgebra::Point2;
use stereopsis::geometry::two_view::Correspondence;

/// Matches in the minimal sample of a fundamental matrix.
const SAMPLE: usize = 7;
/// Fundamental matrices that a minimal sample can have.
const MODELS: f64 = 3.0;

/// The logarithm (to the base 10) of how many fundamental matrices with as many inliers are expected among
/// matches that have nothing to do with each other: 0 and more, they agree by chance. Inliers are those
/// whose Sampson distance is at most `threshold_px`.
///
/// `NFA = 3 (n - 7) C(n, k) C(k, 7) a^(k - 7)` for `k` of `n` matches, where `a` is the probability that a
/// match is an inlier by chance (Moisan & Stival 2004, eq. 5).
pub fn log10_false_alarms(seen: &[Correspondence<f64>], inliers: usize, threshold_px: f64) -> f64 {
    let n = seen.len();
    if inliers <= SAMPLE || n <= SAMPLE {
        return 0.0;
    }
    (MODELS * (n - SAMPLE) as f64).log10()
        + log10_choose(n, inliers)
        + log10_choose(inliers, SAMPLE)
        + (inliers - SAMPLE) as f64 * chance_of_inlier(seen, threshold_px).log10()
}

/// The probability at most that a match is an inlier by chance: that of a place to fall within
/// `sqrt(2) threshold_px` of a line, the share that this strip has of the part of the image which the matches
/// fill, in the image where it is larger.
///
/// Sampson's distance `s` combines those to the lines of both images, `1 / s^2 = 1 / d^2 + 1 / d'^2`: the
/// smaller of these is at most `sqrt(2) s`.
fn chance_of_inlier(seen: &[Correspondence<f64>], threshold_px: f64) -> f64 {
    let strip = |points: &mut dyn Iterator<Item = Point2<f64>>| {
        let (low, high) = points
            .fold((Point2::new(f64::MAX, f64::MAX), Point2::new(f64::MIN, f64::MIN)), |(low, high), p| {
                (low.inf(&p), high.sup(&p))
            });
        let [w, h] = [high.x - low.x + 1.0, high.y - low.y + 1.0];
        (2.0 * SQRT_2 * threshold_px * w.hypot(h) / (w * h)).min(1.0)
    };
    let first = strip(&mut seen.iter().map(|s| s.first));
    first.max(strip(&mut seen.iter().map(|s| s.second)))
}

/// The logarithm of how many ways there are to choose `k` of `n`.
fn log10_choose(n: usize, k: usize) -> f64 {
    let k = k.min(n - k);
    (1..=k).map(|i| ((n - k + i) as f64 / i as f64).log10()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Random;
    use nalgebra::Matrix3;
    use stereopsis::geometry::two_view::Fundamental;

    #[test]
    fn no_more_matches_are_inliers_by_chance_than_are_counted_on() {
        // Rectified cameras: epipolar lines are rows, as many px apart as are between the places.
        let rows = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
        let rows = Fundamental::from_matrix(&rows).expect("a fundamental matrix");
        for (w, h) in [(640.0, 480.0), (1280.0, 200.0)] {
            let mut random = Random::new(3);
            let mut place = || Point2::new(w * random.unit(), h * random.unit());
            let seen: Vec<_> =
                (0..100_000).map(|_| Correspondence { first: place(), second: place() }).collect();
            let inliers = seen.iter().filter(|seen| rows.sampson_px(seen).abs() <= 1.0).count();
            let share = inliers as f64 / seen.len() as f64;
            let most = chance_of_inlier(&seen, 1.0);
            // Three deviations of a share that is counted.
            let off = 3.0 * (most / seen.len() as f64).sqrt();
            assert!((0.7 * most..=most + off).contains(&share), "{w} x {h}: {share} of at most {most}");
        }
    }

    #[test]
    fn ways_to_choose() {
        assert!((log10_choose(10, 3) - 120f64.log10()).abs() < 1e-12);
        assert!((log10_choose(52, 5) - 2_598_960f64.log10()).abs() < 1e-12);
        assert_eq!(log10_choose(5, 5), 0.0);
    }
}
