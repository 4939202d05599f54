//! Hartley's normalisation: what makes an estimate from pixels well conditioned.

use super::Real;
use nalgebra::{Matrix3, Point2, RowVector3};

/// `x = s (u - cx)`, `y = s (v - cy)`: the points' centroid goes to the origin and their root mean square distance from
/// it to the root of two (Hartley 1997; Hartley & Zisserman 2004, 4.4.4).
#[derive(Clone, Copy)]
pub(crate) struct Normalisation<T: Real> {
    scale: T,
    cx: T,
    cy: T,
}

impl<T: Real> Normalisation<T> {
    /// Of `count` points; `None` when all are one point, to the rounding of their mean.
    #[inline(always)]
    pub(crate) fn of(points: impl Iterator<Item = Point2<T>> + Clone, count: usize) -> Option<Self> {
        let per_point = T::ONE / T::count(count);
        let (x, y) = points.clone().fold((T::ZERO, T::ZERO), |(x, y), p| (x + p.x, y + p.y));
        let (cx, cy) = (x * per_point, y * per_point);
        let spread = points.fold(T::ZERO, |sum, p| {
            let (x, y) = (p.x - cx, p.y - cy);
            sum + x * x + y * y
        });
        let variance = spread * per_point;
        let rounding = (cx.abs() + cy.abs()) * T::EPSILON;
        if !(variance > rounding * rounding) {
            return None;
        }
        Some(Self { scale: (T::of(2.0) / variance).sqrt(), cx, cy })
    }

    /// (x, y) of a pixel.
    #[inline(always)]
    pub(crate) fn apply(&self, pixel: Point2<T>) -> Point2<T> {
        Point2::new((pixel.x - self.cx) * self.scale, (pixel.y - self.cy) * self.scale)
    }

    /// `M N`, where N is this normalisation as a matrix: from something that takes normalised points to the same for px.
    #[inline(always)]
    pub(crate) fn after(&self, m: &Matrix3<T>) -> Matrix3<T> {
        let (a, b) = (m.column(0) * self.scale, m.column(1) * self.scale);
        let c = m.column(2) - a * self.cx - b * self.cy;
        Matrix3::from_columns(&[a, b, c])
    }

    /// `N^-1 M`: from something that gives normalised points to the same that gives px.
    pub(crate) fn before(&self, m: &Matrix3<T>) -> Matrix3<T> {
        let per_scale = T::ONE / self.scale;
        let z = RowVector3::new(m.m31, m.m32, m.m33);
        Matrix3::from_rows(&[m.row(0) * per_scale + z * self.cx, m.row(1) * per_scale + z * self.cy, z])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn a_square_of_side_two() {
        let square = [(9.0, 4.0), (11.0, 4.0), (11.0, 6.0), (9.0, 6.0_f64)].map(|(u, v)| Point2::new(u, v));
        let n = Normalisation::of(square.into_iter(), 4).expect("four points");
        assert_eq!(
            square.map(|p| n.apply(p)),
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Point2::new(x, y))
        );
        // As a matrix N, and N^-1 N = 1.
        let matrix = n.after(&Matrix3::identity());
        assert_eq!(matrix * Vector3::new(11.0, 6.0, 1.0), Vector3::new(1.0, 1.0, 1.0));
        assert_eq!(n.before(&matrix), Matrix3::identity());
        assert!(Normalisation::of([square[0]; 5].into_iter(), 5).is_none());
    }
}
