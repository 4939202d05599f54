//! Radial and tangential lens distortion (Conrady 1919; Brown 1971), with the rational model of OpenCV.

use crate::geometry::Real;
use nalgebra::{Matrix2, Vector2};

/// Brown-Conrady coefficients, with the denominator of OpenCV's rational model, without a unit: they act on
/// `(x, y) = (X / Z, Y / Z)`.
///
/// `r^2 = x^2 + y^2`, `q = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)`,
/// `x_d = x q + 2 p1 x y + p2 (r^2 + 2 x^2)`, `y_d = y q + p1 (r^2 + 2 y^2) + 2 p2 x y`
/// (Brown 1971; OpenCV's `distCoeffs = (k1, k2, p1, p2, k3, k4, k5, k6)`, of which most lenses need the first
/// five).
///
/// The default is a lens without distortion.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Distortion<T: Real> {
    /// Radial, r^2.
    pub k1: T,
    /// Radial, r^4.
    pub k2: T,
    /// Tangential, along y.
    pub p1: T,
    /// Tangential, along x.
    pub p2: T,
    /// Radial, r^6.
    pub k3: T,
    /// Radial, r^2 of the denominator.
    pub k4: T,
    /// Radial, r^4 of the denominator.
    pub k5: T,
    /// Radial, r^6 of the denominator.
    pub k6: T,
}

impl<T: Real> Distortion<T> {
    /// A lens without distortion.
    pub const NONE: Self = Self::from_opencv([T::ZERO; 5]);

    /// The coefficients in OpenCV's order: k1, k2, p1, p2, k3.
    pub const fn from_opencv([k1, k2, p1, p2, k3]: [T; 5]) -> Self {
        Self { k1, k2, p1, p2, k3, k4: T::ZERO, k5: T::ZERO, k6: T::ZERO }
    }

    /// The coefficients of the rational model in OpenCV's order: k1, k2, p1, p2, k3, k4, k5, k6.
    pub const fn from_opencv_rational([k1, k2, p1, p2, k3, k4, k5, k6]: [T; 8]) -> Self {
        Self { k1, k2, p1, p2, k3, k4, k5, k6 }
    }

    /// The coefficients k1, k2, p1, p2, k3, k4, k5, k6, as OpenCV orders them.
    pub const fn to_opencv(&self) -> [T; 8] {
        [self.k1, self.k2, self.p1, self.p2, self.k3, self.k4, self.k5, self.k6]
    }

    /// Whether the lens distorts nothing.
    pub fn is_none(&self) -> bool {
        self.to_opencv().iter().all(|&k| k == T::ZERO)
    }

    /// Where the lens puts the point `(x, y)` of the plane Z = 1.
    pub fn distort(&self, point: &Vector2<T>) -> Vector2<T> {
        self.distort_with_derivative(point).0
    }

    /// The distorted point, and the derivative of both its coordinates by x and y. Where the denominator is
    /// not positive they are no numbers.
    pub fn distort_with_derivative(&self, point: &Vector2<T>) -> (Vector2<T>, Matrix2<T>) {
        let (x, y) = (point.x, point.y);
        let two = T::of(2.0);
        let r2 = x * x + y * y;
        let (q, dq) = self.radial(r2);
        let xy = two * x * y;
        let distorted = Vector2::new(
            x * q + self.p1 * xy + self.p2 * (r2 + two * x * x),
            y * q + self.p1 * (r2 + two * y * y) + self.p2 * xy,
        );
        let cross = dq * xy + two * (self.p1 * x + self.p2 * y);
        let derivative = Matrix2::new(
            q + two * x * x * dq + two * self.p1 * y + T::of(6.0) * self.p2 * x,
            cross,
            cross,
            q + two * y * y * dq + T::of(6.0) * self.p1 * y + two * self.p2 * x,
        );
        (distorted, derivative)
    }

    /// Whether a growing radius is put at a growing one at `r`, were `p1 = p2 = 0`.
    pub(crate) fn grows_at(&self, r: T) -> bool {
        // d(r q) / dr = q + 2 r^2 dq / d(r^2); what is not a number does not grow.
        let (q, dq) = self.radial(r * r);
        q + T::of(2.0) * r * r * dq > T::ZERO
    }

    /// The radial factor q and dq / d(r^2).
    fn radial(&self, r2: T) -> (T, T) {
        let series = |a: T, b: T, c: T| {
            let slope = a + r2 * (T::of(2.0) * b + r2 * T::of(3.0) * c);
            (T::ONE + r2 * (a + r2 * (b + r2 * c)), slope)
        };
        let (over, over_slope) = series(self.k1, self.k2, self.k3);
        if self.k4 == T::ZERO && self.k5 == T::ZERO && self.k6 == T::ZERO {
            return (over, over_slope);
        }
        let (under, under_slope) = series(self.k4, self.k5, self.k6);
        // Beyond its pole the model says nothing: a root of what is negative.
        let by = if under > T::ZERO { T::ONE / under } else { (-T::ONE).sqrt() };
        let q = over * by;
        (q, (over_slope - q * under_slope) * by)
    }
}

impl<T: Real> Default for Distortion<T> {
    fn default() -> Self {
        Self::NONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worked_by_hand() {
        // r^2 = 1/2 at (1/2, 1/2): q = 1 + 0.1 / 2 + 0.04 / 4 + 0.08 / 8 = 1.07.
        let lens = Distortion::from_opencv([0.1, 0.04, 0.02, 0.01, 0.08_f64]);
        let point = Vector2::new(0.5, 0.5);
        // x: 0.535 + 2 * 0.02 / 4 + 0.01 * (0.5 + 0.5); y: 0.535 + 0.02 * (0.5 + 0.5) + 2 * 0.01 / 4.
        let distorted = lens.distort(&point);
        assert!((distorted - Vector2::new(0.555, 0.56)).amax() < 1e-15, "{distorted}");
        // Over 1 + 0.2 / 2 + 0.08 / 4 + 0.16 / 8 = 1.14, p1 and p2 apart.
        let rational = Distortion { k4: 0.2, k5: 0.08, k6: 0.16, ..lens };
        let distorted = rational.distort(&point);
        assert!(
            (distorted - Vector2::new(0.535 / 1.14 + 0.02, 0.535 / 1.14 + 0.025)).amax() < 1e-15,
            "{distorted}"
        );
    }

    #[test]
    fn the_derivative_is_the_slope() {
        let lens = Distortion::from_opencv_rational([0.1, 0.04, 0.02, 0.01, 0.08, 0.2, 0.08, 0.16_f64]);
        let point = Vector2::new(0.5, 0.3);
        let (_, derivative) = lens.distort_with_derivative(&point);
        for (column, step) in [Vector2::new(1e-6, 0.0), Vector2::new(0.0, 1e-6)].iter().enumerate() {
            // Over 2e-6: the third derivative leaves 1e-12.
            let slope = (lens.distort(&(point + step)) - lens.distort(&(point - step))) / 2e-6;
            assert!((derivative.column(column) - slope).amax() < 1e-9, "{derivative} {slope}");
        }
    }

    #[test]
    fn beyond_the_pole_nothing_grows() {
        // The denominator is zero at r^2 = 1/2.
        let lens = Distortion { k4: -2.0, ..Distortion::<f64>::NONE };
        assert!(lens.grows_at(0.7) && !lens.grows_at(0.71));
        assert!(lens.distort(&Vector2::new(0.71, 0.0)).x.is_nan());
    }
}
