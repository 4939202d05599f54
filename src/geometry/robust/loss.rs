//! What a distance is worth.

use crate::geometry::Real;

/// How many thresholds away a correspondence has no weight any more.
const WIDTH: f64 = 1.5;

/// A threshold, marginalised: the number that is small when an estimate is good.
///
/// With a hard threshold t a correspondence gains `max(0, 1 - d^2 / t^2)` (MSAC; Torr & Zisserman 2000), d
/// being Sampson's distance. The noise, and with it the right t, is not known: averaged over all t^2 up to a
/// largest one, w^2, with a density that falls linearly to zero there, the weight in least squares is `(1 -
/// d^2 / w^2)^2` (Tukey's biweight) and the gain `(1 - d^2 / w^2)^3`. MAGSAC++ (Barath et al. 2020) averages
/// over deviations of the noise and gets an incomplete gamma function that differs from this by less than a
/// tenth: this one needs no table.
#[derive(Clone, Copy)]
pub(super) struct Loss<T: Real> {
    /// w^2, px^2.
    pub(super) width_squared: T,
}

impl<T: Real> Loss<T> {
    /// Of the distance up to which a correspondence counts as right, px.
    pub(super) fn new(threshold_px: T) -> Self {
        let width = threshold_px * T::of(WIDTH);
        Self { width_squared: width * width }
    }

    /// The same `factor` times as wide.
    pub(super) fn widened(self, factor: T) -> Self {
        Self { width_squared: self.width_squared * factor * factor }
    }
}
