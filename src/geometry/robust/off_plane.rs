//! What lies off a plane, and whether it agrees on an epipole or only seems to (a contrario; Moisan & Stival
//! 2004).

use super::plane::PlaneHomography;
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
    /// Squared distance from its epipolar line in the first image up to which a correspondence agrees, px^2:
    /// twice Sampson's squared distance.
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

/// Margin, in nats, by which the evidence must exceed the logarithm of the number of pairs tried.
const SURE: f64 = 7.0;

impl<'a, T: Real> OffPlanes<'a, T> {
    /// What is farther from the plane than `least_px2` px squared; up to `agreeing_px2` from a line agrees.
    #[inline(never)]
    pub(super) fn of(
        plane: &PlaneHomography<T>,
        seen: &'a [Correspondence<T>],
        least_px2: T,
        agreeing_px2: T,
    ) -> Self {
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
    plane: &PlaneHomography<T>,
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
    use crate::geometry::linear::skew;
    use core::f64::consts::FRAC_2_PI;

    /// A plane far away that both images show at the same places, for cameras with that epipole.
    fn far_away(epipole: &Vector3<f64>) -> PlaneHomography<f64> {
        let at = |x: f64, y: f64| Correspondence::new(x, y, x, y);
        PlaneHomography::through(&skew(epipole), [at(0.0, 0.0), at(10.0, 0.0), at(0.0, 10.0)])
            .expect("an epipole")
    }

    /// Cameras side by side: all numbers of its plane are whole.
    fn beside() -> (Vector3<f64>, PlaneHomography<f64>) {
        (Vector3::x(), far_away(&Vector3::x()))
    }

    /// A camera that has moved towards what is seen at (300, -200), and matches with parallaxes along their
    /// lines and up to so many px across them.
    fn forwards<const N: usize>(
        across: f64,
    ) -> (Vector3<f64>, PlaneHomography<f64>, [Correspondence<f64>; N]) {
        let epipole = Vector3::new(300.0, -200.0, 1.0);
        let seen = core::array::from_fn(|i| {
            let on = Point2::new((i * 37 % 11) as f64 * 20.0, (i * 53 % 13) as f64 * 15.0);
            let along = (epipole.xy() - on.coords).normalize();
            let parallax = (1.1 + (i % 3) as f64 * 0.2) * f64::powi(2.0, i as i32 % 10 - 1);
            let off = across * ((i % 7) as f64 - 3.0) / 3.0;
            let to = on + along * parallax + nalgebra::Vector2::new(-along.y, along.x) * off;
            Correspondence { first: to, second: on }
        });
        (epipole, far_away(&epipole), seen)
    }

    /// Counts of what is farther than the root of `least` px from where the plane far away shows it: all,
    /// what agrees, and what would by chance, of those within the root of `agreeing` px of their lines.
    fn counted(
        seen: &[Correspondence<f64>],
        (least, agreeing): (f64, f64),
        agrees: impl Fn(&Correspondence<f64>) -> bool,
    ) -> [(f64, f64, f64); OCTAVES] {
        let mut counts = [(0.0, 0.0, 0.0); OCTAVES];
        for s in seen {
            let parallax = (s.first - s.second).norm();
            if parallax * parallax > least {
                let octave = (parallax / least.sqrt()).log2().floor() as usize;
                let (all, agree, chance) = &mut counts[octave.min(OCTAVES - 1)];
                let x = (agreeing.sqrt() / parallax).min(1.0);
                *all += 1.0;
                *chance += x * FRAC_2_PI + (1.0 - FRAC_2_PI) * x.powi(3);
                *agree += f64::from(u8::from(agrees(s)));
            }
        }
        counts
    }

    /// Whether the octaves are those, and as many agree as in all of them.
    fn assert_counts(octaves: &Octaves<f64>, expected: &[(f64, f64, f64); OCTAVES]) {
        for (found, expected) in octaves.counts.iter().zip(expected) {
            assert_eq!((found.0, found.1), (expected.0, expected.1), "{:?} {expected:?}", octaves.counts);
            assert!((found.2 - expected.2).abs() < 1e-9, "{found:?} {expected:?}");
        }
        let (all, agree) = expected.iter().fold((0.0, 0.0), |(a, b), counts| (a + counts.0, b + counts.1));
        assert_eq!(octaves.agree() as f64, agree);
        assert!(expected.iter().all(|counts| counts.1 > 0.0) && agree < 0.6 * all, "{expected:?}");
    }

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

    #[test]
    fn an_octave_begins_where_the_parallax_doubles() {
        for octave in 1..OCTAVES {
            // Twice the parallax is four times its square.
            let begin = 3.0 * f64::powi(4.0, octave as i32);
            assert_eq!([begin * 0.999, begin].map(|px2| Octaves::of(px2, 3.0)), [octave - 1, octave]);
        }
        // The last one has no end.
        for octave in OCTAVES..OCTAVES + 4 {
            assert_eq!(Octaves::of(3.5 * f64::powi(4.0, octave as i32), 3.0), OCTAVES - 1);
        }
    }

    #[test]
    fn chance_is_an_angle_in_any_direction() {
        let mut octaves = Octaves::<f64>::NONE;
        // Within half of its parallax of a line: of all directions those within 30 degrees, a third.
        octaves.count(5, 16.0, 4.0);
        let half = 0.5 * FRAC_2_PI + (1.0 - FRAC_2_PI) / 8.0;
        assert_eq!(octaves.counts[5], (1.0, 0.0, half));
        assert!(half > 1.0 / 3.0 && half < 0.37, "a little more than a third: {half}");
        // All directions, where the distance is more than the parallax.
        octaves.count(5, 16.0, 20.0);
        assert_eq!((octaves.counts[5].0, octaves.counts[5].2), (2.0, half + 1.0));
        octaves.agrees(5);
        octaves.agrees(5);
        octaves.agrees(3);
        assert_eq!((octaves.counts[5].1, octaves.counts[3].1, octaves.agree()), (2.0, 1.0, 3));
    }

    #[test]
    fn octaves_say_something_where_more_agree_than_by_chance() {
        let evidence = |counts: &[(f64, f64, f64)]| {
            let mut octaves = Octaves::<f64>::NONE;
            octaves.counts[..counts.len()].copy_from_slice(counts);
            octaves.agree = counts.iter().map(|counts| counts.1 as usize).sum();
            octaves.evidence()
        };
        // All agree: 10 ln (1 / 0.1), of which two made the estimate.
        let all = 10.0 * 10.0_f64.ln();
        assert!((evidence(&[(10.0, 10.0, 1.0)]) - all * 0.8).abs() < 1e-12);
        // Two octaves add up, one with fewer than by chance counts for what made the estimate alone.
        let most = 10.0 * (0.8 * 8.0_f64.ln() + 0.2 * (0.2_f64 / 0.9).ln());
        let found = evidence(&[(10.0, 10.0, 1.0), (10.0, 8.0, 1.0), (20.0, 2.0, 6.0)]);
        assert!((found - (all + most) * 18.0 / 20.0).abs() < 1e-12, "{found}");
        // What never happens by chance is as good as once in a million times.
        assert!((evidence(&[(5.0, 5.0, 0.0)]) - 5.0 * 1e6_f64.ln() * 0.6).abs() < 1e-9);
        // One that agrees made nothing, no more than two.
        assert_eq!([evidence(&[(1.0, 1.0, 0.1)]), evidence(&[])], [0.0, 0.0]);
    }

    #[test]
    fn it_is_sure_when_the_best_of_all_pairs_is_not_as_good_by_chance() {
        // 30 in two octaves, of which 20 agree, more or less probably so.
        let (mut sure, mut unsure) = (0, 0);
        for step in 0..1000 {
            let chance = f64::from(step) * 0.01;
            let mut octaves = Octaves::<f64>::NONE;
            (octaves.counts[1], octaves.counts[4]) = ((15.0, 10.0, chance), (15.0, 10.0, chance));
            octaves.agree = 20;
            let expected = octaves.evidence() > 2.0 * 31.0_f64.ln() + 7.0;
            assert_eq!(octaves.is_sure(), expected, "{chance}: {}", octaves.evidence());
            if expected { sure += 1 } else { unsure += 1 }
        }
        assert!(sure > 100 && unsure > 100, "{sure} {unsure}");
    }

    #[test]
    fn what_is_off_a_plane_is_counted_by_its_parallax() {
        let (epipole, plane, seen) = forwards::<90>(5.0);
        let off = OffPlanes::of(&plane, &seen, 2.0, 4.0);
        let line = |s: &Correspondence<f64>| s.second - Point2::new(300.0, -200.0);
        let agrees = |s: &Correspondence<f64>| line(s).normalize().perp(&(s.first - s.second)).abs() < 2.0;
        let expected = counted(&seen, (2.0, 4.0), agrees);
        assert_eq!(off.len() as f64, expected.iter().map(|counts| counts.0).sum::<f64>());
        // The size and the sign of an epipole say nothing.
        for size in [1.0, -3.0, 0.01] {
            assert_counts(&off.agreeing_with(&(epipole * size)), &expected);
        }
    }

    #[test]
    fn what_is_off_a_plane_agrees_with_a_matrix() {
        let (epipole, plane, mut seen) = forwards::<90>(5.0);
        // A place that is too far away to be squared is left out.
        seen[4].second.x = 1e200;
        let f = skew(&epipole);
        let agrees = |s: &Correspondence<f64>| {
            let (squared, steep) = crate::geometry::robust::sprt::sampson(&f, s);
            squared / steep < 2.0
        };
        let expected = counted(&[&seen[..4], &seen[5..]].concat(), (2.0, 4.0), agrees);
        assert_counts(&agreeing_with(&f, &plane, &seen, 2.0, 2.0), &expected);
    }

    #[test]
    fn what_lies_on_a_limit_is_on_the_plane_and_off_the_line() {
        let (epipole, plane) = beside();
        // Off to the side by 2 and 3 px, and 2 and 1 px off the line.
        let seen = [(2.0, 0.0), (3.0, 2.0), (3.0, 1.0)].map(|(u, v)| Correspondence::new(u, v, 0.0, 0.0));
        let off = OffPlanes::of(&plane, &seen, 4.0, 4.0);
        assert_eq!((off.len(), off.agreeing_with(&epipole).agree()), (2, 1));
        // Sampson's distance is half of that, squared.
        let octaves = agreeing_with(&skew(&epipole), &plane, &seen, 4.0, 2.0);
        assert_eq!((octaves.counts[0].0, octaves.agree()), (2.0, 1));
    }

    #[test]
    fn every_other_or_every_third_is_held_of_many() {
        let (_, plane) = beside();
        let seen: [_; 300] = core::array::from_fn(|i| Correspondence::new(9.0, i as f64, 0.0, i as f64));
        let held = |count: usize| OffPlanes::of(&plane, &seen[..count], 4.0, 4.0).len();
        assert_eq!([0, 1, 128, 129, 256, 257, 300].map(held), [0, 1, 128, 65, 128, 86, 100]);
        // What has no finite parallax is not held.
        let far = [Correspondence::new(0.0, 0.0, 1e200, 0.0), seen[0]];
        assert_eq!(OffPlanes::of(&plane, &far, 4.0, 4.0).len(), 1);
    }

    #[test]
    fn two_off_a_plane_have_an_epipole() {
        let (epipole, plane, seen) = forwards::<20>(0.0);
        let off = OffPlanes::of(&plane, &seen, 1.0, 2.0);
        let mut pairs = 0;
        for (one, two) in (0..off.len()).flat_map(|one| (0..one).map(move |two| (one, two))) {
            let Some(found) = off.epipole(one, two) else { continue };
            assert!((found.norm() - 1.0).abs() < 1e-12, "{found}");
            // Lines that meet at a blunt angle say where.
            let [a, b] = [one, two].map(|at| (off.points[at].on_plane.coords - epipole.xy()).normalize());
            if a.perp(&b).abs() > 0.3 {
                let there = Point2::from_homogeneous(found).expect("no point at infinity");
                assert!((there.coords - epipole.xy()).norm() < 1e-6, "{there}");
                pairs += 1;
            }
        }
        assert!(pairs > 20, "{pairs}");
        assert!(off.epipole(3, 3).is_none() && off.epipole(0, off.len()).is_none());
    }
}
