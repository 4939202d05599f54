//! Depth estimates with standard deviations, and their fusion by inverse variance.

use super::DepthScale;
use crate::units::{Disparity, Metres};

/// Depth along the optical axis with its standard deviation, from stereo, from focus or from both.
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Depth {
    /// Depth, m; positive.
    pub depth_m: f32,
    /// Standard deviation, m; positive.
    pub sigma_m: f32,
}

impl Depth {
    /// Largest difference of two depths of one surface, in standard deviations of the difference.
    pub const SAME_SURFACE: f32 = 3.0;

    /// Fuses two depths by inverse variance: the estimate of least variance for independent errors. It is
    /// taken in `1 / Z`, where the errors of disparity and of focus are symmetric, with deviation `sigma_Z /
    /// Z^2`. Of two depths of different surfaces, the one with the smaller deviation of `1 / Z` is kept.
    /// Where a variance is not finite, or the other one is 0, the other depth is the answer; the first one
    /// where neither is finite, or both are 0.
    pub fn fused(self, other: Self) -> Self {
        // Times the nearer depth, so that no power of a depth is beyond what the numbers hold.
        let near = self.depth_m.min(other.depth_m);
        let [a, b] = [self, other].map(|d| {
            let inverse = near / d.depth_m;
            (inverse, d.sigma_m / d.depth_m * inverse)
        });
        let (variance_a, variance_b) = (a.1 * a.1, b.1 * b.1);
        if !variance_a.is_finite() || !variance_b.is_finite() {
            return if variance_b.is_finite() { other } else { self };
        }
        if variance_a == 0.0 || variance_b == 0.0 {
            return if variance_a == 0.0 { self } else { other };
        }
        let apart = a.0 - b.0;
        if apart * apart > Self::SAME_SURFACE * Self::SAME_SURFACE * (variance_a + variance_b) {
            return if a.1 <= b.1 { self } else { other };
        }
        let ratio = (variance_a + variance_b) / (a.0 * variance_b + b.0 * variance_a);
        // Between the two, also where rounding would leave the range.
        let depth_m = (near * ratio).min(self.depth_m.max(other.depth_m));
        let sigma = a.1 * (b.1 / nalgebra::ComplexField::sqrt(variance_a + variance_b));
        Self { depth_m, sigma_m: sigma * depth_m / near * depth_m }
    }
}

impl DepthScale {
    /// Returns the depth of a disparity with standard deviation `sigma_px`; `None` for no answer and at or
    /// behind infinity.
    pub fn depth(&self, disparity: Disparity, sigma_px: f32) -> Option<Depth> {
        let (Metres(depth_m), Metres(sigma_m)) = self.metres_and_sigma(disparity.to_f32()?, sigma_px)?;
        Some(Depth { depth_m, sigma_m })
    }
}

/// Fuses two depth maps of one view: [`Depth::fused`] where both have an answer, else the one that is there.
/// As many pixels are written as all three slices have.
pub fn fuse(first: &[Option<Depth>], second: &[Option<Depth>], out: &mut [Option<Depth>]) {
    for ((first, second), out) in first.iter().zip(second).zip(out) {
        *out = match (*first, *second) {
            (Some(first), Some(second)) => Some(first.fused(second)),
            (first, second) => first.or(second),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_that_are_unknown_or_exact_are_fused_to_one_of_them() {
        let of = |depth_m, sigma_m| Depth { depth_m, sigma_m };
        let known = of(2.0, 0.1);
        for sigma in [f32::INFINITY, f32::NAN, 1e30] {
            let unknown = of(2.05, sigma);
            assert_eq!((known.fused(unknown), unknown.fused(known)), (known, known), "{sigma}");
        }
        let unknown = [of(1.0, f32::INFINITY), of(2.0, f32::INFINITY)];
        assert_eq!(unknown[0].fused(unknown[1]), unknown[0]);
        let exact = [of(2.0, 0.0), of(3.0, 0.0)];
        assert_eq!((exact[0].fused(exact[0]), exact[0].fused(exact[1])), (exact[0], exact[0]));
        // Far away the deviation of `1 / Z` is less than any number above 0.
        let (near, far) = (of(0.352, 0.975), of(f32::MAX, 22.0));
        assert_eq!((near.fused(far), far.fused(near)), (far, far));
        let pairs = [(1e30, 1e29, 2e30, 1e29), (1e-30, 1e-31, 2e-30, 1e-30), (1.0, 3.0, 1e36, 1e30)];
        for (za, sa, zb, sb) in pairs {
            let both = of(za, sa).fused(of(zb, sb));
            assert!((za..=zb).contains(&both.depth_m) && both.sigma_m > 0.0, "{both:?}");
            assert!(both.sigma_m.is_finite(), "{both:?}");
        }
        assert_eq!((exact[0].fused(of(2.1, 0.1)), of(2.1, 0.1).fused(exact[0])), (exact[0], exact[0]));
    }
}
