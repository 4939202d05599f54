//! Whether an estimate is good, from as few correspondences as say so.

use super::loss::Loss;
use crate::geometry::Real;
use crate::geometry::two_view::Correspondence;
use nalgebra::{Matrix3, Vector3};

/// How many times as likely a bad estimate has to be as a good one to be dropped: of the good ones one in so
/// many is dropped at most.
const DROP: f64 = 100.0;

/// Wald's sequential test of estimates against the best so far (Matas & Chum 2005): correspondence after
/// correspondence the odds change by how often a good and a bad estimate keep one, and a bad one is dropped
/// after a few.
pub(super) struct Test<T: Real> {
    /// Shares of the correspondences that the best estimate keeps, and that a wrong one does.
    good: T,
    bad: T,
    /// What the odds are multiplied by when a correspondence is kept, and when not.
    kept: T,
    lost: T,
    /// Correspondences that dropped estimates have kept, and all that they were tried on.
    chance: (T, T),
}

/// What an estimate is worth.
#[derive(Clone, Copy)]
pub(super) struct Worth<T: Real> {
    /// The sum of the loss's gains.
    pub(super) gain: T,
    /// How many correspondences are within the loss's width.
    pub(super) kept: usize,
}

impl<T: Real> Test<T> {
    pub(super) fn new() -> Self {
        // Until something is known: nothing is dropped.
        let one = T::ONE;
        Self { good: T::ZERO, bad: T::of(0.05), kept: one, lost: one, chance: (T::of(2.0), T::of(40.0)) }
    }

    /// The best estimate keeps this share of the correspondences.
    pub(super) fn learn(&mut self, good: T) {
        self.good = good;
        self.settle();
    }

    fn settle(&mut self) {
        let (least, most) = (T::of(0.005), T::of(0.999));
        self.bad = (self.chance.0 / self.chance.1).max(least);
        let good = self.good.min(most);
        // Where chance keeps nearly as many as the best estimate, nothing can be told by counting.
        (self.kept, self.lost) = if good > self.bad * T::of(1.2) {
            (self.bad / good, (T::ONE - self.bad) / (T::ONE - good))
        } else {
            (T::ONE, T::ONE)
        };
    }

    /// What F (in px) is worth, or `None` as soon as it is clear that it is not better than `best`. The
    /// correspondences are taken `stride` apart from `start` on, a whole round when `stride` and their
    /// number have no common divisor.
    #[inline(never)]
    pub(super) fn judge(
        &mut self,
        f: &Matrix3<T>,
        seen: &[Correspondence<T>],
        loss: Loss<T>,
        best: T,
        (start, stride): (usize, usize),
    ) -> Option<Worth<T>> {
        let mut worth = Worth { gain: T::ZERO, kept: 0 };
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
                let left = T::ONE - squared / steep * per_width;
                worth.gain += left * left * left;
                worth.kept += 1;
                odds *= self.kept;
            } else {
                odds *= self.lost;
                if odds > most || worth.gain + ahead <= best {
                    self.chance.0 += T::count(worth.kept);
                    self.chance.1 += T::count(tried);
                    if odds > most {
                        self.settle();
                    }
                    return None;
                }
            }
        }
        (worth.gain > best).then_some(worth)
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
