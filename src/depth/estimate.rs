//! A depth with its deviation, whatever it was measured by, and two of them as one.

use super::DepthScale;
use crate::units::{Disparity, Metres};

/// A depth along the optical axis and how uncertain it is: of stereo, of focus, of both.
///
/// ```
/// use stereopsis::depth::Depth;
/// let stereo = Depth { depth_m: 2.0, sigma_m: 0.04 };
/// let focus = Depth { depth_m: 2.1, sigma_m: 0.08 };
/// let both = stereo.fused(focus);
/// // 1 / Z: 0.5 and 0.4762, deviations 0.01 and 0.0181; together 0.4945 and 0.0088.
/// assert!((both.depth_m - 2.0224).abs() < 1e-3 && (both.sigma_m - 0.0358).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Depth {
    /// The depth, m; positive.
    pub depth_m: f32,
    /// Its deviation, m; positive.
    pub sigma_m: f32,
}

impl Depth {
    /// Two depths that differ by more than so many deviations of their difference are of different surfaces.
    pub const SAME_SURFACE: f32 = 3.0;

    /// What both say together, weighted by one over their variances: the estimate of least variance if their
    /// errors have nothing to do with each other. It is taken of `1 / Z`, in which the errors of
    /// disparity and of focus are even; its deviation is `sigma_Z / Z^2`. Where they contradict each
    /// other the surer one stands alone.
    pub fn fused(self, other: Self) -> Self {
        let [a, b] = [self, other].map(|d| (1.0 / d.depth_m, d.sigma_m / (d.depth_m * d.depth_m)));
        let (variance_a, variance_b) = (a.1 * a.1, b.1 * b.1);
        let apart = a.0 - b.0;
        if apart * apart > Self::SAME_SURFACE * Self::SAME_SURFACE * (variance_a + variance_b) {
            return if a.1 <= b.1 { self } else { other };
        }
        let depth_m = (variance_a + variance_b) / (a.0 * variance_b + b.0 * variance_a);
        let sigma = a.1 * (b.1 / nalgebra::ComplexField::sqrt(variance_a + variance_b));
        Self { depth_m, sigma_m: sigma * depth_m * depth_m }
    }
}

impl DepthScale {
    /// The depth of a disparity that is uncertain by `sigma_px`; `None` for no answer and at or behind
    /// infinity.
    pub fn depth(&self, disparity: Disparity, sigma_px: f32) -> Option<Depth> {
        let (Metres(depth_m), Metres(sigma_m)) = (self.metres(disparity)?, self.sigma(disparity, sigma_px)?);
        Some(Depth { depth_m, sigma_m })
    }
}

/// Two maps of one view as one, pixel by pixel: [`Depth::fused`] where both have an answer, else the answer
/// of the one that has it. Those pixels are written that all three have.
pub fn fuse(first: &[Option<Depth>], second: &[Option<Depth>], out: &mut [Option<Depth>]) {
    for ((first, second), out) in first.iter().zip(second).zip(out) {
        *out = match (*first, *second) {
            (Some(first), Some(second)) => Some(first.fused(second)),
            (first, second) => first.or(second),
        };
    }
}
