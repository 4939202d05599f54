//! Normalised coordinates for an estimate, of the points (Hartley 1997) or of a camera.

use crate::geometry::Real;
use crate::geometry::camera::Camera;
use crate::geometry::two_view::Correspondence;
use nalgebra::{Matrix3, Point2, Vector2, Vector3};

/// `x = a (u - cx) + b (v - cy)`, `y = d (v - cy)`: an upper triangular matrix before homogeneous pixels.
#[derive(Clone, Copy)]
pub(super) struct Frame<T: Real> {
    a: T,
    b: T,
    d: T,
    cx: T,
    cy: T,
}

impl<T: Real> Frame<T> {
    /// A camera's `K^-1`: coordinates are those of the plane Z = 1.
    pub(super) fn of_camera(camera: &Camera<T>) -> Self {
        let inverse = camera.inverse_matrix();
        let (cx, cy) = camera.principal_point();
        Self { a: inverse.m11, b: inverse.m12, d: inverse.m22, cx, cy }
    }

    /// The frames of both images, with the means of their points at the origin and one scale for both, so
    /// that a distance is the same number of pixels in either: the root mean square of all points from
    /// their mean is the root of two. `None` when the points of an image are one point to rounding, or
    /// when the sums overflow.
    pub(super) fn of_points(seen: &[Correspondence<T>]) -> Option<[Self; 2]> {
        let per_point = T::ONE / T::count(seen.len());
        let zero = Vector2::zeros();
        let (first, second) =
            seen.iter().fold((zero, zero), |(p, q), s| (p + s.first.coords, q + s.second.coords));
        let (first, second) = (first * per_point, second * per_point);
        let (p, q) = seen.iter().fold((T::ZERO, T::ZERO), |(p, q), s| {
            (p + (s.first.coords - first).norm_squared(), q + (s.second.coords - second).norm_squared())
        });
        let apart = |spread: T, mean: &Vector2<T>| {
            let rounding = mean.amax() * T::EPSILON * T::of(4.0);
            spread * per_point > rounding * rounding
        };
        if !(apart(p, &first) && apart(q, &second) && (p + q).is_finite()) {
            return None;
        }
        let scale = (T::of(4.0) / ((p + q) * per_point)).sqrt();
        Some([first, second].map(|mean| Self { a: scale, b: T::ZERO, d: scale, cx: mean.x, cy: mean.y }))
    }

    /// The coordinates (x, y) of a pixel.
    #[inline(always)]
    pub(super) fn apply(&self, pixel: Point2<T>) -> Point2<T> {
        let (u, v) = (pixel.x - self.cx, pixel.y - self.cy);
        Point2::new(self.a * u + self.b * v, self.d * v)
    }

    /// The gradient of a function by (x, y), as its gradient by (u, v), and that again as a step of (x, y):
    /// `M M^T gradient`.
    #[inline(always)]
    pub(super) fn steepest(&self, x: T, y: T) -> (T, T) {
        let (u, v) = (self.a * x, self.b * x + self.d * y);
        (self.a * u + self.b * v, self.d * v)
    }

    /// The line `l M` of pixels, of a line l of the frame.
    #[inline(always)]
    pub(super) fn of_line(&self, l: &Vector3<T>) -> Vector3<T> {
        let (x, y) = (self.a * l.x, self.b * l.x + self.d * l.y);
        Vector3::new(x, y, l.z - x * self.cx - y * self.cy)
    }

    /// The matrix of the frame, `x = M u`.
    pub(super) fn matrix(&self) -> Matrix3<T> {
        let Self { a, b, d, cx, cy } = *self;
        let (o, l) = (T::ZERO, T::ONE);
        Matrix3::new(a, b, -a * cx - b * cy, o, d, -d * cy, o, o, l)
    }

    /// The inverse of the matrix.
    pub(super) fn inverse(&self) -> Matrix3<T> {
        let Self { a, b, d, cx, cy } = *self;
        let (o, l) = (T::ZERO, T::ONE);
        Matrix3::new(l / a, -b / (a * d), cx, o, l / d, cy, o, o, l)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKEWED: Frame<f64> = Frame { a: 0.01, b: -0.002, d: 0.03, cx: 320.0, cy: 250.0 };

    #[test]
    fn all_ways_are_those_of_the_matrix() {
        let (m, pixel) = (SKEWED.matrix(), Point2::new(17.0, 401.0));
        let there = m * pixel.to_homogeneous();
        assert!((SKEWED.apply(pixel).to_homogeneous() - there).amax() < 1e-12);
        assert!((SKEWED.inverse() * m - Matrix3::identity()).amax() < 1e-12);
        let line = Vector3::new(0.3, -0.7, 0.4);
        assert!((SKEWED.of_line(&line) - m.tr_mul(&line)).amax() < 1e-12);
        let linear = m.fixed_view::<2, 2>(0, 0);
        let (x, y) = SKEWED.steepest(line.x, line.y);
        assert!((Vector2::new(x, y) - linear * linear.transpose() * line.xy()).amax() < 1e-15);
    }

    #[test]
    fn points_of_both_images_have_their_mean_at_the_origin_and_one_scale() {
        // One image has the corners of a square of 20 px, the other one of 60 px, elsewhere.
        let seen = [(0, 0), (0, 20), (20, 0), (20, 20)].map(|(u, v)| {
            let (u, v) = (f64::from(u), f64::from(v));
            Correspondence::new(u + 7.0, v - 5.0, 3.0 * u - 100.0, 3.0 * v)
        });
        let [first, second] = Frame::of_points(&seen).expect("points that are apart");
        let corners = seen.map(|s| [first.apply(s.first), second.apply(s.second)]);
        for image in 0..2 {
            let sum = corners.iter().fold(Vector2::zeros(), |sum, both| sum + both[image].coords);
            assert!(sum.amax() < 1e-12, "{sum}");
        }
        let [near, far] = [0, 1].map(|image| corners[3][image].coords.norm());
        assert!((far / near - 3.0).abs() < 1e-12, "{near} {far}");
        assert!(((near * near + far * far) / 2.0 - 2.0).abs() < 1e-12, "{near} {far}");
    }

    #[test]
    fn points_that_are_one_to_rounding_have_no_frame() {
        let seen = |apart: f64, other: f64| {
            [-1.0, 1.0].map(|side| Correspondence::new(1.0 + side * apart, 1.0, side * other, 2.0))
        };
        assert!(Frame::of_points(&seen(1e-3, 1.0)).is_some());
        assert!(Frame::of_points(&seen(1e-16, 1.0)).is_none());
        assert!(Frame::of_points(&seen(1.0, 1e-16)).is_none());
        assert!(Frame::of_points(&seen(1e200, 1.0)).is_none(), "the sums overflow");
        // Four units in the last place of a number like 1024 are rounding, five are not.
        let units = |count: f64| {
            let by = count * f64::EPSILON * 1024.0;
            let seen = [-by, by].map(|by| Correspondence::new(7.0, 1024.0 + by, 1024.0 + by, 3.0));
            let apart = [-1.0, 1.0].map(|by| Correspondence::new(7.0 + by, 5.0, 5.0, 3.0 + by));
            let mixed = |k: usize| Correspondence { first: seen[k].first, second: apart[k].second };
            [Frame::of_points(&seen).is_some(), Frame::of_points(&[mixed(0), mixed(1)]).is_some()]
        };
        assert_eq!([2.0, 4.0, 5.0, 9.0].map(units), [[false; 2], [false; 2], [true; 2], [true; 2]]);
    }
}
