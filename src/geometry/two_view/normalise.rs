//! Hartley's normalisation of pixels (Hartley 1997).

use super::correspondence::Correspondence;
use super::weighted::{Image, Weighted};
use crate::geometry::Real;
use crate::geometry::linear::transposed3;
use nalgebra::{Matrix3, Point2, RowVector3};

/// `x = s (u - cx)`, `y = s (v - cy)`: the points' centroid goes to the origin and their root mean square
/// distance from it to the root of two (Hartley 1997; Hartley & Zisserman 2004, 4.4.4).
#[derive(Clone, Copy)]
pub(crate) struct Normalisation<T: Real> {
    scale: T,
    cx: T,
    cy: T,
}

impl<T: Real> Normalisation<T> {
    /// The normalisation of one image's points, whatever they weigh; `None` when all are one point, to the
    /// rounding of their mean.
    #[inline(never)]
    pub(crate) fn of(seen: Weighted<'_, T>, image: Image) -> Option<Self> {
        let points = seen.iter().map(|(s, _)| image.point(s));
        let (x, y, count) =
            points.clone().fold((T::ZERO, T::ZERO, 0), |(x, y, n), p| (x + p.x, y + p.y, n + 1));
        let per_point = T::ONE / T::count(count);
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

    /// The normalised (x, y) of a pixel.
    #[inline(always)]
    pub(crate) fn apply(&self, pixel: Point2<T>) -> Point2<T> {
        Point2::new((pixel.x - self.cx) * self.scale, (pixel.y - self.cy) * self.scale)
    }

    /// The line `l N` of pixels, of a line l of normalised points.
    #[inline(always)]
    fn of_line(&self, [a, b, c]: [T; 3]) -> [T; 3] {
        let (a, b) = (a * self.scale, b * self.scale);
        [a, b, c - a * self.cx - b * self.cy]
    }

    /// `M N`, where N is this normalisation as a matrix: from something that takes normalised points to the
    /// same for px.
    pub(crate) fn after(&self, m: &Matrix3<T>) -> Matrix3<T> {
        let row = |i: usize| RowVector3::from(self.of_line([m[(i, 0)], m[(i, 1)], m[(i, 2)]]));
        Matrix3::from_rows(&[row(0), row(1), row(2)])
    }

    /// `N^-1 M`: from something that gives normalised points to the same that gives px.
    pub(crate) fn before(&self, m: &Matrix3<T>) -> Matrix3<T> {
        let per_scale = T::ONE / self.scale;
        let z = RowVector3::new(m.m31, m.m32, m.m33);
        Matrix3::from_rows(&[m.row(0) * per_scale + z * self.cx, m.row(1) * per_scale + z * self.cy, z])
    }
}

/// The normalisations of both images.
pub(crate) struct Both<T: Real> {
    pub(crate) first: Normalisation<T>,
    pub(crate) second: Normalisation<T>,
}

impl<T: Real> Both<T> {
    /// `None` when all points of an image are one.
    pub(crate) fn of(seen: Weighted<'_, T>) -> Option<Self> {
        let [first, second] = [Image::First, Image::Second].map(|image| Normalisation::of(seen, image));
        Some(Self { first: first?, second: second? })
    }

    /// A correspondence, normalised.
    #[inline(always)]
    pub(crate) fn apply(&self, seen: &Correspondence<T>) -> (Point2<T>, Point2<T>) {
        (self.first.apply(seen.first), self.second.apply(seen.second))
    }

    /// F of pixels, of that of normalised points: `N^T F N'`.
    pub(crate) fn in_pixels(&self, mut f: [[T; 3]; 3]) -> [[T; 3]; 3] {
        // Of every row, and then of every column, which are the rows of the transpose.
        for side in [&self.second, &self.first] {
            for row in &mut f {
                *row = side.of_line(*row);
            }
            f = transposed3(f);
        }
        f
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn a_square_of_side_two() {
        let square = [(9.0, 4.0), (11.0, 4.0), (11.0, 6.0), (9.0, 6.0_f64)]
            .map(|(u, v)| Correspondence::new(u, v, 0.0, 0.0));
        let n = Normalisation::of(Weighted::alike(&square), Image::First).expect("four points");
        assert_eq!(
            square.map(|s| n.apply(s.first)),
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Point2::new(x, y))
        );
        // As a matrix N, and N^-1 N = 1.
        let matrix = n.after(&Matrix3::identity());
        assert_eq!(matrix * Vector3::new(11.0, 6.0, 1.0), Vector3::new(1.0, 1.0, 1.0));
        assert_eq!(n.before(&matrix), Matrix3::identity());
        assert!(Normalisation::of(Weighted::alike(&square), Image::Second).is_none());
        assert!(Both::of(Weighted::alike(&square)).is_none());
    }
}
