//! The models of lenses that a calibration finds.

use nalgebra::Vector2;
use stereopsis::geometry::camera::{Distortion, Fisheye, Lens};

/// Parameters of a camera: fx, fy, cx, cy and up to eight of its lens, in the order of [`LensModel`].
pub(super) const INNER: usize = 4 + 8;

/// The models of lenses.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LensModel {
    /// Brown and Conrady's: k1, k2, p1, p2, k3. Most lenses.
    Brown,
    /// OpenCV's rational one: k1, k2, p1, p2, k3, k4, k5, k6. Wide lenses with a strong barrel.
    Rational,
    /// Kannala and Brandt's, of the angle to the axis: k1, k2, k3, k4. Lenses that see more than some 100
    /// degrees.
    Fisheye,
}

impl LensModel {
    /// Which parameters of a camera by itself are found, in steps: each begins where the one before has
    /// ended.
    pub(super) fn steps(self) -> &'static [&'static [usize]] {
        match self {
            Self::Brown | Self::Rational => &[&[0, 1, 4], &[0, 1, 2, 3, 4, 5], &[0, 1, 2, 3, 4, 5, 6, 7, 8]],
            Self::Fisheye => &[&[0, 1, 4], &[0, 1, 2, 3, 4], &[0, 1, 2, 3, 4, 5], &[0, 1, 2, 3, 4, 5, 6, 7]],
        }
    }

    /// Whether a parameter is found in the end, of both cameras together.
    pub(super) fn has(self, parameter: usize) -> bool {
        parameter
            < match self {
                Self::Brown => 9,
                Self::Rational => INNER,
                Self::Fisheye => 8,
            }
    }

    /// What the square of a camera's parameter counts besides the residuals', px^2. The rational model's
    /// upper coefficients undo each other: without bounds they grow until a pole is near the image.
    pub(super) fn weight(self, parameter: usize) -> f64 {
        if self == Self::Rational && parameter >= 8 { 0.01 } else { 0.0 }
    }

    /// The lens of these coefficients.
    pub(super) fn lens(self, [k1, k2, p1, p2, k3, k4, k5, k6]: [f64; 8]) -> Lens<f64> {
        match self {
            Self::Brown => Distortion::from_opencv([k1, k2, p1, p2, k3]).into(),
            Self::Rational => Distortion::from_opencv_rational([k1, k2, p1, p2, k3, k4, k5, k6]).into(),
            Self::Fisheye => Fisheye::from_opencv([k1, k2, p1, p2]).into(),
        }
    }

    /// How a distorted point of the plane Z = 1 moves with each coefficient.
    pub(super) fn slopes(self, coefficients: [f64; 8], plane: &Vector2<f64>) -> [Vector2<f64>; 8] {
        let (x, y) = (plane.x, plane.y);
        let r2 = plane.norm_squared();
        if self == Self::Fisheye {
            let r = r2.sqrt();
            let theta = r.atan();
            // theta^(2 i + 3) / r.
            let of = |i: i32| if r < 1e-9 { Vector2::zeros() } else { plane * (theta.powi(2 * i + 3) / r) };
            return std::array::from_fn(|i| if i < 4 { of(i as i32) } else { Vector2::zeros() });
        }
        let [k1, k2, _, _, k3, k4, k5, k6] = coefficients;
        let below = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
        let radial = plane / below;
        let again = radial * (-(1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) / below);
        [
            radial * r2,
            radial * r2 * r2,
            Vector2::new(2.0 * x * y, r2 + 2.0 * y * y),
            Vector2::new(r2 + 2.0 * x * x, 2.0 * x * y),
            radial * r2 * r2 * r2,
            again * r2,
            again * r2 * r2,
            again * r2 * r2 * r2,
        ]
    }
}
