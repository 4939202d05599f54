//! Answers beside the truth of a rendered scene.

use crate::map::{DisparityMap, quantile};
use crate::scene::Truth;
use crate::sparsification::{Judged, Sparsification};
use serde::Serialize;
use stereopsis::depth::DepthScale;

/// How right the answers are. Pixels that show nothing, or that only the left camera sees, are left out: no
/// matcher can know them.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Accuracy {
    /// Pixels that both cameras see.
    pub seen_by_both: usize,
    /// Share of these with an answer, 0 to 1.
    pub density: f64,
    /// Share of these answers that are more than 2 px off, 0 to 1.
    pub bad2: f64,
    /// Root mean square error of the others, px.
    pub rms_good_px: f64,
    /// Share of the answers whose true depth is within three of the deviations that the core says, 0 to 1.
    pub within_3_sigma: f64,
    /// Half of the answers are nearer to their true depth than this, m.
    pub median_depth_error_m: f64,
    /// The same as a share of the true depth.
    pub median_depth_error_relative: f64,
    /// Answers at pixels that only the left camera sees: all of them are guesses.
    pub answers_where_occluded: usize,
    /// How well their confidence tells those that are more than 2 px off; absent when there is no answer.
    pub sparsification: Option<Sparsification>,
}

impl Accuracy {
    /// An answer off by more than this is bad, px.
    pub const BAD_PX: f32 = 2.0;

    /// Compares a map with the truth of the same size.
    pub fn of(map: &DisparityMap, truth: &Truth, scale: &DepthScale) -> Self {
        let (mut seen, mut answers, mut good, mut within, mut squares) =
            (0usize, 0usize, 0usize, 0usize, 0.0f64);
        let (mut errors_m, mut relative) = (Vec::new(), Vec::new());
        let mut guesses = 0;
        for (i, &d) in map.disparity.iter().enumerate() {
            let depth_m = truth.depth_m[i];
            if truth.occluded[i] || !depth_m.is_finite() {
                guesses += usize::from(truth.occluded[i] && d.is_some());
                continue;
            }
            seen += 1;
            let Some(px) = d.to_f32() else { continue };
            answers += 1;
            let error_px = (px - truth.disparity[i]).abs();
            if error_px <= Self::BAD_PX {
                good += 1;
                squares += f64::from(error_px).powi(2);
            }
            // An answer at or behind infinity has no depth: infinitely wrong.
            let error_m = scale.metres(d).map_or(f32::INFINITY, |z| (z.0 - depth_m).abs());
            let sigma_m = scale.sigma(d, map.sigma_px[i]).map_or(0.0, |s| s.0);
            within += usize::from(error_m <= 3.0 * sigma_m);
            errors_m.push(error_m);
            relative.push(error_m / depth_m);
        }
        let share = |part: usize, whole: usize| part as f64 / whole.max(1) as f64;
        let median = |mut values: Vec<f32>| {
            values.sort_by(f32::total_cmp);
            quantile(&values, 0.5).map_or(0.0, f64::from)
        };
        Self {
            seen_by_both: seen,
            density: share(answers, seen),
            bad2: share(answers - good, answers),
            rms_good_px: (squares / good.max(1) as f64).sqrt(),
            within_3_sigma: share(within, answers),
            median_depth_error_m: median(errors_m),
            median_depth_error_relative: median(relative),
            answers_where_occluded: guesses,
            sparsification: Sparsification::of(&Self::judged(map, truth)),
        }
    }

    /// The answers for points that both cameras see: 1 for those that are bad, 0 for the others.
    pub fn judged(map: &DisparityMap, truth: &Truth) -> Vec<Judged> {
        map.judged(|i, px| {
            let known = !truth.occluded[i] && truth.depth_m[i].is_finite();
            let bad = (px - truth.disparity[i]).abs() > Self::BAD_PX;
            known.then(|| f32::from(u8::from(bad)))
        })
    }

    /// The true disparities in px; infinite where the scene shows nothing.
    pub fn true_disparity_px(truth: &Truth) -> Vec<f32> {
        let pixels = truth.disparity.iter().zip(&truth.depth_m);
        pixels.map(|(&d, z)| if z.is_finite() { d } else { f32::INFINITY }).collect()
    }

    /// Answer minus truth in px for each pixel; infinite where there is no answer or no truth.
    pub fn errors_px(map: &DisparityMap, truth: &Truth) -> Vec<f32> {
        map.disparity
            .iter()
            .enumerate()
            .map(|(i, d)| match d.to_f32() {
                Some(px) if truth.depth_m[i].is_finite() => px - truth.disparity[i],
                _ => f32::INFINITY,
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stereopsis::geometry::camera::RectifiedRig;
    use stereopsis::units::Disparity;

    #[test]
    fn what_shows_nothing_is_not_occluded() {
        // A point that both see, one that the left camera sees alone, and two pixels of nothing, of which one
        // has no answer.
        let depth_m = vec![2.0, 2.0, f32::INFINITY, f32::INFINITY];
        let truth = Truth {
            width: 4,
            height: 1,
            disparity: vec![10.0, 10.0, 0.0, 0.0],
            depth_m,
            occluded: vec![false, true, false, false],
            objects: vec![Some(0), Some(0), None, None],
        };
        let mut map = DisparityMap::new(4, 1);
        map.disparity[..3].fill(Disparity::from_pixels(10));
        let rig = RectifiedRig::new(100.0, 0.2, 2.0, 0.5).expect("a rig");
        let found = Accuracy::of(&map, &truth, &DepthScale::new(&rig).expect("a scale"));
        assert_eq!((found.seen_by_both, found.density, found.answers_where_occluded), (1, 1.0, 1));
    }
}
