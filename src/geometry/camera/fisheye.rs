//! Fisheye lenses: the equidistant model (Kannala & Brandt 2006).

use crate::geometry::Real;
use nalgebra::{Matrix2, Vector2};

/// Coefficients of a fisheye lens, without a unit: they act on the angle between a ray and the optical
/// axis.
///
/// `theta = atan(r)`, `r^2 = x^2 + y^2` with `(x, y) = (X / Z, Y / Z)`,
/// `theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)`, `(x_d, y_d) = theta_d / r (x,
/// y)` (Kannala & Brandt 2006; OpenCV's `fisheye`, Kalibr's and ROS's `equidistant`).
///
/// Rays of 90 degrees and more have no place on the plane Z = 1, so that they are left out here.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fisheye<T: Real> {
    /// The coefficient of theta^3.
    pub k1: T,
    /// The coefficient of theta^5.
    pub k2: T,
    /// The coefficient of theta^7.
    pub k3: T,
    /// The coefficient of theta^9.
    pub k4: T,
}

impl<T: Real> Fisheye<T> {
    /// The coefficients in OpenCV's order: k1, k2, k3, k4.
    pub const fn from_opencv([k1, k2, k3, k4]: [T; 4]) -> Self {
        Self { k1, k2, k3, k4 }
    }

    /// The coefficients k1, k2, k3, k4, as OpenCV orders them.
    pub const fn to_opencv(&self) -> [T; 4] {
        [self.k1, self.k2, self.k3, self.k4]
    }

    /// The distorted point, and the derivative of both its coordinates by x and y.
    pub fn distort_with_derivative(&self, point: &Vector2<T>) -> (Vector2<T>, Matrix2<T>) {
        let r2 = point.norm_squared();
        // So near the axis that the angle is the radius, and q = 1 + (k1 - 1/3) r^2 to a rounding.
        let (q, slope) = if r2 < T::EPSILON {
            (T::ONE, T::of(2.0) * (self.k1 - T::of(1.0 / 3.0)))
        } else {
            let r = r2.sqrt();
            let (angle, growth) = self.angle(r);
            let q = angle / r;
            // dq / dr / r, with d(theta) / dr = 1 / (1 + r^2).
            (q, (growth / (T::ONE + r2) - q) / r2)
        };
        (point * q, Matrix2::identity() * q + point * point.transpose() * slope)
    }

    /// Whether a growing radius is put at a growing one at `r`.
    pub(crate) fn grows_at(&self, r: T) -> bool {
        self.angle(r).1 > T::ZERO
    }

    /// The angle theta_d of a radius on the plane Z = 1, and its derivative by theta.
    fn angle(&self, r: T) -> (T, T) {
        let theta = r.arc_tangent();
        let s = theta * theta;
        let [k1, k2, k3, k4] = self.to_opencv();
        let angle = theta * (T::ONE + s * (k1 + s * (k2 + s * (k3 + s * k4))));
        let growth = T::ONE
            + s * (T::of(3.0) * k1 + s * (T::of(5.0) * k2 + s * (T::of(7.0) * k3 + s * T::of(9.0) * k4)));
        (angle, growth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worked_by_hand() {
        // 45 degrees along (3, 4) / 5: theta = pi / 4, theta^2 = 0.61685.
        let lens = Fisheye::from_opencv([0.1, 0.0, 0.0, 0.0_f64]);
        let angle = core::f64::consts::FRAC_PI_4;
        let (distorted, _) = lens.distort_with_derivative(&Vector2::new(0.6, 0.8));
        let expected = Vector2::new(0.6, 0.8) * (angle * (1.0 + 0.1 * angle * angle));
        assert!((distorted - expected).amax() < 1e-15, "{distorted}");
    }

    #[test]
    fn the_derivative_is_the_slope() {
        let lens = Fisheye::from_opencv([0.1, -0.03, 0.02, -0.004_f64]);
        for point in [Vector2::new(0.5, 0.3), Vector2::new(-3.0, 1.0), Vector2::zeros()] {
            let (_, derivative) = lens.distort_with_derivative(&point);
            for (column, step) in [Vector2::new(1e-6, 0.0), Vector2::new(0.0, 1e-6)].iter().enumerate() {
                let at = |point: Vector2<f64>| lens.distort_with_derivative(&point).0;
                let slope = (at(point + step) - at(point - step)) / 2e-6;
                assert!((derivative.column(column) - slope).amax() < 1e-9, "{derivative} {slope}");
            }
        }
    }
}
