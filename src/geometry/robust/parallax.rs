//! Plane and parallax: from a dominant plane to the rest of the scene (Chum, Werner & Matas 2005).

use super::plane::Plane;
use super::search::{ENOUGH, MINIMUM, Search};
use super::sprt::{Sprt, sampson};
use crate::geometry::Real;
use crate::geometry::two_view::Correspondence;
use nalgebra::Matrix3;

/// Pairs off a plane that are tried every time that an estimate lies on one.
const PAIRS: u32 = 100;
/// Triplets that are tried for a plane that the best estimate hides.
const TRIPLETS: u32 = 12;
/// What is as near to a plane as so many thresholds is on it.
const ON_PLANE: f64 = 2.0;

impl<T: Real> Search<'_, T, MINIMUM> {
    /// How near to a plane is on it, px squared.
    pub(super) fn on_plane_px2(&self) -> T {
        self.loss.width_squared * T::of(ON_PLANE * ON_PLANE)
    }

    /// The best of the estimates that a plane gives with two correspondences off it, if it is better than the
    /// best so far.
    pub(super) fn leave(&mut self, plane: &Plane<T>) {
        let px2 = self.on_plane_px2();
        let (plane, _) = plane.fitted(self.seen, &self.frames, px2);
        let (plane, _) = plane.fitted(self.seen, &self.frames, px2);
        let (mut best, mut gain) = (None, T::ZERO);
        for _ in 0..PAIRS {
            let (Some(one), Some(two)) = (self.off(&plane, px2), self.off(&plane, px2)) else { return };
            if one == two {
                continue;
            }
            let f = plane.with_parallax(&one, &two);
            let order = self.order();
            // The plane is in all of them: what distinguishes them is off it, which a wide loss sees better.
            let loss = self.loss.widened(T::of(ON_PLANE));
            if let Some(score) = Sprt::new().score(&f, self.seen, loss, gain, order) {
                (best, gain) = (Some(f), score.gain);
            }
        }
        if let Some(f) = best {
            self.improve(&f);
        }
    }

    /// A correspondence that is not on the plane, of the first few that chance finds.
    fn off(&mut self, plane: &Plane<T>, px2: T) -> Option<Correspondence<T>> {
        (0..PAIRS).find_map(|_| {
            let s = *self.seen.get(self.sampler.below(self.seen.len()))?;
            (plane.distance_squared_px2(&s) > px2).then_some(s)
        })
    }

    /// Tries whether most inliers of the best estimate are on one plane, and if so, leaves it; the plane,
    /// when there is nothing off it that the best estimate after that explains and chance does not.
    pub(super) fn only_plane(&mut self) -> Option<Plane<T>> {
        let px2 = self.on_plane_px2();
        let f = self.in_pixels(&self.best?.matrix());
        let (mut plane, mut most, every) = (None, 0, self.seen.len() / ENOUGH);
        for _ in 0..TRIPLETS {
            let [Some(a), Some(b), Some(c)] = [(); 3].map(|()| self.agreeing(&f)) else { continue };
            let Some(candidate) = Plane::through(&f, [a, b, c]) else { continue };
            let count = candidate.count(self.seen, every, px2);
            if count > most {
                (plane, most) = (Some(candidate), count);
            }
        }
        let (plane, most) = plane?.fitted(self.seen, &self.frames, px2);
        if 2 * most < self.score.inliers {
            return None;
        }
        self.leave(&plane);
        let f = self.in_pixels(&self.best?.matrix());
        let off = self.seen.iter().filter(|s| plane.distance_squared_px2(s) > px2);
        let all = off.clone().count();
        let kept = off.filter(|s| self.agrees(&f, s)).count();
        // Any two fit some F of the plane's family, and so do those that happen to lie on the lines of two:
        // bands as wide as the loss across a picture of about four units, times two.
        let by_chance = T::count(all) * self.loss.width_squared.sqrt() * self.frames[0].scale();
        (T::count(kept) <= T::count(MINIMUM) + by_chance).then_some(plane)
    }

    /// An inlier of an estimate, of the first few that chance finds.
    fn agreeing(&mut self, f: &Matrix3<T>) -> Option<Correspondence<T>> {
        (0..PAIRS).find_map(|_| {
            let s = *self.seen.get(self.sampler.below(self.seen.len()))?;
            self.agrees(f, &s).then_some(s)
        })
    }

    fn agrees(&self, f: &Matrix3<T>, s: &Correspondence<T>) -> bool {
        let (squared, steep) = sampson(f, s);
        squared < steep * self.loss.width_squared
    }
}
