//! Which correspondences a sample is drawn from.

use super::config::Sampling;
use super::random::Random;

/// Correspondences of a sample.
pub(super) const MINIMUM: usize = 7;

/// Places of a sample's correspondences.
pub(super) type Sample = [usize; MINIMUM];

/// After how many samples the pool of [`Sampling::Ordered`] would be as likely drawn as one of all.
const GROWN: f32 = 10_000.0;

/// Draws samples: of all correspondences, or of a pool of the first ones that grows (Chum & Matas 2005,
/// equations 2 to 4).
pub(super) struct Pool {
    random: Random,
    all: usize,
    /// How many from the front may be drawn.
    size: usize,
    /// Of `GROWN` samples of all correspondences, how many would lie in the pool.
    inside: f32,
    /// With how many samples drawn the pool grows.
    due: u32,
}

impl Pool {
    /// For `all` correspondences, seven at least.
    pub(super) fn new(sampling: Sampling, seed: u64, all: usize) -> Self {
        let inside = (0..MINIMUM).fold(GROWN, |product, i| product * (MINIMUM - i) as f32 / (all - i) as f32);
        let size = if sampling == Sampling::Ordered { MINIMUM } else { all };
        Self { random: Random::new(seed), all, size, inside, due: 1 }
    }

    /// The next sample, after `drawn` others: seven different places.
    pub(super) fn next(&mut self, drawn: u32) -> Sample {
        if self.size == self.all || drawn < self.due {
            return self.random.sample(self.size);
        }
        self.size += 1;
        let inside = self.inside * self.size as f32 / (self.size - MINIMUM) as f32;
        let more = (inside - self.inside) as u32;
        (self.inside, self.due) = (inside, self.due.saturating_add(more.saturating_add(1)));
        // The newest has not been drawn yet: it is one of the seven.
        let newest = self.size - 1;
        let mut sample: Sample = self.random.sample(self.size);
        if let (false, [first, ..]) = (sample.contains(&newest), &mut sample) {
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
        let mut pool = Pool::new(Sampling::Ordered, 1, 100);
        let mut first = pool.next(0);
        first.sort_unstable();
        assert_eq!(first, [0, 1, 2, 3, 4, 5, 6]);
        for drawn in 1..20 {
            let sample = pool.next(drawn);
            // Every sample so far has brought one new.
            assert!(
                sample.contains(&(6 + drawn as usize)) && sample.iter().all(|&i| i <= 6 + drawn as usize)
            );
        }
        (20..40_000).for_each(|drawn| {
            pool.next(drawn);
        });
        assert_eq!(pool.size, 100);
    }
}
