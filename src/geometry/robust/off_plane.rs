//! What lies off a plane, and whether it agrees on an epipole or only seems to (a contrario; Moisan & Stival
//! 2004).

use super::plane::Plane;
use crate::geometry::Real;
use crate::geometry::two_view::Correspondence;
use nalgebra::{Matrix3, Point2, Vector3};

/// Correspondences off a plane that are held at most; of more every other one, or every third, and so on.
pub(super) const MOST: usize = 128;

/// Octaves of the parallax that are counted apart: from the least that is off the plane to 256 times as much.
const OCTAVES: usize = 8;

/// A correspondence off a plane.
struct OffPlane<'a, T: Real> {
    seen: &'a Correspondence<T>,
    /// Where the plane would show it in the first image.
    on_plane: Point2<T>,
}

impl<T: Real> OffPlane<'_, T> {
    fn parallax_px2(&self) -> T {
        (self.seen.first - self.on_plane).norm_squared()
    }
}

/// Correspondences off one plane.
pub(super) struct OffPlanes<'a, T: Real> {
    points: heapless::Vec<OffPlane<'a, T>, MOST>,
    /// The squared distance from the plane from which on a correspondence is off it, px^2.
    least_px2: T,
    /// Twice the squared distance from its epipolar line at which a correspondence still agrees, px^2: half
    /// of an offset in one image is Sampson's distance.
    agreeing_px2: T,
    /// Counts of all, without those that agree with an estimate.
    all: Octaves<T>,
}

/// How many correspondences of each octave of parallax there are, agree, and would agree by chance.
#[derive(Clone, Copy)]
pub(super) struct Octaves<T: Real> {
    counts: [(T, T, T); OCTAVES],
    agree: usize,
}

impl<T: Real> Octaves<T> {
    const NONE: Self = Self { counts: [(T::ZERO, T::ZERO, T::ZERO); OCTAVES], agree: 0 };

    /// The octave of a squared parallax beside the least that is off the plane, both px^2.
    fn of(parallax_px2: T, least_px2: T) -> usize {
        let mut limit = least_px2 * T::of(4.0);
        for octave in 0..OCTAVES - 1 {
            if parallax_px2 < limit {
                return octave;
            }
            limit *= T::of(4.0);
        }
        OCTAVES - 1
    }

    /// Counts a correspondence of a squared parallax: what is off the plane by noise or by a wrong match is
    /// so in any direction, and within an angle of `asin(distance / parallax)` of the line with the
    /// probability `2 asin(..) / pi`, or a little less than is taken here.
    fn count(&mut self, octave: usize, parallax_px2: T, agreeing_px2: T) {
        let x = (agreeing_px2 / parallax_px2).sqrt().min(T::ONE);
        let slope = T::of(core::f64::consts::FRAC_2_PI);
        let chance = x * (slope + (T::ONE - slope) * x * x);
        if let Some((all, _, expected)) = self.counts.get_mut(octave) {
            *all += T::ONE;
            *expected += chance;
        }
    }

    fn agrees(&mut self, octave: usize) {
        if let Some((_, agree, _)) = self.counts.get_mut(octave) {
            *agree += T::ONE;
            self.agree += 1;
        }
    }

    /// How many agree.
    pub(super) fn agree(&self) -> usize {
        self.agree
    }

    /// The logarithm of how improbable it is, at most, that so many agree by chance: the sum of `n KL(k/n,
    /// p)` over octaves in which more of n agree than the share p that chance explains (Chernoff's bound). A
    /// sure octave does not vouch for all: the count of the two that made the epipole is taken off.
    pub(super) fn evidence(&self) -> T {
        let least = T::of(1e-6);
        let sum = self.counts.iter().fold(T::ZERO, |sum, &(all, agree, expected)| {
            if !(agree > expected && all > T::ZERO) {
                return sum;
            }
            let (share, chance) = (agree / all, (expected / all).max(least));
            let others = T::ONE - share;
            let rest =
                if others > least { others * (others / (T::ONE - chance).max(least)).ln() } else { T::ZERO };
            sum + all * (share * (share / chance).ln() + rest)
        });
        let free = T::of(2.0);
        let agree = T::count(self.agree).max(free);
        sum * (agree - free) / agree
    }

    /// Whether so much evidence is more than the best of all pairs of so many correspondences has by chance.
    pub(super) fn is_sure(&self) -> bool {
        let all = self.counts.iter().fold(T::ONE, |sum, &(all, ..)| sum + all);
        self.evidence() > T::of(2.0) * all.ln() + T::of(SURE)
    }
}

/// What evidence has to be over the logarithm of how many estimates were tried.
const SURE: f64 = 7.0;

impl<'a, T: Real> OffPlanes<'a, T> {
    /// What is farther from the plane than `least_px2` px squared; up to `agreeing_px2` from a line agrees.
    #[inline(never)]
    pub(super) fn of(plane: &Plane<T>, seen: &'a [Correspondence<T>], least_px2: T, agreeing_px2: T) -> Self {
        let mut list = Self { points: heapless::Vec::new(), least_px2, agreeing_px2, all: Octaves::NONE };
        let off = |s: &&Correspondence<T>| plane.distance_squared_px2(s) > least_px2;
        let every = seen.iter().filter(off).count().div_ceil(MOST).max(1);
        for s in seen.iter().filter(off).step_by(every) {
            let there = plane.matrix * s.second.to_homogeneous();
            let on_plane = Point2::new(there.x / there.z, there.y / there.z);
            let point = OffPlane { seen: s, on_plane };
            let parallax_px2 = point.parallax_px2();
            if parallax_px2.is_finite() && list.points.push(point).is_ok() {
                list.all.count(Octaves::of(parallax_px2, least_px2), parallax_px2, agreeing_px2);
            }
        }
        list
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// The epipole in the first image that two of them have in common, if they have one.
    pub(super) fn epipole(&self, one: usize, two: usize) -> Option<Vector3<T>> {
        let line = |at: usize| {
            let point = self.points.get(at)?;
            Some(point.seen.first.to_homogeneous().cross(&point.on_plane.to_homogeneous()).normalize())
        };
        let epipole = line(one)?.cross(&line(two)?);
        let size = epipole.norm();
        (size > T::ZERO && size.is_finite()).then(|| epipole / size)
    }

    /// Which of them agree with an epipole in the first image.
    #[inline(never)]
    pub(super) fn agreeing_with(&self, epipole: &Vector3<T>) -> Octaves<T> {
        let mut octaves = self.all;
        for point in &self.points {
            let (on, seen) = (point.on_plane, point.seen.first);
            // The line from the epipole through the place on the plane.
            let (a, b) = (epipole.y - epipole.z * on.y, epipole.z * on.x - epipole.x);
            let off = a * (seen.x - on.x) + b * (seen.y - on.y);
            if off * off < (a * a + b * b) * self.agreeing_px2 {
                octaves.agrees(Octaves::of(point.parallax_px2(), self.least_px2));
            }
        }
        octaves
    }
}

/// How much of what is off a plane agrees with an estimate F (px); see [`OffPlanes::of`].
#[inline(never)]
pub(super) fn agreeing_with<T: Real>(
    f: &Matrix3<T>,
    plane: &Plane<T>,
    seen: &[Correspondence<T>],
    least_px2: T,
    width_px2: T,
) -> Octaves<T> {
    let mut octaves = Octaves::NONE;
    for s in seen {
        let parallax_px2 = plane.distance_squared_px2(s);
        if !(parallax_px2 > least_px2 && parallax_px2.is_finite()) {
            continue;
        }
        let octave = Octaves::of(parallax_px2, least_px2);
        octaves.count(octave, parallax_px2, width_px2 * T::of(2.0));
        let (squared, steep) = super::sprt::sampson(f, s);
        if squared < steep * width_px2 {
            octaves.agrees(octave);
        }
    }
    octaves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worked_by_hand() {
        // 8 of 10 where chance has 1: 10 (.8 ln 8 + .2 ln (.2 / .9)), of which two made the estimate.
        let mut octaves = Octaves::<f64>::NONE;
        octaves.counts[2] = (10.0, 8.0, 1.0);
        octaves.agree = 8;
        let expected = 10.0 * (0.8 * 8.0_f64.ln() + 0.2 * (0.2_f64 / 0.9).ln()) * 6.0 / 8.0;
        assert!((octaves.evidence() - expected).abs() < 1e-12, "{} {expected}", octaves.evidence());
        assert!(!octaves.is_sure());
        (octaves.counts[2], octaves.agree) = ((20.0, 16.0, 2.0), 16);
        assert!(octaves.is_sure());
        // As many as by chance say nothing, and two alone made what they agree with.
        octaves.counts[2] = (10.0, 1.0, 1.0);
        assert_eq!(octaves.evidence(), 0.0);
        (octaves.counts[2], octaves.agree) = ((2.0, 2.0, 0.1), 2);
        assert!(octaves.evidence() == 0.0 && !octaves.is_sure());
        assert_eq!([1.0, 3.9, 4.1, 17.0, 1e9].map(|px2| Octaves::of(px2, 1.0)), [0, 0, 1, 2, OCTAVES - 1]);
    }
}
