//! The fundamental matrix from correspondences with outliers.

use super::config::RobustConfig;
use super::frame::Frame;
use super::loss::Biweight;
use super::ransac::ransac;
use super::refine::{Matrix, refine};
use super::search::{MINIMUM, Search};
use crate::geometry::Real;
use crate::geometry::two_view::{Correspondence, Fundamental};

/// Why correspondences give no fundamental matrix, however many of them are left out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RobustError {
    /// Fewer than eight correspondences.
    TooFew,
    /// A number is infinite or not a number.
    NotFinite,
    /// The threshold is not greater than zero, or not finite.
    Threshold,
    /// The probability of a miss is not between zero and one.
    MissProbability,
    /// No sample is allowed.
    NoSamples,
    /// The slice for the inliers is shorter than the correspondences; this many are needed.
    Inliers(usize),
    /// No sample gave an estimate that more correspondences than the sample agree with: all are wrong, or the
    /// same, or the ones of an image are on a line.
    NoAgreement,
    /// What agrees is on a plane, or the camera has only rotated: a homography is the answer. Off the plane
    /// no more agree than by chance. The inliers say which are on it.
    Plane,
}

error_text!(RobustError {
    Self::TooFew => "a fundamental matrix needs eight correspondences",
    Self::NotFinite => "a coordinate is not finite",
    Self::Threshold => "the threshold must be greater than zero and finite",
    Self::MissProbability => "the probability of a miss must be between zero and one",
    Self::NoSamples => "one sample at least is needed",
    Self::Inliers(needed) => "the inliers need a slice of {needed}",
    Self::NoAgreement => "no estimate has more correspondences agree with it than a sample has",
    Self::Plane => "what agrees is on a plane, or the camera has only rotated: a homography is the answer",
});

/// A fundamental matrix, and how sure it is.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RobustFundamental<T: Real> {
    /// F.
    pub fundamental: Fundamental<T>,
    /// How many correspondences are within the threshold.
    pub inliers: usize,
    /// Root mean square of their Sampson distances, px.
    pub rms_px: T,
    /// Samples of seven that were drawn.
    pub samples: u32,
    /// The probability that an estimate as good was missed: `(1 - w^7)^k` for k samples and the share w of
    /// correspondences that have a weight, which are those within one and a half thresholds, not
    /// the inliers alone. More than was asked when the samples ran out.
    pub miss_probability: T,
}

/// The fundamental matrix of correspondences in pixels, some of them wrong; `inliers` says which agree with
/// it.
///
/// Samples of seven give candidates, a sequential test drops the bad ones after a few correspondences, each
/// best one so far is refined, and the last is the one that makes the sum of a loss of Sampson's distances
/// least: the weight of a correspondence falls as `(1 - d^2 / w^2)^2` to zero at one and a half thresholds w,
/// so that neither the noise nor a sharp limit has to be known (Barath et al. 2020 arrive at nearly the same
/// weights). Where most of what agrees is on one plane, F is completed by what is off it, and the plane is
/// the answer where so many agree off it by chance, for noise moves them in any direction (Moisan & Stival
/// 2004).
///
/// Bounded by [`RobustConfig::most_samples`], and stopped before that by [`RobustConfig::miss_probability`].
/// A sample has three candidates at most. Each costs n distances at most, of which a bad one needs a few; one
/// that is nearly as good as the best is refined, by eight passes over 300 correspondences at most and n
/// distances; one that is on a plane too tries pairs of what is off it, 800 at most, of 128 distances each,
/// and is refined once more.
/// So a sample costs no more than 40 n + 322 000 distances, usually some dozens, and the end of the search
/// once more as much; the number of samples is what counts. With the share w of right matches it is about
/// `7 / w^7` for a miss of 0.1 %: 85 for w = 0.7, 4 300 for 0.4, where 10 000 are drawn below 0.35.
///
/// Equal inputs and seeds give equal bits. Stack only, besides the slices. `f32` errs as `f64` does from
/// 0.1 px of noise on.
///
/// ```
/// use stereopsis::geometry::{robust::{RobustConfig, robust_fundamental}, two_view::Correspondence};
/// // A rectified pair: rows are equal, but for the last match, which is 40 rows off.
/// let at = [
///     (0, 0, 8), (90, 0, 9), (0, 70, 6), (90, 70, 17), (20, 20, 4), (60, 10, 13), (30, 50, 12), (70, 60, 5),
///     (45, 33, 7), (12, 64, 19), (81, 25, 3), (38, 5, 10), (55, 47, 15), (5, 38, 16), (66, 35, 40),
/// ];
/// let px = |x: i32| f64::from(x);
/// let mut seen = at.map(|(u, v, d)| Correspondence::new(px(u), px(v), px(u - d), px(v)));
/// seen[14].second.y += 40.0;
/// let mut inliers = [false; 15];
/// let found = robust_fundamental(&seen, &RobustConfig::new(0.5), &mut inliers)?;
/// assert_eq!(found.inliers, 14);
/// assert!(inliers[..14].iter().all(|&inlier| inlier) && !inliers[14]);
/// assert!(found.rms_px < 1e-6 && found.miss_probability <= 1e-3);
/// # Ok::<(), stereopsis::geometry::robust::RobustError>(())
/// ```
pub fn robust_fundamental<T: Real>(
    seen: &[Correspondence<T>],
    config: &RobustConfig<T>,
    inliers: &mut [bool],
) -> Result<RobustFundamental<T>, RobustError> {
    let inliers = check(seen, config, inliers)?;
    let frames = Frame::of_points(seen).ok_or(RobustError::NoAgreement)?;
    let mut search = Search::new(Matrix::Fundamental, seen, frames, config);
    let samples = ransac(&mut search, config.most_samples);
    if let Some(plane) = search.only_plane() {
        for (inlier, s) in inliers.iter_mut().zip(seen) {
            *inlier = plane.distance_squared_px2(s) <= search.on_plane_px2();
        }
        return Err(RobustError::Plane);
    }
    let best = search.best.ok_or(RobustError::NoAgreement)?;
    let loss = Biweight::new(config.threshold_px);
    let best = refine(best, Matrix::Fundamental, seen, &frames, loss, (1, 20));
    let fundamental = Fundamental::of_singular(&search.in_pixels(&best.matrix()));
    let (count, sum) = mark_inliers(&fundamental, seen, config, inliers);
    let fundamental = fundamental.sound().ok_or(RobustError::NoAgreement)?;
    if count <= MINIMUM || !sum.is_finite() {
        return Err(RobustError::NoAgreement);
    }
    Ok(RobustFundamental {
        fundamental,
        inliers: count,
        rms_px: (sum / T::count(count)).sqrt(),
        samples,
        miss_probability: search.missed,
    })
}

/// Says which correspondences are within the threshold; how many, and the sum of their squared Sampson
/// distances, px^2.
pub(super) fn mark_inliers<T: Real>(
    fundamental: &Fundamental<T>,
    seen: &[Correspondence<T>],
    config: &RobustConfig<T>,
    inliers: &mut [bool],
) -> (usize, T) {
    let most = config.threshold_px * config.threshold_px;
    let (mut count, mut sum) = (0, T::ZERO);
    for (inlier, s) in inliers.iter_mut().zip(seen) {
        let squared = fundamental.sampson_squared_px2(s);
        *inlier = squared <= most;
        if *inlier {
            count += 1;
            sum += squared;
        }
    }
    (count, sum)
}

/// Refuses what no search can be made of, and cuts the inliers to as many as there are correspondences.
pub(super) fn check<'a, T: Real>(
    seen: &[Correspondence<T>],
    config: &RobustConfig<T>,
    inliers: &'a mut [bool],
) -> Result<&'a mut [bool], RobustError> {
    let n = seen.len();
    if n < 8 {
        return Err(RobustError::TooFew);
    }
    if !(config.threshold_px > T::ZERO && config.threshold_px.is_finite()) {
        return Err(RobustError::Threshold);
    }
    if !(config.miss_probability > T::ZERO && config.miss_probability < T::ONE) {
        return Err(RobustError::MissProbability);
    }
    if config.most_samples == 0 {
        return Err(RobustError::NoSamples);
    }
    let inliers = inliers.get_mut(..n).ok_or(RobustError::Inliers(n))?;
    if !seen.iter().all(Correspondence::is_finite) {
        return Err(RobustError::NotFinite);
    }
    Ok(inliers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    #[test]
    fn what_no_search_can_be_made_of_is_refused() {
        let seen: [_; 9] = core::array::from_fn(|i| Correspondence::new(i as f64, 1.0, 2.0, 3.0));
        let checked = |n: usize, config: RobustConfig<f64>, room: usize| {
            check(&seen[..n], &config, &mut [false; 12][..room]).map(|inliers| inliers.len())
        };
        let config = RobustConfig::new(1.0);
        assert_eq!([7, 8, 9].map(|n| checked(n, config, n)), [Err(RobustError::TooFew), Ok(8), Ok(9)]);
        assert_eq!(
            [8, 9, 12].map(|room| checked(9, config, room)),
            [Err(RobustError::Inliers(9)), Ok(9), Ok(9)]
        );
        for (threshold_px, is_one) in [(0.0, false), (1e-300, true), (f64::MAX, true), (f64::INFINITY, false)]
        {
            assert_eq!(checked(9, RobustConfig::new(threshold_px), 9).is_ok(), is_one, "{threshold_px}");
        }
        for (miss_probability, is_one) in [(0.0, false), (1e-9, true), (0.999, true), (1.0, false)] {
            let config = RobustConfig { miss_probability, ..config };
            assert_eq!(checked(9, config, 9).is_ok(), is_one, "{miss_probability}");
        }
        assert_eq!(checked(9, RobustConfig { most_samples: 0, ..config }, 9), Err(RobustError::NoSamples));
        assert_eq!(checked(9, RobustConfig { most_samples: 1, ..config }, 9), Ok(9));
    }

    #[test]
    fn inliers_are_counted_and_their_squares_summed() {
        let rectified = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
        let f = Fundamental::from_matrix(&rectified).expect("rank 2");
        // Sampson's distance is the difference of the rows over the root of two.
        let rows = [0.0, 1.0, -2.0, 4.2, 4.3, -30.0, 4.0];
        let seen = rows.map(|rows| Correspondence::new(5.0 * rows, 50.0, 30.0, 50.0 + rows));
        let mut inliers = [true; 7];
        let (count, sum) = mark_inliers(&f, &seen, &RobustConfig::new(3.0), &mut inliers);
        assert_eq!((count, inliers), (5, [true, true, true, true, false, false, true]));
        let expected: f64 = [1.0, 4.0, 4.2 * 4.2, 16.0].iter().map(|squared| squared / 2.0).sum();
        assert!((sum - expected).abs() < 1e-9, "{sum} {expected}");
    }
}
