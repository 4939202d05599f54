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
