//! PROSAC sampling (Chum & Matas 2005): the likely observations first, and uniform sampling.

use super::config::Sampling;
use super::random::Random;

/// Number of samples after which PROSAC draws as uniform RANSAC does: T_N of Chum & Matas (2005).
const GROWN: f32 = 10_000.0;

/// Draws samples of K observations: of all, or of a set of the first ones that grows (Chum & Matas 2005,
/// equations 2 to 4).
pub(super) struct Sampler<const K: usize> {
    random: Random,
    all: usize,
    /// How many from the front may be drawn.
    size: usize,
    /// Expected number, of `GROWN` samples of all observations, that lie in the sampling pool.
    inside: f32,
    /// Number of samples after which PROSAC enlarges its sampling pool (Chum & Matas 2005, eq. 3).
    due: u32,
}

impl<const K: usize> Sampler<K> {
    /// For `all` observations, more than K.
    pub(super) fn new(sampling: Sampling, seed: u64, all: usize) -> Self {
        let inside = (0..K).fold(GROWN, |product, i| product * (K - i) as f32 / (all - i) as f32);
        let size = if sampling == Sampling::Ordered { K } else { all };
        Self { random: Random::new(seed), all, size, inside, due: 1 }
    }

    /// The next sample, after `drawn` others: K different places.
    pub(super) fn next(&mut self, drawn: u32) -> [usize; K] {
        if self.size == self.all || drawn < self.due {
            return self.random.sample(self.size);
        }
        self.size += 1;
        let inside = self.inside * self.size as f32 / (self.size - K) as f32;
        let more = (inside - self.inside) as u32;
        (self.inside, self.due) = (inside, self.due.saturating_add(more.saturating_add(1)));
        // The newest has not been drawn yet: it is one of the K.
        let newest = self.size - 1;
        let mut sample: [usize; K] = self.random.sample(self.size);
        if let (false, Some(first)) = (sample.contains(&newest), sample.first_mut()) {
            *first = newest;
        }
        sample
    }

    /// A number below `n`.
    pub(super) fn below(&mut self, n: usize) -> usize {
        self.random.below(n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_are_drawn_first() {
        let mut sampler = Sampler::<7>::new(Sampling::Ordered, 1, 100);
        let mut first = sampler.next(0);
        first.sort_unstable();
        assert_eq!(first, [0, 1, 2, 3, 4, 5, 6]);
        for drawn in 1..20 {
            let sample = sampler.next(drawn);
            // Every sample so far has brought one new.
            assert!(
                sample.contains(&(6 + drawn as usize)) && sample.iter().all(|&i| i <= 6 + drawn as usize)
            );
        }
        (20..40_000).for_each(|drawn| {
            sampler.next(drawn);
        });
        assert_eq!(sampler.size, 100);
    }

    #[test]
    fn the_set_grows_as_the_equations_say() {
        // T_n samples of n, of ten thousand of all; one more as soon as they are drawn, rounded up.
        let of_all = |n: usize| (0..5).fold(1e4, |t, i| t * (n - i) as f64 / (60 - i) as f64);
        let mut sampler = Sampler::<5>::new(Sampling::Ordered, 7, 60);
        let (mut due, mut size) = (1.0, 5);
        for drawn in 0..12_000 {
            sampler.next(drawn);
            if sampler.size > size {
                // In f32, which rounds up to one more here and there.
                assert!((f64::from(drawn) - due).abs() <= 2.0, "{size}: {drawn} {due}");
                size += 1;
                due = f64::from(drawn) + (of_all(size) - of_all(size - 1)).floor() + 1.0;
            }
            assert_eq!(sampler.size, size);
        }
        assert_eq!(size, 60);
    }

    #[test]
    fn uniform_samples_are_of_all() {
        let mut sampler = Sampler::<3>::new(Sampling::Uniform, 7, 60);
        let mut seen = [false; 60];
        for drawn in 0..400 {
            sampler.next(drawn).iter().for_each(|&place| seen[place] = true);
        }
        assert!(seen.iter().all(|&seen| seen));
    }
}
