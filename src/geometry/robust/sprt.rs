//! Randomised RANSAC with the sequential probability ratio test, SPRT (Matas & Chum 2005).

use super::loss::{Biweight, weight_and_gain};
use crate::geometry::Real;
use crate::geometry::two_view::Correspondence;
use nalgebra::{Matrix3, Vector3};

/// How many times as likely a bad estimate has to be as a good one to be dropped: of the good ones one in so
/// many is dropped at most.
const DROP: f64 = 100.0;

/// Wald's sequential probability ratio test (SPRT) of estimates against the best so far (Matas & Chum 2005).
///
/// Correspondence after correspondence the odds change by how often one is an inlier of a good and of a bad
/// estimate, and a bad one is dropped after a few.
pub(super) struct Sprt<T: Real> {
    /// Shares of inliers of the best estimate, and of a wrong one.
    good: T,
    bad: T,
    /// The likelihood ratios of an inlier and of an outlier, by which the odds are multiplied.
    inlier_ratio: T,
    outlier_ratio: T,
    /// Inliers of dropped estimates, and all correspondences that those were tried on.
    chance: (T, T),
}

/// The score of an estimate.
#[derive(Clone, Copy)]
pub(super) struct Score<T: Real> {
    /// The sum of the loss's gains.
    pub(super) gain: T,
    /// How many correspondences are within the loss's width.
    pub(super) inliers: usize,
}

impl<T: Real> Sprt<T> {
    pub(super) fn new() -> Self {
        // Until something is known: nothing is dropped.
        let one = T::ONE;
        Self {
            good: T::ZERO,
            bad: T::of(0.05),
            inlier_ratio: one,
            outlier_ratio: one,
            chance: (T::of(2.0), T::of(40.0)),
        }
    }

    /// Takes note of the share of inliers of the best estimate.
    pub(super) fn learn(&mut self, good: T) {
        self.good = good;
        self.update_ratios();
    }

    fn update_ratios(&mut self) {
        let (least, most) = (T::of(0.005), T::of(0.999));
        self.bad = (self.chance.0 / self.chance.1).max(least);
        let good = self.good.min(most);
        // Where a wrong estimate has nearly as many inliers as the best, counting decides nothing.
        (self.inlier_ratio, self.outlier_ratio) = if good > self.bad * T::of(1.2) {
            (self.bad / good, (T::ONE - self.bad) / (T::ONE - good))
        } else {
            (T::ONE, T::ONE)
        };
    }

    /// The score of F (in px), or `None` as soon as it is clear that it is not better than `best`. The
    /// correspondences are taken `stride` apart from `start` on, a whole round when `stride` and their
    /// number have no common divisor.
    #[inline(never)]
    pub(super) fn score(
        &mut self,
        f: &Matrix3<T>,
        seen: &[Correspondence<T>],
        loss: Biweight<T>,
        best: T,
        (start, stride): (usize, usize),
    ) -> Option<Score<T>> {
        let mut score = Score { gain: T::ZERO, inliers: 0 };
        let (mut odds, most) = (T::ONE, T::of(DROP));
        let per_width = T::ONE / loss.width_squared;
        let mut at = start;
        let mut ahead = T::count(seen.len());
        for tried in 1..=seen.len() {
            let s = seen.get(at)?;
            at += stride;
            if at >= seen.len() {
                at -= seen.len();
            }
            ahead -= T::ONE;
            let (squared, steep) = sampson(f, s);
            if squared < steep * loss.width_squared {
                let (_, gain) = weight_and_gain(squared / steep * per_width);
                score.gain += gain;
                score.inliers += 1;
                odds *= self.inlier_ratio;
            } else {
                odds *= self.outlier_ratio;
                if odds > most || score.gain + ahead <= best {
                    self.chance.0 += T::count(score.inliers);
                    self.chance.1 += T::count(tried);
                    if odds > most {
                        self.update_ratios();
                    }
                    return None;
                }
            }
        }
        (score.gain > best).then_some(score)
    }
}

/// Sampson's distance squared as a fraction: `(p^T F p')^2` and what it is divided by.
#[inline(always)]
pub(super) fn sampson<T: Real>(f: &Matrix3<T>, s: &Correspondence<T>) -> (T, T) {
    let p = Vector3::new(s.first.x, s.first.y, T::ONE);
    let line = f * Vector3::new(s.second.x, s.second.y, T::ONE);
    let residual = p.dot(&line);
    let x = f.m11 * p.x + f.m21 * p.y + f.m31;
    let y = f.m12 * p.x + f.m22 * p.y + f.m32;
    (residual * residual, line.x * line.x + line.y * line.y + x * x + y * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// F of a rectified pair: Sampson's distance is the difference of the rows over the root of two.
    const RECTIFIED: Matrix3<f64> = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    /// Up to 3 px, or 4.24 rows.
    const LOSS: Biweight<f64> = Biweight { width_squared: 9.0 };

    /// Matches whose rows differ by so much.
    fn off_by<const N: usize>(rows: [f64; N]) -> [Correspondence<f64>; N] {
        rows.map(|rows| Correspondence::new(rows * 10.0, 50.0, 30.0, 50.0 + rows))
    }

    #[test]
    fn the_distance_is_the_residual_over_its_gradient() {
        let f = Matrix3::new(0.1, -0.4, 2.0, 0.3, 0.2, -7.0, -3.0, 6.0, 5.0);
        let at = [31.0, -12.0, 25.0, 8.0];
        let residual = |[u, v, x, y]: [f64; 4]| (f * Vector3::new(x, y, 1.0)).dot(&Vector3::new(u, v, 1.0));
        let steep = (0..4).fold(0.0, |sum, k| {
            let moved = |by: f64| residual(core::array::from_fn(|i| at[i] + if i == k { by } else { 0.0 }));
            let slope = (moved(0.5) - moved(-0.5)) / 1.0;
            sum + slope * slope
        });
        let (squared, divisor) = sampson(&f, &Correspondence::new(at[0], at[1], at[2], at[3]));
        assert!((squared.sqrt() - residual(at).abs()).abs() < 1e-9 && (divisor - steep).abs() < 1e-9);
    }

    #[test]
    fn a_score_is_the_sum_of_the_gains_in_any_order() {
        let seen = off_by([0.0, 1.0, -2.0, 3.0, 9.0, -4.0, 4.25]);
        // Five of them within the width: (1 - rows^2 / 18)^3.
        let gain: f64 =
            [0.0, 1.0, 4.0, 9.0, 16.0].iter().map(|squared| (1.0 - squared / 18.0_f64).powi(3)).sum();
        for order in [(0, 1), (3, 1), (6, 2), (2, 5)] {
            let score = |best| Sprt::new().score(&RECTIFIED, &seen, LOSS, best, order);
            let found = score(0.0).expect("more than nothing");
            assert!((found.gain - gain).abs() < 1e-12 && found.inliers == 5, "{order:?}");
            assert!(score(gain - 1e-9).is_some() && score(gain + 1e-9).is_none(), "{order:?}");
        }
    }

    #[test]
    fn what_is_off_by_the_width_is_no_inlier() {
        let loss = Biweight { width_squared: 8.0 };
        let score = |rows: f64| {
            let seen = off_by([0.0, rows]);
            Sprt::new().score(&RECTIFIED, &seen, loss, 0.0, (0, 1)).expect("more than nothing").inliers
        };
        assert_eq!([3.99, 4.0, 4.01].map(score), [2, 1, 1]);
    }

    #[test]
    fn a_score_that_is_as_good_as_the_best_is_not_better() {
        let seen = off_by([0.0; 4]);
        let score = |best: f64| Sprt::new().score(&RECTIFIED, &seen, LOSS, best, (0, 1));
        assert!(score(3.999).is_some() && score(4.0).is_none());
        // With an outlier last, three gains cannot become more than three.
        let seen = off_by([0.0, 0.0, 0.0, 9.0]);
        let mut sprt = Sprt::new();
        assert!(sprt.score(&RECTIFIED, &seen, LOSS, 3.0, (0, 1)).is_none());
        assert_eq!((sprt.chance, sprt.bad), ((5.0, 44.0), 0.05), "it is counted, and nothing learnt of it");
    }

    #[test]
    fn odds_of_a_hundred_drop_an_estimate() {
        // Nine in ten agree with a good estimate and one in twenty with a bad one: an outlier makes a bad one
        // 9.5 times as likely, two of them 90 times, three more than a hundred times.
        let mut sprt = Sprt::new();
        sprt.learn(0.9);
        let two = [9.0, 9.0, 0.0, 9.0, 0.0, 9.0, 0.0, 0.0, 0.0, 0.0];
        let three = [9.0, 9.0, 9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert!(sprt.score(&RECTIFIED, &off_by(two), LOSS, 0.0, (0, 1)).is_some());
        assert!(sprt.score(&RECTIFIED, &off_by(three), LOSS, 0.0, (0, 1)).is_none());
        // The other way round there are inliers first.
        assert!(sprt.score(&RECTIFIED, &off_by(three), LOSS, 0.0, (9, 9)).is_some());
    }

    #[test]
    fn what_is_dropped_says_how_many_agree_with_a_bad_estimate() {
        let mut sprt = Sprt::new();
        sprt.learn(0.9);
        // Five that were tried, of which one agrees, besides two of forty.
        let seen = off_by([9.0, 9.0, 0.0, 9.0, 9.0, 9.0, 9.0, 9.0]);
        assert!(sprt.score(&RECTIFIED, &seen, LOSS, 0.0, (0, 1)).is_none());
        assert_eq!(sprt.chance, (3.0, 45.0));
        assert_eq!(sprt.bad, 3.0 / 45.0);
        // What cannot become better than the best is dropped, too: after three of four.
        let mut sprt = Sprt::new();
        assert!(sprt.score(&RECTIFIED, &off_by([0.0, 9.0, 9.0, 0.0]), LOSS, 2.0, (0, 1)).is_none());
        assert_eq!(sprt.chance, (3.0, 43.0));
    }

    #[test]
    fn nothing_is_dropped_where_bad_estimates_agree_as_often() {
        let mut sprt = Sprt::<f64>::new();
        // A twentieth, less than six fifths of which are no more.
        sprt.learn(0.059);
        assert_eq!((sprt.inlier_ratio, sprt.outlier_ratio), (1.0, 1.0));
        // Nor are six fifths of it.
        sprt.learn(0.06);
        assert_eq!((sprt.inlier_ratio, sprt.outlier_ratio), (1.0, 1.0));
        sprt.learn(0.061);
        assert!((sprt.inlier_ratio - 0.05 / 0.061).abs() < 1e-12);
        assert!((sprt.outlier_ratio - 0.95 / 0.939).abs() < 1e-12);
        sprt.learn(1.0);
        assert!((sprt.outlier_ratio - 950.0).abs() < 1e-9, "no estimate is sure");
    }
}
