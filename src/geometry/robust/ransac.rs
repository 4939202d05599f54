//! RANSAC (Fischler & Bolles 1981): the loop over samples, for whatever is estimated.

/// What [`ransac`] estimates from samples of K observations, and the best estimate so far.
pub(super) trait Estimator<const K: usize> {
    /// What a sample gives.
    type Model;
    /// All that a sample gives.
    type Models: AsRef<[Self::Model]>;

    /// Places of the next sample, after `drawn` others.
    fn draw(&mut self, drawn: u32) -> [usize; K];

    /// The models of a sample, by the minimal solver.
    fn models(&self, sample: &[usize; K]) -> Self::Models;

    /// Scores a model and, where it is better than the best, refines it (LO-RANSAC; Chum, Matas & Kittler
    /// 2003) and keeps it.
    fn consider(&mut self, model: &Self::Model, sample: &[usize; K]);

    /// Whether a better estimate is as unlikely after `drawn` samples as was asked.
    fn is_enough(&mut self, drawn: u32) -> bool;
}

/// Draws samples until their number is `most_samples` or the estimator has enough; how many were drawn.
pub(super) fn ransac<E: Estimator<K>, const K: usize>(estimator: &mut E, most_samples: u32) -> u32 {
    let mut drawn = 0;
    while !estimator.is_enough(drawn) && drawn < most_samples {
        let sample = estimator.draw(drawn);
        drawn += 1;
        for model in estimator.models(&sample).as_ref() {
            estimator.consider(model, &sample);
        }
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of two numbers, whose models are they and their sum; what was considered.
    struct Sums {
        enough: u32,
        considered: heapless::Vec<(usize, [usize; 2]), 64>,
    }

    impl Estimator<2> for Sums {
        type Model = usize;
        type Models = [usize; 3];

        fn draw(&mut self, drawn: u32) -> [usize; 2] {
            [drawn as usize, 10 * drawn as usize]
        }

        fn models(&self, [a, b]: &[usize; 2]) -> [usize; 3] {
            [*a, *b, a + b]
        }

        fn consider(&mut self, model: &usize, sample: &[usize; 2]) {
            self.considered.push((*model, *sample)).expect("room");
        }

        fn is_enough(&mut self, drawn: u32) -> bool {
            drawn >= self.enough
        }
    }

    #[test]
    fn samples_are_drawn_until_there_are_enough_or_the_most() {
        for (enough, most, drawn) in [(3, 9, 3), (9, 4, 4), (5, 5, 5), (0, 5, 0), (5, 0, 0)] {
            let mut sums = Sums { enough, considered: heapless::Vec::new() };
            assert_eq!(ransac(&mut sums, most), drawn);
            let models = (0..drawn as usize).flat_map(|n| [n, 10 * n, 11 * n].map(|m| (m, [n, 10 * n])));
            assert!(sums.considered.iter().copied().eq(models), "{enough} {most}");
        }
    }
}
