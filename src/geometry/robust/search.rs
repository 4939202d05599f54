//! DEGENSAC: the RANSAC search for F in scenes with a dominant plane (Chum, Werner & Matas 2005).

use super::config::RobustConfig;
use super::factored::Factored;
use super::frame::Frame;
use super::loss::Biweight;
use super::plane::{PlaneHomography, one_sense};
use super::prosac::Sampler;
use super::ransac::Estimator;
use super::refine::{Matrix, refine};
use super::sprt::{Score, Sprt};
use crate::geometry::Real;
use crate::geometry::linear::{columns3, product};
use crate::geometry::two_view::{Candidates, Correspondence, seven_point};
use nalgebra::{Matrix3, Point2};

/// Correspondences of a sample.
pub(super) const MINIMUM: usize = 7;

/// The gain that a candidate needs to be refined, over that of the best candidate before it: refined ones end
/// in different minima, and the best candidate's need not be the best.
const NEARLY: f64 = 0.7;
/// How many correspondences refine an estimate on the way.
pub(super) const ENOUGH: usize = 150;
/// Samples that are drawn at least.
const FEWEST: u32 = 16;

/// The best estimate so far and how it was come by, from samples of K.
pub(super) struct Search<'a, T: Real, const K: usize> {
    kind: Matrix,
    pub(super) seen: &'a [Correspondence<T>],
    pub(super) frames: [Frame<T>; 2],
    pub(super) loss: Biweight<T>,
    pub(super) sampler: Sampler<K>,
    sprt: Sprt<T>,
    stride: usize,
    miss_probability: T,
    /// The gain of the best candidate before it was refined.
    raw_gain: T,
    pub(super) best: Option<Factored<T>>,
    pub(super) score: Score<T>,
    /// The probability that a better estimate was missed.
    pub(super) missed: T,
}

impl<'a, T: Real, const K: usize> Search<'a, T, K> {
    /// More correspondences than a sample has.
    pub(super) fn new(
        kind: Matrix,
        seen: &'a [Correspondence<T>],
        frames: [Frame<T>; 2],
        config: &RobustConfig<T>,
    ) -> Self {
        Self {
            kind,
            seen,
            frames,
            loss: Biweight::new(config.threshold_px),
            sampler: Sampler::new(config.sampling, config.seed, seen.len()),
            sprt: Sprt::new(),
            stride: stride(seen.len()),
            miss_probability: config.miss_probability,
            raw_gain: T::ZERO,
            best: None,
            score: Score { gain: T::ZERO, inliers: 0 },
            missed: T::ONE,
        }
    }

    /// `(1 - w^K)^k`: the probability that none of k samples held correspondences of the best estimate alone,
    /// w being the share of those with a weight: also from beyond the threshold they lead to the estimate,
    /// for what a sample gives is refined.
    fn miss(&self, drawn: u32) -> T {
        let (mut kept, mut all, mut all_good) =
            (T::count(self.score.inliers), T::count(self.seen.len()), T::ONE);
        for _ in 0..K {
            all_good *= kept.max(T::ZERO) / all;
            (kept, all) = (kept - T::ONE, all - T::ONE);
        }
        // A good estimate is dropped unseen once in a hundred times.
        let (mut base, mut missed, mut left) = (T::ONE - all_good * T::of(0.99), T::ONE, drawn);
        while left > 0 {
            if left & 1 == 1 {
                missed *= base;
            }
            base *= base;
            left >>= 1;
        }
        missed
    }

    /// Whether a better estimate is as unlikely after `drawn` samples as was asked.
    pub(super) fn has_enough(&mut self, drawn: u32) -> bool {
        self.missed = self.miss(drawn);
        drawn >= FEWEST && !(self.missed > self.miss_probability)
    }

    /// The correspondences at those places.
    #[inline]
    pub(super) fn at(&self, places: &[usize; K]) -> [Correspondence<T>; K] {
        let none = Correspondence::new(T::ZERO, T::ZERO, T::ZERO, T::ZERO);
        places.map(|place| self.seen.get(place).copied().unwrap_or(none))
    }

    /// The pairs of points at those places, in the frames.
    #[inline]
    pub(super) fn normalised(&self, places: &[usize; K]) -> [(Point2<T>, Point2<T>); K] {
        let [first, second] = &self.frames;
        self.at(places).map(|s| (first.apply(s.first), second.apply(s.second)))
    }

    /// `M^T F M'`: from the frames to px, and of another size.
    #[inline(never)]
    pub(super) fn in_pixels(&self, f: &Matrix3<T>) -> Matrix3<T> {
        let [first, second] = &self.frames;
        let columns = columns3(f).map(|column| first.of_line(&column));
        let rows = columns3(&Matrix3::from_columns(&columns).transpose());
        let rows = rows.map(|row| second.of_line(&row));
        Matrix3::from_columns(&rows).transpose()
    }

    /// Where an evaluation of the correspondences begins, and the step by which it goes on.
    pub(super) fn order(&mut self) -> (usize, usize) {
        (self.sampler.below(self.seen.len()), self.stride)
    }

    /// Makes an estimate (px) the best one, after it was refined, when it is better than that before; whether
    /// it is.
    pub(super) fn compare(&mut self, f: &Matrix3<T>) -> bool {
        let order = self.order();
        let Some(score) = self.sprt.score(f, self.seen, self.loss, self.raw_gain * T::of(NEARLY), order)
        else {
            return false;
        };
        self.raw_gain = self.raw_gain.max(score.gain);
        self.sprt.learn(T::count(score.inliers) / T::count(self.seen.len()));
        self.improve(f)
    }

    /// Refines an estimate (px) and makes it the best one if it is then; whether it is.
    pub(super) fn improve(&mut self, f: &Matrix3<T>) -> bool {
        let in_frames =
            product(&product(&self.frames[0].inverse().transpose(), f), &self.frames[1].inverse());
        let Some(mut refined) = Factored::new(&in_frames) else { return false };
        if self.kind == Matrix::Essential {
            refined = refined.essential();
        }
        // From far to near: what a sample of seven makes of its noise is a few thresholds off elsewhere. Some
        // of the correspondences are enough for that: the last estimate is refined by all.
        let every = self.seen.len() / ENOUGH;
        for (wider, steps) in [(T::of(2.5), 3), (T::ONE, 3)] {
            let loss = self.loss.widened(wider);
            refined = refine(refined, self.kind, self.seen, &self.frames, loss, (every, steps));
        }
        let (f, order) = (self.in_pixels(&refined.matrix()), self.order());
        // Without a best one nothing is dropped.
        let Some(score) = Sprt::new().score(&f, self.seen, self.loss, self.score.gain, order) else {
            return false;
        };
        (self.best, self.score) = (Some(refined), score);
        true
    }
}

impl<T: Real> Estimator<MINIMUM> for Search<'_, T, MINIMUM> {
    type Model = Matrix3<T>;
    type Models = Candidates<T>;

    fn draw(&mut self, drawn: u32) -> [usize; MINIMUM] {
        self.sampler.next(drawn)
    }

    fn models(&self, sample: &[usize; MINIMUM]) -> Candidates<T> {
        seven_point(&self.normalised(sample))
    }

    fn consider(&mut self, model: &Matrix3<T>, sample: &[usize; MINIMUM]) {
        let sample = self.at(sample);
        let f = self.in_pixels(model);
        if !one_sense(&f, &sample) || !self.compare(&f) {
            return;
        }
        if let Some(plane) = PlaneHomography::of_sample(&f, &sample, self.on_plane_px2()) {
            self.leave(&plane);
        }
    }

    fn is_enough(&mut self, drawn: u32) -> bool {
        self.has_enough(drawn)
    }
}

/// A step near the golden ratio of `n` that meets all numbers below `n` before it meets one again.
pub(crate) fn stride(n: usize) -> usize {
    let start = (n as u64 * 159 / 257) as usize;
    (start.max(1)..n).find(|&stride| common_divisor(stride, n) == 1).unwrap_or(1)
}

fn common_divisor(mut a: usize, mut b: usize) -> usize {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;

    /// Matches of places that are on no line in either image.
    fn scattered() -> [Correspondence<f64>; 12] {
        core::array::from_fn(|i| {
            let (u, v) = ((i * 37 % 11) as f64 * 20.0, (i * 53 % 13) as f64 * 15.0);
            Correspondence::new(u, v, u - (i % 5) as f64, v + 40.0)
        })
    }

    fn search(seen: &[Correspondence<f64>]) -> Search<'_, f64, MINIMUM> {
        let frames = Frame::of_points(seen).expect("points that are apart");
        Search::new(Matrix::Fundamental, seen, frames, &RobustConfig::new(1.0))
    }

    #[test]
    fn a_miss_is_as_probable_as_that_all_samples_had_an_outlier() {
        let seen = scattered();
        let mut search = search(&seen);
        // Of 12 there are 10 inliers: seven of them in (10 .. 4) / (12 .. 6) of the samples.
        search.score.inliers = 10;
        let all_good = (5.0 * 4.0) / (12.0 * 11.0) * 0.99;
        for drawn in [0, 1, 2, 5, 16, 37] {
            let expected = (1.0_f64 - all_good).powi(drawn);
            assert!((search.miss(drawn as u32) - expected).abs() < 1e-12, "{drawn}");
        }
        // The probability that is asked for is enough, after sixteen samples.
        search.miss_probability = search.miss(20);
        assert_eq!([19, 20, 21].map(|drawn| search.has_enough(drawn)), [false, true, true]);
        search.miss_probability = 0.999;
        assert_eq!([15, 16].map(|drawn| search.has_enough(drawn)), [false, true]);
        // With seven inliers of twelve one sample of all is theirs, with six none.
        search.score.inliers = 7;
        assert!((search.miss(1) - (1.0 - 0.99 / 792.0)).abs() < 1e-12);
        search.score.inliers = 6;
        assert_eq!(search.miss(9), 1.0);
    }

    #[test]
    fn a_matrix_of_the_frames_is_that_of_the_pixels() {
        let seen = scattered();
        let search = search(&seen);
        let f = Matrix3::new(0.1, -0.4, 2.0, 0.3, 0.2, -7.0, -3.0, 6.0, 5.0);
        let of_pixels = search.in_pixels(&f);
        for (s, (p, q)) in seen.iter().zip(search.normalised(&[0, 1, 2, 3, 4, 5, 6])) {
            let there = (f * q.to_homogeneous()).dot(&p.to_homogeneous());
            let here = (of_pixels * s.second.to_homogeneous()).dot(&s.first.to_homogeneous());
            assert!((there - here).abs() < 1e-9, "{there} {here}");
        }
    }

    /// Matches of a rectified pair, exact ones.
    fn rectified<const N: usize>() -> [Correspondence<f64>; N] {
        core::array::from_fn(|i| {
            let (u, v) = ((i * 37 % 11) as f64 * 20.0, (i * 53 % 13) as f64 * 15.0);
            Correspondence::new(u, v, u - 5.0 - (i * 7 % 9) as f64 * 4.0, v)
        })
    }

    /// F of a rectified pair whose second image is so many rows lower.
    fn lower(rows: f64) -> Matrix3<f64> {
        Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, rows)
    }

    /// How far a search's best estimate is from those of a rectified pair, in its elements.
    fn off(search: &Search<'_, f64, MINIMUM>) -> f64 {
        let f = search.in_pixels(&search.best.expect("an estimate").matrix());
        (f / f.m32 - lower(0.0)).amax()
    }

    /// How many random numbers a search with the seed 0 has taken, besides this one.
    fn taken(search: &mut Search<'_, f64, MINIMUM>) -> usize {
        let (next, mut random) = (search.sampler.below(1 << 31), Random::new(0));
        (0..100).find(|_| random.below(1 << 31) == next).expect("one of the first")
    }

    #[test]
    fn what_has_a_weight_counts_for_the_miss() {
        // Sampson's distance is the row's over the root of two; the threshold is 1.
        let mut seen = rectified::<20>();
        (0..6).for_each(|i| seen[i].second.y += 1.4 * 2.0_f64.sqrt());
        (6..9).for_each(|i| seen[i].second.y += 1.6 * 2.0_f64.sqrt());
        let mut search = search(&seen);
        let score = Sprt::new().score(&lower(0.0), &seen, search.loss, 0.0, (0, 1)).expect("a score");
        assert_eq!(score.inliers, 17);
        search.score = score;
        let all_good: f64 = (0..7).map(|i| (17.0 - f64::from(i)) / (20.0 - f64::from(i))).product();
        assert!((search.miss(1) - (1.0 - 0.99 * all_good)).abs() < 1e-12);
    }

    #[test]
    fn a_candidate_that_is_nearly_as_good_as_the_best_is_refined() {
        let seen = rectified::<20>();
        let mut search = search(&seen);
        assert!(search.compare(&lower(0.0)));
        assert!(off(&search) < 1e-9 && search.score.inliers == 20 && (search.score.gain - 20.0).abs() < 1e-9);
        // As good as can be.
        search.score.gain = 20.0;
        // An order for the candidate, and one for what is refined.
        assert_eq!(taken(&mut search), 2);
        // Of 20 that gain (1 - r^2 / 2 / 1.5^2)^3 each: 15.6 are more than 0.7 of 20, 12.6 are less.
        for (rows, orders) in [(0.6, 2), (0.8, 1)] {
            let before = taken(&mut search);
            assert!(!search.compare(&lower(rows)));
            // The number that is looked at is taken, too.
            assert_eq!(taken(&mut search) - before - 1, orders, "{rows}");
        }
        assert!(off(&search) < 1e-9, "the best stays");
    }

    #[test]
    fn the_test_of_candidates_learns_the_share_of_the_best() {
        // Twelve of twenty agree with the best, and one in twenty with a bad one: an outlier is 2.4 times as
        // likely with a bad one, an inlier 12 times as likely with a good one. Beside an estimate with six
        // outliers first, of which five are enough to drop it, is one with fewer.
        let mut seen = rectified::<20>();
        (0..8).for_each(|i| seen[i].second.y += 20.0 + (i * i) as f64 * 7.0);
        let mut search = search(&seen);
        assert!(search.compare(&lower(0.0)));
        assert_eq!(search.score.inliers, 12);
        let ratio = 0.95_f64 / 0.4;
        assert!(ratio.powi(5) < 100.0 && ratio.powi(6) > 100.0);
        for (outliers, is_dropped) in [(4, false), (6, true)] {
            let order: [_; 12] =
                core::array::from_fn(|i| seen[if i < outliers { i } else { i + 8 - outliers }]);
            let score = search.sprt.score(&lower(0.0), &order, search.loss, 0.0, (0, 1));
            assert_eq!(score.is_none(), is_dropped, "{outliers}");
        }
    }

    #[test]
    fn an_estimate_is_refined_from_afar_and_kept_if_it_is_better() {
        let seen = rectified::<20>();
        let mut search = search(&seen);
        let turned = lower(1.0) + Matrix3::new(1e-6, -2e-6, 1e-3, 2e-6, 1e-5, 0.01, 1e-3, -0.01, 0.3);
        assert!(search.improve(&turned));
        assert!(off(&search) < 1e-6 && search.score.inliers == 20, "{}", off(&search));
        // What no correspondence is near stays as bad.
        let best = search.best.expect("an estimate").matrix();
        assert!(!search.improve(&lower(500.0)) && !search.improve(&Matrix3::zeros()));
        assert!(search.best.expect("an estimate").matrix() == best && search.score.inliers == 20);
    }

    #[test]
    fn an_essential_matrix_stays_one() {
        // The second image is smaller, which is no motion of the camera: F has two singular values, which E
        // has not.
        let seen = rectified::<20>().map(|s| Correspondence { second: s.second * 0.8, ..s });
        let frames = Frame::of_points(&seen).expect("points that are apart");
        let f = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.2, 0.0);
        let values = |kind| {
            let mut search = Search::<f64, MINIMUM>::new(kind, &seen, frames, &RobustConfig::new(9.0));
            assert!(search.improve(&f));
            let best = search.best.expect("an estimate");
            best.s / best.c
        };
        assert_eq!(values(Matrix::Essential), 1.0);
        assert!((values(Matrix::Fundamental) - 0.8).abs() < 1e-6, "{}", values(Matrix::Fundamental));
    }

    #[test]
    fn a_stride_is_the_golden_share_of_a_round() {
        let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
        for n in 100..1000 {
            let share = stride(n) as f64 / n as f64;
            // A few more, until there is no common divisor.
            assert!((-0.01..0.1).contains(&(share - golden)), "{n}: {share}");
        }
        assert_eq!([1, 2, 3, 8, 9, 1000].map(stride), [1, 1, 1, 5, 5, 619]);
    }

    #[test]
    fn an_order_begins_anywhere() {
        let seen = rectified::<20>();
        let mut search = search(&seen);
        let mut starts = [false; 20];
        for _ in 0..200 {
            let (start, stride) = search.order();
            starts[start] = true;
            assert_eq!(stride, self::stride(20));
        }
        assert!(starts.iter().all(|&start| start));
    }

    #[test]
    fn a_round_meets_all() {
        for n in [1, 2, 8, 9, 10, 210, 1000, 1024] {
            let mut met = vec(n);
            (0..n).for_each(|i| met[i * stride(n) % n] = true);
            assert!(met[..n].iter().all(|&m| m), "{n}");
        }
    }

    fn vec(n: usize) -> [bool; 1024] {
        assert!(n <= 1024);
        [false; 1024]
    }
}
