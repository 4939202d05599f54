//! Tukey's biweight as the loss of RANSAC and least squares (Beaton & Tukey 1974): a soft MSAC.

use crate::geometry::Real;

/// How many thresholds away an observation has no weight any more.
const WIDTH: f64 = 1.5;

/// A threshold, marginalised: what a residual gains and weighs.
///
/// With a hard threshold t an observation gains `max(0, 1 - d^2 / t^2)` (MSAC; Torr & Zisserman 2000), d
/// being its residual. The noise, and with it the right t, is not known: averaged over all t^2 up to a
/// largest one, w^2, with a density that falls linearly to zero there, the weight in least squares is
/// `(1 - d^2 / w^2)^2` (Tukey's biweight) and the gain `(1 - d^2 / w^2)^3`. MAGSAC++ (Barath et al. 2020)
/// averages over deviations of the noise and gets an incomplete gamma function that differs from this by less
/// than a tenth: this one needs no table.
#[derive(Clone, Copy)]
pub(crate) struct Biweight<T: Real> {
    /// The squared width w^2, px^2.
    pub(crate) width_squared: T,
}

impl<T: Real> Biweight<T> {
    /// A loss whose inliers have residuals up to `threshold_px`.
    pub(crate) fn new(threshold_px: T) -> Self {
        let width = threshold_px * T::of(WIDTH);
        Self { width_squared: width * width }
    }

    /// `factor` times as wide.
    pub(crate) fn widened(self, factor: T) -> Self {
        Self { width_squared: self.width_squared * factor * factor }
    }
}

/// The weight and the gain of an observation with `share = d^2 / w^2`, 0 to 1.
#[inline(always)]
pub(crate) fn weight_and_gain<T: Real>(share: T) -> (T, T) {
    let left = T::ONE - share;
    let weight = left * left;
    (weight, weight * left)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_and_gains_fall_from_one_to_zero_at_the_width() {
        let loss = Biweight::new(2.0_f64);
        assert_eq!([loss.width_squared, loss.widened(4.0).width_squared], [9.0, 144.0]);
        // 3/4 squared, and to the third.
        assert_eq!(weight_and_gain(0.25), (0.5625, 0.421875));
        assert_eq!([weight_and_gain(0.0), weight_and_gain(1.0)], [(1.0, 1.0), (0.0, 0.0)]);
    }
}
