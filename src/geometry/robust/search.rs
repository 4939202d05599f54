//! The loop over samples.

use super::config::RobustConfig;
use super::factored::Factored;
use super::frame::Frame;
use super::loss::Loss;
use super::plane::{Plane, one_sense};
use super::prosac::{MINIMUM, Pool, Sample};
use super::refine::{Matrix, refine};
use super::sprt::{Test, Worth};
use crate::geometry::Real;
use crate::geometry::linear::product;
use crate::geometry::two_view::{Correspondence, seven_point};
use nalgebra::{Matrix3, Point2};

/// What a candidate has to be worth to be refined, over the best candidate before it: refined ones end in
/// different minima, and the best candidate's need not be the best.
const NEARLY: f64 = 0.7;
/// How many correspondences refine an estimate on the way.
pub(super) const ENOUGH: usize = 150;
/// Samples that are drawn at least.
const FEWEST: u32 = 16;

/// The best estimate so far and how it was come by.
pub(super) struct Search<'a, T: Real> {
    pub(super) seen: &'a [Correspondence<T>],
    pub(super) frames: [Frame<T>; 2],
    pub(super) loss: Loss<T>,
    pub(super) pool: Pool,
    pub(super) test: Test<T>,
    stride: usize,
    /// What the best candidate was worth before it was refined.
    raw_gain: T,
    pub(super) best: Option<Factored<T>>,
    pub(super) worth: Worth<T>,
    /// Samples drawn.
    pub(super) drawn: u32,
    /// The probability that a better estimate was missed.
    pub(super) missed: T,
}

impl<'a, T: Real> Search<'a, T> {
    /// Eight correspondences at least.
    pub(super) fn new(
        seen: &'a [Correspondence<T>],
        frames: [Frame<T>; 2],
        config: &RobustConfig<T>,
    ) -> Self {
        Self {
            seen,
            frames,
            loss: Loss::new(config.threshold_px),
            pool: Pool::new(config.sampling, config.seed, seen.len()),
            test: Test::new(),
            stride: stride(seen.len()),
            raw_gain: T::ZERO,
            best: None,
            worth: Worth { gain: T::ZERO, kept: 0 },
            drawn: 0,
            missed: T::ONE,
        }
    }

    /// Draws samples until a better estimate is as unlikely as asked, or their number is.
    pub(super) fn run(&mut self, config: &RobustConfig<T>) {
        while self.drawn < config.most_samples
            && (self.drawn < FEWEST || self.missed > config.miss_probability)
        {
            let sample = self.pool.next(self.drawn);
            self.drawn += 1;
            self.try_sample(&sample);
            self.missed = self.miss();
        }
    }

    /// `(1 - w^7)^k`: the probability that none of k samples held correspondences of the best estimate alone,
    /// w being their share.
    fn miss(&self) -> T {
        let (mut kept, mut all, mut all_good) =
            (T::count(self.worth.kept), T::count(self.seen.len()), T::ONE);
        for _ in 0..MINIMUM {
            all_good *= kept.max(T::ZERO) / all;
            (kept, all) = (kept - T::ONE, all - T::ONE);
        }
        // A good estimate is dropped unseen once in a hundred times.
        let (mut base, mut missed, mut left) = (T::ONE - all_good * T::of(0.99), T::ONE, self.drawn);
        while left > 0 {
            if left & 1 == 1 {
                missed *= base;
            }
            base *= base;
            left >>= 1;
        }
        missed
    }

    fn try_sample(&mut self, places: &Sample) {
        let Some(sample) = self.at(places) else { return };
        let [first, second] = self.frames;
        let normalised: [(Point2<T>, Point2<T>); MINIMUM] =
            sample.map(|s| (first.apply(s.first), second.apply(s.second)));
        for candidate in &seven_point(&normalised) {
            let f = self.in_pixels(candidate);
            if !one_sense(&f, &sample) || !self.consider(&f) {
                continue;
            }
            if let Some(plane) = Plane::of_sample(&f, &sample, self.on_plane_px2()) {
                self.leave(&plane);
            }
        }
    }

    /// The correspondences at those places.
    fn at(&self, places: &Sample) -> Option<[Correspondence<T>; MINIMUM]> {
        let mut sample = [*self.seen.first()?; MINIMUM];
        for (slot, &place) in sample.iter_mut().zip(places) {
            *slot = *self.seen.get(place)?;
        }
        Some(sample)
    }

    /// From the frames to px.
    pub(super) fn in_pixels(&self, f: &Matrix3<T>) -> Matrix3<T> {
        let f = product(&product(&self.frames[0].matrix().transpose(), f), &self.frames[1].matrix());
        f / f.norm()
    }

    /// Where an evaluation of the correspondences begins, and the step by which it goes on.
    pub(super) fn order(&mut self) -> (usize, usize) {
        (self.pool.below(self.seen.len()), self.stride)
    }

    /// Makes an estimate (px) the best one, after it was refined, when it is better than that before; whether
    /// it is.
    fn consider(&mut self, f: &Matrix3<T>) -> bool {
        let order = self.order();
        let Some(worth) = self.test.judge(f, self.seen, self.loss, self.raw_gain * T::of(NEARLY), order)
        else {
            return false;
        };
        self.raw_gain = self.raw_gain.max(worth.gain);
        self.test.learn(T::count(worth.kept) / T::count(self.seen.len()));
        self.improve(f)
    }

    /// Refines an estimate (px) and makes it the best one if it is then; whether it is.
    pub(super) fn improve(&mut self, f: &Matrix3<T>) -> bool {
        let in_frames =
            product(&product(&self.frames[0].inverse().transpose(), f), &self.frames[1].inverse());
        let Some(mut refined) = Factored::new(&in_frames) else { return false };
        // From far to near: what a sample of seven makes of its noise is a few thresholds off elsewhere. Some
        // of the correspondences are enough for that: the last estimate is refined by all.
        let every = self.seen.len() / ENOUGH;
        for (wider, steps) in [(T::of(2.5), 3), (T::ONE, 3)] {
            let loss = self.loss.widened(wider);
            (refined, _) =
                refine(refined, Matrix::Fundamental, self.seen, &self.frames, loss, (every, steps));
        }
        let (f, order) = (self.in_pixels(&refined.matrix()), self.order());
        // Without a best one nothing is dropped.
        let Some(worth) = Test::new().judge(&f, self.seen, self.loss, self.worth.gain, order) else {
            return false;
        };
        (self.best, self.worth) = (Some(refined), worth);
        true
    }
}

/// A step near the golden ratio of `n` that meets all numbers below `n` before it meets one again.
fn stride(n: usize) -> usize {
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
    use super::stride;

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
