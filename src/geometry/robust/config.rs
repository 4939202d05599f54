//! The configuration of a RANSAC estimate.

use crate::geometry::Real;

/// How correspondences are chosen for a sample.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Sampling {
    /// Every correspondence is equally likely to be drawn.
    #[default]
    Uniform,
    /// The first ones first: the correspondences come in order, those that are most likely right before the
    /// others. Samples are drawn from a set that grows from the front until it holds all (PROSAC; Chum &
    /// Matas 2005).
    Ordered,
}

/// Configuration of the robust estimators of this module.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RobustConfig<T: Real> {
    /// Sampson's distance up to which a correspondence counts as right, px, greater than zero. It has to be
    /// more than the noise of right ones, three to six deviations: what is nearer gets more weight, the
    /// noise itself need not be known.
    pub threshold_px: T,
    /// The probability with which a better estimate may be missed, between zero and one.
    pub miss_probability: T,
    /// Samples at most, however bad the best estimate is then; at least one.
    pub most_samples: u32,
    /// What the random choices begin with: the same seed, the same estimate.
    pub seed: u64,
    /// How correspondences are chosen.
    pub sampling: Sampling,
}

impl<T: Real> RobustConfig<T> {
    /// With a threshold in px; 0.1 % for the miss, 10 000 samples, seed 0, all correspondences alike.
    pub fn new(threshold_px: T) -> Self {
        Self {
            threshold_px,
            miss_probability: T::of(1e-3),
            most_samples: 10_000,
            seed: 0,
            sampling: Sampling::Uniform,
        }
    }
}
