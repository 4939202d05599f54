//! Plane and parallax: from a dominant plane to the rest of the scene (Chum, Werner & Matas 2005).

use super::off_plane::{Octaves, OffPlanes, agreeing_with};
use super::plane::Plane;
use super::search::{ENOUGH, MINIMUM, Search};
use super::sprt::sampson;
use crate::geometry::Real;
use crate::geometry::linear::{product, skew};
use crate::geometry::two_view::Correspondence;
use nalgebra::Matrix3;

/// Pairs off a plane that are tried at most every time that an estimate lies on one.
const PAIRS: u32 = 800;
/// How often a correspondence that agrees is looked for, of those that chance chooses.
const TRIES: u32 = 100;
/// The logarithm of the probability with which a better pair may be missed.
const MISSED: f64 = -4.6;
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
        let plane = self.fitted(plane);
        if let Some(f) = self.with_parallax(&plane) {
            self.improve(&f);
        }
    }

    /// The plane by all that is on it.
    fn fitted(&self, plane: &Plane<T>) -> Plane<T> {
        let px2 = self.on_plane_px2();
        let (plane, _) = plane.fitted(self.seen, &self.frames, px2);
        let (plane, _) = plane.fitted(self.seen, &self.frames, px2);
        plane
    }

    /// `F = [e]x H` (px) with the epipole e that what is off the plane H says is the most probable, of those
    /// of pairs: as many as it takes for a pair that agrees, [`PAIRS`] at most.
    fn with_parallax(&mut self, plane: &Plane<T>) -> Option<Matrix3<T>> {
        let px2 = self.on_plane_px2();
        // An epipole of two leaves the others wider off than one that is fitted to all.
        let off = OffPlanes::of(plane, self.seen, px2, px2 * T::of(2.0));
        if off.len() < 2 {
            return None;
        }
        let (mut best, mut evidence, mut enough) = (None, T::ZERO, T::count(PAIRS as usize));
        let mut tried = T::ZERO;
        while tried < enough {
            tried += T::ONE;
            let (one, two) = (self.sampler.below(off.len()), self.sampler.below(off.len()));
            let Some(epipole) = (one != two).then(|| off.epipole(one, two)).flatten() else { continue };
            let found = off.agreeing_with(&epipole);
            let of_this = found.evidence();
            if of_this > evidence {
                (best, evidence) = (Some(epipole), of_this);
                let share = T::count(found.agree()) / T::count(off.len());
                enough = enough.min(T::of(MISSED) / (T::ONE - share * share).max(T::EPSILON).ln());
            }
        }
        let f = product(&skew(&best?), &plane.matrix);
        Some(f / f.norm())
    }

    /// Tries whether most inliers of the best estimate are on one plane, and if so, completes it by what is
    /// off it; the plane, when what agrees off it may well do so by chance.
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
        let plane = self.fitted(&plane);
        let before = self.beside(&plane, &f);
        let (best, score) = (self.best, self.score);
        // What fits the noise of the plane best may have the larger gain: what is off the plane decides.
        self.score.gain = T::ZERO;
        let improved = self.with_parallax(&plane).is_some_and(|f| self.improve(&f));
        let f = self.in_pixels(&self.best?.matrix());
        let after = self.beside(&plane, &f);
        if improved && after.evidence() > before.evidence() {
            return (!after.is_sure()).then_some(plane);
        }
        (self.best, self.score) = (best, score);
        (!before.is_sure()).then_some(plane)
    }

    /// What is off a plane beside an estimate (px), within the width of the loss or within half of it, as the
    /// noise is: what says more.
    fn beside(&self, plane: &Plane<T>, f: &Matrix3<T>) -> Octaves<T> {
        let within = |width_px2: T| agreeing_with(f, plane, self.seen, self.on_plane_px2(), width_px2);
        let (wide, narrow) = (within(self.loss.width_squared), within(self.loss.width_squared * T::of(0.25)));
        if narrow.evidence() > wide.evidence() { narrow } else { wide }
    }

    /// An inlier of an estimate, of the first few that chance finds.
    fn agreeing(&mut self, f: &Matrix3<T>) -> Option<Correspondence<T>> {
        (0..TRIES).find_map(|_| {
            let s = *self.seen.get(self.sampler.below(self.seen.len()))?;
            self.agrees(f, &s).then_some(s)
        })
    }

    fn agrees(&self, f: &Matrix3<T>, s: &Correspondence<T>) -> bool {
        let (squared, steep) = sampson(f, s);
        squared < steep * self.loss.width_squared
    }
}
