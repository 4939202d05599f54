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
