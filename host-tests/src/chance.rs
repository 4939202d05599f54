//! Whether matches agree on an epipolar geometry by chance: an a-contrario test (Moisan & Stival 2004).

use nalgebra::Point2;
use stereopsis::geometry::two_view::Correspondence;

/// Matches in the minimal sample of a fundamental matrix.
const SAMPLE: usize = 7;
/// Fundamental matrices that a minimal sample can have.
const MODELS: f64 = 3.0;

/// The logarithm (to the base 10) of how many fundamental matrices with as many inliers are expected among
/// matches that have nothing to do with each other: 0 and more, they agree by chance.
///
/// `NFA = 3 (n - 7) C(n, k) C(k, 7) a^(k - 7)` for `k` of `n` matches, where `a` is the probability that a
/// place falls within `threshold_px` of a line: the area of that strip in the part of the image that the
/// matches fill (Moisan & Stival 2004, eq. 5; of both images the larger one).
pub fn log10_false_alarms(seen: &[Correspondence<f64>], inliers: usize, threshold_px: f64) -> f64 {
    let n = seen.len();
    if inliers <= SAMPLE || n <= SAMPLE {
        return 0.0;
    }
    let strip = |points: &mut dyn Iterator<Item = Point2<f64>>| {
        let (low, high) = points
            .fold((Point2::new(f64::MAX, f64::MAX), Point2::new(f64::MIN, f64::MIN)), |(low, high), p| {
                (low.inf(&p), high.sup(&p))
            });
        let [w, h] = [high.x - low.x + 1.0, high.y - low.y + 1.0];
        (2.0 * threshold_px * w.hypot(h) / (w * h)).min(1.0)
    };
    let strips = [strip(&mut seen.iter().map(|s| s.first)), strip(&mut seen.iter().map(|s| s.second))];
    let probability = strips[0].max(strips[1]);
    (MODELS * (n - SAMPLE) as f64).log10()
        + log10_choose(n, inliers)
        + log10_choose(inliers, SAMPLE)
        + (inliers - SAMPLE) as f64 * probability.log10()
}

/// The logarithm of how many ways there are to choose `k` of `n`.
fn log10_choose(n: usize, k: usize) -> f64 {
    let k = k.min(n - k);
    (1..=k).map(|i| ((n - k + i) as f64 / i as f64).log10()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_to_choose() {
        assert!((log10_choose(10, 3) - 120f64.log10()).abs() < 1e-12);
        assert!((log10_choose(52, 5) - 2_598_960f64.log10()).abs() < 1e-12);
        assert_eq!(log10_choose(5, 5), 0.0);
    }
}
