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
