//! Lens distortion after Brown and Conrady.

use super::Real;
use nalgebra::{Matrix2, Vector2};

/// Brown-Conrady coefficients in OpenCV's order, without a unit: they act on `(x, y) = (X / Z, Y / Z)`.
///
/// `r^2 = x^2 + y^2`, `q = 1 + k1 r^2 + k2 r^4 + k3 r^6`,
/// `x_d = x q + 2 p1 x y + p2 (r^2 + 2 x^2)`, `y_d = y q + p1 (r^2 + 2 y^2) + 2 p2 x y`
/// (Brown 1971; OpenCV's `distCoeffs = (k1, k2, p1, p2, k3)`).
///
/// The default is a lens without distortion.
#[derive(Clone, Copy, PartialEq, Debug)]
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
}

/// Newton's steps at most. From the distorted point itself, lenses that turn nothing over need three to six.
const MOST_STEPS: usize = 12;

impl<T: Real> Distortion<T> {
    /// A lens without distortion.
    pub const NONE: Self = Self { k1: T::ZERO, k2: T::ZERO, p1: T::ZERO, p2: T::ZERO, k3: T::ZERO };

    /// The coefficients in OpenCV's order: k1, k2, p1, p2, k3.
    pub const fn from_opencv([k1, k2, p1, p2, k3]: [T; 5]) -> Self {
        Self { k1, k2, p1, p2, k3 }
    }

    /// k1, k2, p1, p2, k3, as OpenCV orders them.
    pub const fn to_opencv(&self) -> [T; 5] {
        [self.k1, self.k2, self.p1, self.p2, self.k3]
    }

    /// Whether the lens distorts nothing.
    pub fn is_none(&self) -> bool {
        self.to_opencv().iter().all(|&k| k == T::ZERO)
    }

    /// Where the lens puts the point `(x, y)` of the plane Z = 1.
    pub fn distort(&self, point: &Vector2<T>) -> Vector2<T> {
        self.distort_with_derivative(point).0
    }

    /// The distorted point, and the derivative of both its coordinates by x and y.
    pub fn distort_with_derivative(&self, point: &Vector2<T>) -> (Vector2<T>, Matrix2<T>) {
        let (x, y) = (point.x, point.y);
        let two = T::of(2.0);
        let r2 = x * x + y * y;
        let q = T::ONE + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3));
        // dq / d(r^2)
        let dq = self.k1 + r2 * (two * self.k2 + r2 * T::of(3.0) * self.k3);
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

    /// The squared radius r^2 up to which a growing radius is put at a growing one, of `p1 = p2 = 0`; 64 at most, which is a
    /// field of view of 166 degrees. Beyond it, coefficients that were fitted within the image turn the image over.
    pub fn reach_r2(&self) -> T {
        // d(r q) / dr = q + 2 r^2 dq / d(r^2).
        let grows = |r: T| {
            let s = r * r;
            T::ONE + s * (T::of(3.0) * self.k1 + s * (T::of(5.0) * self.k2 + s * T::of(7.0) * self.k3)) > T::ZERO
        };
        let most = T::of(8.0);
        let step = T::of(1.0 / 64.0);
        let mut r = T::ZERO;
        while r < most && grows(r + step) {
            r += step;
        }
        // The end lies within one step.
        let mut part = step;
        for _ in 0..12 {
            part *= T::of(0.5);
            if grows(r + part) {
                r += part;
            }
        }
        r.min(most) * r.min(most)
    }

    /// The point that [`Self::distort`] puts at `distorted`, to within `tolerance`, in units of the plane Z = 1.
    ///
    /// Newton's method, at most twelve steps. `None` when it has not come within the tolerance, or when it came to
    /// where the lens model has turned the image over (the derivative's determinant is not positive): such a point
    /// is outside of what the coefficients describe.
    pub fn undistort(&self, distorted: &Vector2<T>, tolerance: T) -> Option<Vector2<T>> {
        let mut point = *distorted;
        for _ in 0..=MOST_STEPS {
            let (here, derivative) = self.distort_with_derivative(&point);
            let [a, b, c, d] = [derivative.m11, derivative.m12, derivative.m21, derivative.m22];
            let determinant = a * d - b * c;
            // Not a number is not greater either.
            if !(determinant > T::ZERO && a + d > T::ZERO) {
                return None;
            }
            let error = here - distorted;
            if error.x.abs() <= tolerance && error.y.abs() <= tolerance {
                return Some(point);
            }
            let step = Vector2::new(d * error.x - b * error.y, a * error.y - c * error.x);
            point -= step / determinant;
        }
        None
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
        let lens = Distortion { k1: 0.1, k2: 0.04, p1: 0.02, p2: 0.01, k3: 0.08_f64 };
        let point = Vector2::new(0.5, 0.5);
        let (distorted, derivative) = lens.distort_with_derivative(&point);
        // x: 0.535 + 2 * 0.02 / 4 + 0.01 * (0.5 + 0.5); y: 0.535 + 0.02 * (0.5 + 0.5) + 2 * 0.01 / 4.
        assert!((distorted - Vector2::new(0.555, 0.56)).amax() < 1e-15, "{distorted}");
        // By x alone, over 2e-6: the third derivative leaves 1e-12.
        let step = Vector2::new(1e-6, 0.0);
        let slope = (lens.distort(&(point + step)) - lens.distort(&(point - step))) / 2e-6;
        assert!((derivative.column(0) - slope).amax() < 1e-9, "{derivative} {slope}");
        let back = lens.undistort(&distorted, 1e-12).expect("it converges");
        assert!((back - point).amax() < 1e-12);
    }

    #[test]
    fn the_radius_grows_up_to_the_fold() {
        // 1 - 3 r^2 / 2 is zero at r^2 = 2/3.
        let lens = Distortion { k1: -0.5, ..Distortion::<f64>::NONE };
        assert!((lens.reach_r2() - 2.0 / 3.0).abs() < 1e-4, "{}", lens.reach_r2());
        assert_eq!(Distortion::<f64>::NONE.reach_r2(), 64.0);
    }

    #[test]
    fn a_point_beyond_the_fold_is_refused() {
        // x (1 - x^2 / 2) grows to 0.5443 at x = 0.8165 and then falls: nothing is put at 0.6.
        let lens = Distortion { k1: -0.5, ..Distortion::<f64>::NONE };
        assert!(lens.undistort(&Vector2::new(0.54, 0.0), 1e-9).is_some());
        assert_eq!(lens.undistort(&Vector2::new(0.6, 0.0), 1e-9), None);
    }
}
