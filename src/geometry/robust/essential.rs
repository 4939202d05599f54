//! The essential matrix of known cameras from correspondences with outliers, by samples of five.

use super::config::RobustConfig;
use super::factored::Factored;
use super::frame::Frame;
use super::fundamental::{RobustError, check, mark_inliers};
use super::loss::Biweight;
use super::ransac::{Estimator, ransac};
use super::refine::{Matrix, refine};
use super::search::Search;
use crate::geometry::Real;
use crate::geometry::camera::Camera;
use crate::geometry::two_view::{
    Correspondence, Essential, EssentialCandidates, EssentialError, Fundamental, five_point,
};
use nalgebra::Matrix3;

/// Steps of the refinement at most.
const STEPS: usize = 20;

/// Correspondences of a sample.
const SAMPLE: usize = 5;

/// An essential matrix, and how sure it is.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RobustEssential<T: Real> {
    /// E.
    pub essential: Essential<T>,
    /// How many correspondences are within the threshold.
    pub inliers: usize,
    /// Root mean square of their Sampson distances, px.
    pub rms_px: T,
    /// Samples of five that were drawn.
    pub samples: u32,
    /// The probability that an estimate as good was missed: `(1 - w^5)^k` for k samples and the share w of
    /// correspondences that have a weight, which are those within one and a half thresholds, not
    /// the inliers alone.
    pub miss_probability: T,
}

/// The essential matrix of correspondences in undistorted px ([`Camera::undistort`]) of two known cameras,
/// some of them wrong; `inliers` says which agree with it.
///
/// As [`robust_fundamental`](crate::geometry::robust::robust_fundamental), with samples of five (Nister 2004)
/// in place of seven: fewer are needed, a plane leaves nothing open but a second camera that sees it as well,
/// and no F is ruled out because it is no E. Each best estimate is refined over its five numbers on the way.
/// Bounded by [`RobustConfig::most_samples`], of some 70 000 operations each and ten candidates at most. The
/// samples are solved in `f64`, also for `f32`.
///
/// Two scenes have no answer of their own, and are not refused:
///
/// * A camera that has only turned: any direction of the baseline agrees, and the one found is chance.
///   [`Essential::recover_pose`] then has hardly more than half of its voters in front.
/// * One plane: a second motion may agree as well, and the answer is either of the two
///   ([`Homography::motions`](crate::geometry::two_view::Homography::motions) has both).
///
/// In both a homography explains the inliers:
/// [`choose`](crate::geometry::two_view::choose) of them is
/// [`Planar`](crate::geometry::two_view::TwoViewModel::Planar), and
/// [`robust_fundamental`](crate::geometry::robust::robust_fundamental) refuses them as a plane.
///
/// Like the errors of F, those of E ask for eight correspondences, so that more than a sample agrees.
pub fn robust_essential<T: Real>(
    seen: &[Correspondence<T>],
    first: &Camera<T>,
    second: &Camera<T>,
    config: &RobustConfig<T>,
    inliers: &mut [bool],
) -> Result<RobustEssential<T>, RobustError> {
    let inliers = check(seen, config, inliers)?;
    let frames = [Frame::of_camera(first), Frame::of_camera(second)];
    let mut search = Search::<T, SAMPLE>::new(Matrix::Essential, seen, frames, config);
    let samples = ransac(&mut search, config.most_samples);
    let best = search.best.ok_or(RobustError::NoAgreement)?;
    let loss = Biweight::new(config.threshold_px);
    let best = refine(best, Matrix::Essential, seen, &frames, loss, (1, STEPS));
    let essential = Essential::nearest(&best.matrix()).map_err(|_| RobustError::NoAgreement)?;
    let fundamental = Fundamental::from_essential(&essential, first, second);
    let (count, sum) = mark_inliers(&fundamental, seen, config, inliers);
    if count <= SAMPLE || !sum.is_finite() {
        return Err(RobustError::NoAgreement);
    }
    let rms_px = (sum / T::count(count)).sqrt();
    Ok(RobustEssential { essential, inliers: count, rms_px, samples, miss_probability: search.missed })
}

impl<T: Real> Estimator<SAMPLE> for Search<'_, T, SAMPLE> {
    type Model = Matrix3<T>;
    type Models = EssentialCandidates<T>;

    fn draw(&mut self, drawn: u32) -> [usize; SAMPLE] {
        self.sampler.next(drawn)
    }

    fn models(&self, sample: &[usize; SAMPLE]) -> EssentialCandidates<T> {
        five_point(&self.normalised(sample))
    }

    fn consider(&mut self, model: &Matrix3<T>, _sample: &[usize; SAMPLE]) {
        let f = self.in_pixels(model);
        self.compare(&f);
    }

    fn is_enough(&mut self, drawn: u32) -> bool {
        self.has_enough(drawn)
    }
}

impl<T: Real> Essential<T> {
    /// The essential matrix near this one that makes Sampson's distances least, px, over the five numbers
    /// that it has; at most thirty steps of Levenberg's and Marquardt's method.
    ///
    /// `seen` are undistorted px ([`Camera::undistort`]), outliers among them: weights fall with the
    /// distance, to zero at one and a half times the threshold, as in
    /// [`robust_fundamental`](crate::geometry::robust::robust_fundamental), and in the last ten steps at as
    /// many times three deviations of the noise, by the median distance of what is within the threshold. A
    /// correspondence that is not finite has no weight. The error is that of a matrix that is no estimate at
    /// all.
    pub fn refined(
        &self,
        seen: &[Correspondence<T>],
        first: &Camera<T>,
        second: &Camera<T>,
        threshold_px: T,
    ) -> Result<Self, EssentialError> {
        let frames = [Frame::of_camera(first), Frame::of_camera(second)];
        let start = Factored::new(self.matrix()).ok_or(EssentialError::Rank)?.essential();
        let loss = Biweight::new(threshold_px);
        // From far to near: the start may come from a matrix that knew nothing of the cameras.
        let wide = refine(start, Matrix::Essential, seen, &frames, loss.widened(T::of(2.5)), (1, STEPS / 2));
        let near = refine(wide, Matrix::Essential, seen, &frames, loss, (1, STEPS / 2));
        // What is as near as the noise of most leaves it says the most.
        let found = Fundamental::from_essential(&Self::nearest(&near.matrix())?, first, second);
        let loss = Biweight::new(three_deviations_px(&found, seen, threshold_px));
        let near = refine(near, Matrix::Essential, seen, &frames, loss, (1, STEPS / 2));
        Self::nearest(&near.matrix())
    }
}

/// Steps in which the median distance is counted, to the threshold.
const BINS: usize = 64;

/// Three standard deviations of the noise of Sampson's distances, px: 1.4826 times their median is one, of
/// what is within the threshold, to a sixty-fourth of that; the threshold at most, a tenth of it at least.
fn three_deviations_px<T: Real>(f: &Fundamental<T>, seen: &[Correspondence<T>], threshold_px: T) -> T {
    let (mut counts, mut all) = ([0_usize; BINS], 0);
    let per_px = T::count(BINS) / threshold_px;
    for s in seen {
        let steps = f.sampson_px(s).abs() * per_px;
        let bin = (0..BINS).find(|&bin| steps < T::count(bin + 1));
        if let Some(count) = bin.and_then(|bin| counts.get_mut(bin)) {
            *count += 1;
            all += 1;
        }
    }
    let (mut below, mut median) = (0, BINS);
    for (bin, count) in counts.iter().enumerate() {
        below += count;
        if 2 * below >= all {
            median = bin + 1;
            break;
        }
    }
    (T::count(median) / per_px * T::of(3.0 * 1.4826)).min(threshold_px).max(threshold_px * T::of(0.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_distance_says_how_wide_the_noise_is() {
        let rectified = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
        let f = Fundamental::from_matrix(&rectified).expect("rank 2");
        // Distances of so many 64ths of the threshold of 2 px.
        let of = |steps: [f64; 6]| {
            let rows = steps.map(|steps| steps / 32.0 * core::f64::consts::SQRT_2);
            three_deviations_px(&f, &rows.map(|by| Correspondence::new(9.0, 4.0, 7.0, 4.0 + by)), 2.0)
        };
        // Three of the five within the threshold are below 7 of 64 steps.
        let found = of([3.5, 6.5, -6.5, 20.5, 30.5, 70.0]);
        assert!((found - 7.0 / 32.0 * 3.0 * 1.4826).abs() < 1e-9, "{found}");
        // Of an even number the lower half.
        let found = of([3.5, -6.5, 20.5, 30.5, 70.0, 80.0]);
        assert!((found - 7.0 / 32.0 * 3.0 * 1.4826).abs() < 1e-9, "{found}");
        // The threshold at most, a tenth of it at least.
        assert_eq!(of([60.5; 6]), 2.0);
        assert!((of([0.5; 6]) - 0.2).abs() < 1e-12);
    }
}
