//! Plane and parallax: from a dominant plane to the rest of the scene (Chum, Werner & Matas 2005).

use super::off_plane::{Octaves, OffPlanes, agreeing_with};
use super::plane::PlaneHomography;
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
    pub(super) fn leave(&mut self, plane: &PlaneHomography<T>) {
        let plane = self.fitted(plane);
        if let Some(f) = self.with_parallax(&plane) {
            self.improve(&f);
        }
    }

    /// The plane by all that is on it.
    fn fitted(&self, plane: &PlaneHomography<T>) -> PlaneHomography<T> {
        let px2 = self.on_plane_px2();
        let (plane, _) = plane.fitted(self.seen, &self.frames, px2);
        let (plane, _) = plane.fitted(self.seen, &self.frames, px2);
        plane
    }

    /// `F = [e]x H` (px) with the epipole e that what is off the plane H says is the most probable, of those
    /// of pairs: as many as it takes for a pair that agrees, [`PAIRS`] at most.
    fn with_parallax(&mut self, plane: &PlaneHomography<T>) -> Option<Matrix3<T>> {
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
    pub(super) fn only_plane(&mut self) -> Option<PlaneHomography<T>> {
        let px2 = self.on_plane_px2();
        let f = self.in_pixels(&self.best?.matrix());
        let (mut plane, mut most, every) = (None, 0, self.seen.len() / ENOUGH);
        for _ in 0..TRIPLETS {
            let [Some(a), Some(b), Some(c)] = [(); 3].map(|()| self.agreeing(&f)) else { continue };
            let Some(candidate) = PlaneHomography::through(&f, [a, b, c]) else { continue };
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
    fn beside(&self, plane: &PlaneHomography<T>, f: &Matrix3<T>) -> Octaves<T> {
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

#[cfg(test)]
mod tests {
    use super::super::config::RobustConfig;
    use super::super::factored::Factored;
    use super::super::frame::Frame;
    use super::super::random::Random;
    use super::super::ransac::Estimator;
    use super::super::refine::Matrix;
    use super::super::sprt::Score;
    use super::*;
    use nalgebra::Vector3;

    /// The homography of a wall, and the epipole in the first image.
    fn wall() -> (Matrix3<f64>, Vector3<f64>) {
        (Matrix3::new(1.1, 0.02, 12.0, -0.03, 0.95, -7.0, 1e-4, -2e-4, 1.0), Vector3::new(0.9, 0.3, 2e-3))
    }

    /// F of that epipole or of another one, of size one.
    fn fundamental(epipole: &Vector3<f64>) -> Matrix3<f64> {
        let f = product(&skew(epipole), &wall().0);
        f / f.norm()
    }

    /// A match that is off the wall by `parallax` along its epipolar line, and by some px across it.
    fn seen(i: usize, parallax: f64, across: f64) -> Correspondence<f64> {
        let (h, epipole) = wall();
        let (x, y) = ((i * 37 % 11) as f64 * 20.0, ((7 * i + 3) * i % 13) as f64 * 15.0);
        let there = h * Vector3::new(x, y, 1.0) + epipole * parallax;
        Correspondence::new(there.x / there.z, there.y / there.z + across, x, y)
    }

    /// Sixty on the wall with noise of up to so many px, behind `OFF` that are off it; of these every
    /// `wrong`th by a wrong match.
    fn scene<const OFF: usize, const ALL: usize>(noise: f64, wrong: usize) -> [Correspondence<f64>; ALL] {
        core::array::from_fn(|i| match i.checked_sub(OFF) {
            Some(on) => seen(on, 0.0, noise * ((on * 7 % 11) as f64 - 5.0) / 5.0),
            None if i % wrong == wrong - 1 => seen(i + 60, 50.0, 30.0 + 40.0 * (i % 4) as f64),
            None => seen(i + 60, 25.0 + 6.0 * i as f64, 0.0),
        })
    }

    fn plane() -> PlaneHomography<f64> {
        let (_, epipole) = wall();
        PlaneHomography::through(&fundamental(&epipole), [0, 1, 2].map(|i| seen(i, 0.0, 0.0)))
            .expect("an epipole")
    }

    fn search(seen: &[Correspondence<f64>]) -> Search<'_, f64, MINIMUM> {
        let frames = Frame::of_points(seen).expect("points that are apart");
        Search::new(Matrix::Fundamental, seen, frames, &RobustConfig::new(1.0))
    }

    /// Takes an F in px for the best estimate, with so many inliers.
    fn believe(search: &mut Search<'_, f64, MINIMUM>, f: &Matrix3<f64>, inliers: usize) {
        let [first, second] = search.frames.each_ref().map(Frame::inverse);
        search.best = Factored::new(&product(&product(&first.transpose(), f), &second));
        search.score = Score { gain: 0.9 * inliers as f64, inliers };
    }

    /// How far a matrix is from F of the scene; the sign says nothing.
    fn off(f: &Matrix3<f64>) -> f64 {
        let truth = fundamental(&wall().1);
        let f = f / f.norm();
        (f - truth).amax().min((f + truth).amax())
    }

    /// How far exact matches off the wall are from the best estimate at most, px.
    fn error(search: &Search<'_, f64, MINIMUM>) -> f64 {
        let f = search.in_pixels(&search.best.expect("an estimate").matrix());
        let errors = (0..90).map(|i| {
            let (squared, steep) = sampson(&f, &seen(i, 15.0 + i as f64, 0.0));
            (squared / steep).sqrt()
        });
        errors.fold(0.0, f64::max)
    }

    /// How many random numbers a search with the seed 0 has taken, besides this one.
    fn taken(search: &mut Search<'_, f64, MINIMUM>) -> usize {
        let (next, mut random) = (search.sampler.below(1 << 31), Random::new(0));
        (0..5000).find(|_| random.below(1 << 31) == next).expect("one of the first")
    }

    #[test]
    fn what_is_off_the_wall_gives_the_epipole() {
        let seen = scene::<16, 76>(0.0, 99);
        let mut search = search(&seen);
        let f = search.with_parallax(&plane()).expect("pairs that agree");
        assert!((f.norm() - 1.0).abs() < 1e-12 && off(&f) < 1e-9, "{f}");
        // All agree with the first pair of two: that is enough.
        assert_eq!(taken(&mut search), 2);
        // Two alone agree with themselves, one is none: nothing is said, after all pairs that are allowed.
        for (count, pairs) in [(2, PAIRS), (1, 0), (0, 0)] {
            let mut search = self::search(&seen[16 - count..]);
            assert!(search.with_parallax(&plane()).is_none(), "{count}");
            assert_eq!(taken(&mut search), 2 * pairs as usize, "{count}");
        }
    }

    #[test]
    fn pairs_are_tried_until_one_of_two_that_agree_is_sure_to_be_there() {
        let seen = scene::<30, 90>(0.0, 3);
        let mut search = search(&seen);
        let f = search.with_parallax(&plane()).expect("pairs that agree");
        assert!(off(&f) < 1e-9, "{f}");
        let off = OffPlanes::of(&plane(), &seen, 9.0, 18.0);
        let share = off.agreeing_with(&wall().1).agree() as f64 / off.len() as f64;
        assert!(off.len() == 30 && share > 0.6 && share < 0.75, "{share}");
        // A hundredth is what all pairs miss.
        let pairs = (0..).find(|&pairs| (1.0 - share * share).powi(pairs) < (-4.6_f64).exp());
        assert_eq!(taken(&mut search), 2 * pairs.expect("enough pairs") as usize);
    }

    #[test]
    fn on_a_plane_is_what_is_two_widths_from_it() {
        let seen = scene::<16, 76>(0.0, 99);
        // One and a half thresholds of a pixel, twice.
        assert_eq!(search(&seen).on_plane_px2(), 9.0);
    }

    #[test]
    fn a_plane_is_left_for_the_scene() {
        let seen = scene::<16, 76>(0.5, 99);
        let mut search = search(&seen);
        search.leave(&plane());
        assert!(error(&search) < 0.5, "{}", error(&search));
        assert_eq!(search.score.inliers, 76);
    }

    #[test]
    fn a_sample_on_the_wall_leads_to_the_scene() {
        let seen = scene::<16, 76>(0.2, 99);
        let mut search = search(&seen);
        // Five of the sample are on the wall, and so an epipole elsewhere is as good.
        let f = fundamental(&Vector3::new(-0.2, 0.9, 1e-3));
        let [first, second] = search.frames.each_ref().map(Frame::inverse);
        let in_frames = product(&product(&first.transpose(), &f), &second);
        search.consider(&in_frames, &[20, 25, 33, 41, 50, 58, 70]);
        assert!(error(&search) < 0.5, "{}", error(&search));
        assert_eq!(search.score.inliers, 76);
        // What has passed the epipole was behind a camera in between: that is not even scored.
        let mut search = self::search(&seen);
        let wall = wall().0 * seen[15].second.to_homogeneous();
        let epipole = wall / wall.z + seen[15].first.to_homogeneous();
        let in_frames = product(&product(&first.transpose(), &fundamental(&epipole)), &second);
        search.consider(&in_frames, &[20, 25, 33, 41, 50, 58, 15]);
        assert!(search.best.is_none() && taken(&mut search) == 0);
    }

    #[test]
    fn what_is_off_the_wall_corrects_an_estimate_of_the_wall() {
        // An epipole elsewhere fits the wall, too, and some of the others by chance.
        let seen = scene::<16, 76>(0.2, 5);
        let mut search = search(&seen);
        believe(&mut search, &fundamental(&Vector3::new(-0.2, 0.9, 1e-3)), 60);
        assert!(search.only_plane().is_none());
        assert!(error(&search) < 0.5, "{}", error(&search));
        assert!(search.score.inliers >= 73, "{}", search.score.inliers);
    }

    #[test]
    fn a_wall_alone_is_the_answer_and_a_scene_is_none() {
        let seen = scene::<2, 62>(0.2, 99);
        let (truth, other) = (fundamental(&wall().1), fundamental(&Vector3::new(-0.2, 0.9, 1e-3)));
        for f in [&truth, &other] {
            let mut search = search(&seen);
            believe(&mut search, f, 62);
            let before = search.in_pixels(&search.best.expect("that one").matrix());
            let plane = search.only_plane().expect("two off a plane say nothing");
            assert!(seen[2..].iter().all(|s| plane.distance_squared_px2(s) < 0.1));
            // The estimate is as it was.
            let after = search.in_pixels(&search.best.expect("that one").matrix());
            assert_eq!((before, search.score.inliers), (after, 62));
        }
        // Half of the inliers are most of them, fewer are not.
        for (inliers, is_plane) in [(120, true), (121, false)] {
            let mut search = search(&seen[2..]);
            believe(&mut search, &truth, inliers);
            assert_eq!(search.only_plane().is_some(), is_plane, "{inliers}");
        }
    }

    #[test]
    fn an_estimate_with_which_enough_agrees_off_the_wall_stays() {
        let seen = scene::<16, 76>(0.2, 99);
        let mut search = search(&seen);
        believe(&mut search, &fundamental(&wall().1), 76);
        assert!(search.only_plane().is_none());
        assert!(error(&search) < 0.5, "{}", error(&search));
    }

    #[test]
    fn half_the_width_counts_where_it_says_more() {
        let f = fundamental(&wall().1);
        for (across, is_narrow) in [(0.3, true), (2.0, false)] {
            // All off the wall, and off their lines by up to so many px in the first image.
            let seen: [_; 40] = core::array::from_fn(|i| match i % 4 {
                0 => seen(i, 12.0, 40.0),
                1 => seen(i, 30.0, 0.7 * across),
                _ => seen(i, 20.0 + i as f64, across),
            });
            let search = search(&seen);
            let within = |width_px2: f64| agreeing_with(&f, &plane(), &seen, 9.0, width_px2);
            let [wide, narrow] = [2.25, 0.5625].map(within);
            assert_eq!(narrow.evidence() > wide.evidence(), is_narrow, "{across}");
            let expected = if is_narrow { narrow } else { wide };
            let found = search.beside(&plane(), &f);
            assert_eq!((found.agree(), found.evidence()), (expected.agree(), expected.evidence()));
        }
    }

    #[test]
    fn an_inlier_is_looked_for_among_all() {
        let f = fundamental(&wall().1);
        // One in ten is near its line.
        let seen: [_; 40] = core::array::from_fn(|i| seen(i, 5.0, if i % 10 == 3 { 0.5 } else { 20.0 }));
        let mut search = search(&seen);
        for _ in 0..20 {
            let found = search.agreeing(&f).expect("one in a hundred tries");
            assert!(seen.iter().skip(3).step_by(10).any(|s| *s == found));
        }
        let none: [_; 40] = core::array::from_fn(|i| self::seen(i, 5.0, 20.0));
        let mut search = self::search(&none);
        assert!(search.agreeing(&f).is_none());
        assert_eq!(taken(&mut search), TRIES as usize);
    }

    #[test]
    fn what_is_nearer_than_the_width_agrees() {
        // F of a rectified pair: half of the squared difference of the rows is the squared distance.
        let rectified = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
        let seen = scene::<16, 76>(0.0, 99);
        let mut search = search(&seen);
        search.loss.width_squared = 8.0;
        let agrees = |rows: f64| search.agrees(&rectified, &Correspondence::new(9.0, 5.0, 3.0, 5.0 + rows));
        assert_eq!([0.0, 3.9, -3.9, 4.0, 4.1].map(agrees), [true, true, true, false, false]);
    }
}
