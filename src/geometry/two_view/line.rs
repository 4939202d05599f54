//! Epipolar lines and epipoles.

use crate::geometry::Real;
use nalgebra::{Point2, Vector3};

/// A line of an image: the points (u, v) in px with `a u + b v + c = 0`, `a^2 + b^2 = 1`.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Line<T: Real> {
    coefficients: Vector3<T>,
}

impl<T: Real> Line<T> {
    /// The line `a u + b v + c = 0` of any scale; `None` when a and b are zero, which is the line at
    /// infinity, or when a number is not finite or would not be.
    pub fn new(coefficients: &Vector3<T>) -> Option<Self> {
        let size = coefficients.x.abs().max(coefficients.y.abs());
        if !(size > T::ZERO) || !coefficients.iter().all(|x| x.is_finite()) {
            return None;
        }
        // By the larger one first: the square of a small number may be nothing.
        let scaled = coefficients / size;
        let coefficients = scaled / scaled.xy().norm();
        // A line may be farther away than numbers reach.
        coefficients.z.is_finite().then_some(Self { coefficients })
    }

    /// The coefficients (a, b, c): no unit, no unit, px.
    pub fn coefficients(&self) -> &Vector3<T> {
        &self.coefficients
    }

    /// The distance of a point, px; positive on the side to which (a, b) points.
    pub fn distance_px(&self, point: &Point2<T>) -> T {
        self.coefficients.x * point.x + self.coefficients.y * point.y + self.coefficients.z
    }

    /// The point of the line that is nearest to `point`, px.
    pub fn nearest(&self, point: &Point2<T>) -> Point2<T> {
        point - self.coefficients.xy() * self.distance_px(point)
    }
}

/// An epipole: the image of the other camera's centre, a homogeneous point of length one.
///
/// Cameras that look in parallel have it at infinity: a direction without a pixel.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Epipole<T: Real> {
    homogeneous: Vector3<T>,
}

impl<T: Real> Epipole<T> {
    /// The vector, at length one, or all zero when it is.
    pub(crate) fn new(vector: &Vector3<T>) -> Self {
        let size = vector.amax();
        if !(size > T::ZERO) {
            return Self { homogeneous: Vector3::zeros() };
        }
        let scaled = vector / size;
        Self { homogeneous: scaled / scaled.norm() }
    }

    /// The homogeneous point (x, y, w) of length one: the epipole is at (x / w, y / w) px; where w = 0, in
    /// the direction (x, y).
    pub fn homogeneous(&self) -> &Vector3<T> {
        &self.homogeneous
    }

    /// The epipole's column and row, px; `None` at infinity, that is where w is nothing but rounding (farther
    /// than 2^20 px in `f32`, 2^49 px in `f64`).
    pub fn pixel(&self) -> Option<Point2<T>> {
        let (x, y, w) = (self.homogeneous.x, self.homogeneous.y, self.homogeneous.z);
        (w.abs() > T::EPSILON * T::of(8.0)).then(|| Point2::new(x / w, y / w))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_and_foot() {
        // 3 u + 4 v = 10.
        let line = Line::new(&Vector3::new(6.0, 8.0, -20.0_f64)).expect("a line");
        assert_eq!(line.distance_px(&Point2::new(5.0, 5.0)), 5.0);
        assert_eq!(line.nearest(&Point2::new(5.0, 5.0)), Point2::new(2.0, 1.0));
        assert_eq!(Line::new(&Vector3::new(0.0, 0.0, 1.0_f64)), None);
    }

    #[test]
    fn an_epipole_may_be_at_infinity() {
        assert_eq!(Epipole::new(&Vector3::new(6.0, 8.0, 2.0_f64)).pixel(), Some(Point2::new(3.0, 4.0)));
        let far = Epipole::new(&Vector3::new(3.0, 4.0, 0.0_f64));
        assert_eq!((far.pixel(), *far.homogeneous()), (None, Vector3::new(0.6, 0.8, 0.0)));
    }
}
