//! The lens model of a camera: distortion of the plane Z = 1, and its inverse by Newton's method.

use super::distortion::Distortion;
use super::fisheye::Fisheye;
use crate::geometry::Real;
use nalgebra::{Matrix2, Vector2};

/// A model of a lens, with its coefficients.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Lens<T: Real> {
    /// Radial and tangential distortion of the plane Z = 1: most lenses.
    BrownConrady(Distortion<T>),
    /// Distortion of the angle to the axis: lenses that see more than some 100 degrees.
    Fisheye(Fisheye<T>),
}

/// Newton's steps at most. From the distorted point itself, lenses that turn nothing over need three to
/// seven.
const MOST_STEPS: usize = 12;

impl<T: Real> From<Distortion<T>> for Lens<T> {
    fn from(distortion: Distortion<T>) -> Self {
        Self::BrownConrady(distortion)
    }
}

impl<T: Real> From<Fisheye<T>> for Lens<T> {
    fn from(fisheye: Fisheye<T>) -> Self {
        Self::Fisheye(fisheye)
    }
}

impl<T: Real> Lens<T> {
    /// A lens without distortion.
    pub const NONE: Self = Self::BrownConrady(Distortion::NONE);

    /// Whether the lens distorts nothing.
    pub fn is_none(&self) -> bool {
        matches!(self, Self::BrownConrady(distortion) if distortion.is_none())
    }

    /// Whether all coefficients are finite.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::BrownConrady(distortion) => distortion.to_opencv().iter().all(|k| k.is_finite()),
            Self::Fisheye(fisheye) => fisheye.to_opencv().iter().all(|k| k.is_finite()),
        }
    }

    /// Where the lens puts the point `(x, y)` of the plane Z = 1.
    pub fn distort(&self, point: &Vector2<T>) -> Vector2<T> {
        self.distort_with_derivative(point).0
    }

    /// The distorted point, and the derivative of both its coordinates by x and y.
    pub fn distort_with_derivative(&self, point: &Vector2<T>) -> (Vector2<T>, Matrix2<T>) {
        match self {
            Self::BrownConrady(distortion) => distortion.distort_with_derivative(point),
            Self::Fisheye(fisheye) => fisheye.distort_with_derivative(point),
        }
    }

    /// The squared radius r^2 up to which a growing radius is put at a growing one, without tangential
    /// distortion; 64 at most, which is a field of view of 166 degrees. Beyond it, coefficients that were
    /// fitted within the image turn the image over.
    pub fn reach_r2(&self) -> T {
        let grows = |r: T| match self {
            Self::BrownConrady(distortion) => distortion.grows_at(r),
            Self::Fisheye(fisheye) => fisheye.grows_at(r),
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

    /// The point that [`Self::distort`] puts at `distorted`, to within `tolerance`, in units of the plane Z =
    /// 1.
    ///
    /// Newton's method, at most twelve steps. `None` when it has not come within the tolerance, or when it
    /// came to where the lens model has turned the image over (the derivative's determinant is not
    /// positive): such a point is outside of what the coefficients describe.
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

impl<T: Real> Default for Lens<T> {
    fn default() -> Self {
        Self::NONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn barrel() -> Lens<f64> {
        Distortion { k1: -0.5, ..Distortion::NONE }.into()
    }

    #[test]
    fn the_radius_grows_up_to_the_fold() {
        // 1 - 3 r^2 / 2 is zero at r^2 = 2/3.
        assert!((barrel().reach_r2() - 2.0 / 3.0).abs() < 1e-4, "{}", barrel().reach_r2());
        assert_eq!(Lens::<f64>::NONE.reach_r2(), 64.0);
        // 1 - 3 theta^2 / 2 is zero at theta = 0.8165, whose tangent is 1.0642.
        let fisheye = Lens::from(Fisheye::from_opencv([-0.5, 0.0, 0.0, 0.0_f64]));
        assert!((fisheye.reach_r2() - 1.1325).abs() < 1e-3, "{}", fisheye.reach_r2());
    }

    #[test]
    fn a_point_beyond_the_fold_is_refused() {
        // x (1 - x^2 / 2) grows to 0.5443 at x = 0.8165 and then falls: nothing is put at 0.6.
        assert!(barrel().undistort(&Vector2::new(0.54, 0.0), 1e-9).is_some());
        assert_eq!(barrel().undistort(&Vector2::new(0.6, 0.0), 1e-9), None);
    }
}
