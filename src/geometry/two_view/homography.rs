//! The homography of a plane or a rotation, by the direct linear transform, DLT.

use super::correspondence::Correspondence;
use super::degenerate;
use super::normalise::Both;
use super::weighted::Weighted;
use crate::geometry::Real;
use crate::geometry::camera::{Camera, Pose};
use crate::geometry::linear::{Ldl, Projective, columns3, matrix3, null_of_rows, rank, rows3};
use nalgebra::{Matrix3, Point2, Vector3};

/// The homography H, with `p ~ H p'`: from a pixel of the second image to that of the first, homogeneous px.
/// OpenCV's goes from the first to the second, `x2 ~ H x1`: the inverse.
///
/// For cameras `K (P = R P' + t)` and the plane `n^T P' = d` of camera 2: `H = K (R + t n^T / d) K'^-1`
/// (Hartley & Zisserman 2004, 13.1). Held with |H| = 1.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Homography<T: Real> {
    matrix: Matrix3<T>,
    #[cfg_attr(feature = "serde", serde(skip_serializing))]
    inverse: Matrix3<T>,
}

// An inverse that was stored has been rounded: less is asked of what is read.
deserialize_checked! {
    Homography<T> { matrix: Matrix3<T> } by |stored| Self::checked(&stored.matrix, LEAST / 4.0)
}

/// How far from singular a matrix has to be, in steps between numbers.
const LEAST: f64 = 16.0;

/// Why there is no homography.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum HomographyError {
    /// A number is infinite or not a number.
    NotFinite,
    /// Fewer than four correspondences.
    TooFew,
    /// Fewer than four that are not the same.
    Repeated,
    /// All of them but one, or more, are on a line in one of the images.
    Line,
    /// The matrix maps a plane to a line or a point.
    Singular,
}

error_text!(HomographyError {
    Self::NotFinite => "a number is not finite",
    Self::TooFew => "a homography needs four correspondences",
    Self::Repeated => "a homography needs four correspondences that are not the same",
    Self::Line => "all correspondences but one are on a line",
    Self::Singular => "the matrix is singular",
});

impl<T: Real> Homography<T> {
    /// The homography of a matrix, of any scale but zero.
    pub fn from_matrix(matrix: &Matrix3<T>) -> Result<Self, HomographyError> {
        Self::checked(matrix, LEAST)
    }

    /// The homography of a matrix that is farther from singular than `least`.
    fn checked(matrix: &Matrix3<T>, least: f64) -> Result<Self, HomographyError> {
        if !matrix.iter().all(|x| x.is_finite()) {
            return Err(HomographyError::NotFinite);
        }
        let size = matrix.amax();
        if size == T::ZERO {
            return Err(HomographyError::Singular);
        }
        let scaled = matrix / size;
        let matrix = scaled / scaled.norm();
        // The inverse but for its scale: the columns' cross products are its rows.
        let [a, b, c] = columns3(&matrix);
        let rows = [b.cross(&c), c.cross(&a), a.cross(&b)];
        // How the last column stands to the others, and the last row to the other rows, which is the same of
        // the inverse: either is enough, so that a matrix and its inverse are judged alike.
        let determinant = rows[2].dot(&c);
        let across = Vector3::new(rows[0].z, rows[1].z, rows[2].z);
        let [columns, lines] = [rows[2].norm() * c.norm(), across.norm() * matrix.row(2).norm()];
        if !(determinant.abs() > columns.min(lines) * T::EPSILON * T::of(least)) {
            return Err(HomographyError::Singular);
        }
        let inverse = Matrix3::from_rows(&rows.map(|row| row.transpose() / determinant));
        if !inverse.norm_squared().is_finite() {
            return Err(HomographyError::Singular);
        }
        Ok(Self { matrix, inverse })
    }

    /// What a plane does: `n^T P' = d` in camera 2 (n of length one, d in the pose's unit).
    pub fn from_plane(
        pose: &Pose<T>,
        first: &Camera<T>,
        second: &Camera<T>,
        normal: &Vector3<T>,
        distance: T,
    ) -> Result<Self, HomographyError> {
        let euclidean = pose.rotation() + pose.translation() * normal.transpose() / distance;
        Self::from_matrix(&(first.matrix() * euclidean * second.inverse_matrix()))
    }

    /// The least-squares homography of four correspondences or more (the direct linear transform on
    /// normalised points, Hartley & Zisserman 2004, algorithm 4.2); all are used.
    ///
    /// Four exact ones give the homography to rounding. With noise the algebraic error is least, which is
    /// close to the transfer error.
    pub fn from_correspondences(seen: &[Correspondence<T>]) -> Result<Self, HomographyError> {
        if seen.len() < 4 {
            return Err(HomographyError::TooFew);
        }
        if !seen.iter().all(Correspondence::is_finite) {
            return Err(HomographyError::NotFinite);
        }
        let alike = Weighted::alike(seen);
        let Some(both) = Both::of(alike) else { return Err(HomographyError::Repeated) };
        let (matrix, is_one) = match <&[Correspondence<T>; 4]>::try_from(seen) {
            Ok(four) => of_four(four.map(|s| both.apply(&s))),
            Err(_) => least_squares(seen.iter().map(|s| both.apply(s))),
        };
        if !is_one {
            let fourth = degenerate::distinct::<T, 4>(alike) >= 4;
            return Err(if fourth { HomographyError::Line } else { HomographyError::Repeated });
        }
        let matrix = both.first.before(&both.second.after(&matrix));
        Self::from_matrix(&matrix).map_err(|error| match error {
            HomographyError::Singular => HomographyError::Line,
            other => other,
        })
    }

    /// What OpenCV writes as H, `x2 ~ H x1`: the inverse.
    pub fn from_opencv(matrix: &Matrix3<T>) -> Result<Self, HomographyError> {
        Ok(Self::from_matrix(matrix)?.inverse())
    }

    /// The matrix as OpenCV writes it, `x2 ~ H x1`, with its last element one unless that is zero.
    pub fn to_opencv(&self) -> Matrix3<T> {
        let last = self.inverse.m33;
        if last == T::ZERO { self.inverse } else { self.inverse / last }
    }

    /// H, with |H| = 1.
    pub fn matrix(&self) -> &Matrix3<T> {
        &self.matrix
    }

    /// From the first image to the second.
    pub fn inverse(&self) -> Self {
        let size = self.inverse.norm();
        Self { matrix: self.inverse / size, inverse: self.matrix * size }
    }

    /// The point p of a p', px; `None` where the homography puts it at infinity.
    pub fn to_first(&self, second: &Point2<T>) -> Option<Point2<T>> {
        finite(Point2::from_homogeneous(self.matrix * second.to_homogeneous()))
    }

    /// The point p' of a p, px; `None` where the homography puts it at infinity.
    pub fn to_second(&self, first: &Point2<T>) -> Option<Point2<T>> {
        finite(Point2::from_homogeneous(self.inverse * first.to_homogeneous()))
    }

    /// The symmetric transfer error squared, px^2: `|p - H p'|^2 + |p' - H^-1 p|^2` (Hartley & Zisserman
    /// 2004, 4.7); infinite when one of the two is at infinity.
    pub fn symmetric_squared_px2(&self, seen: &Correspondence<T>) -> T {
        match (self.to_first(&seen.second), self.to_second(&seen.first)) {
            (Some(first), Some(second)) => {
                (first - seen.first).norm_squared() + (second - seen.second).norm_squared()
            }
            _ => T::ONE / T::ZERO,
        }
    }
}

/// The two equations of a pair for the elements of H, row by row.
fn equations<T: Real>((p, q): (Point2<T>, Point2<T>)) -> [[T; 9]; 2] {
    let (o, l) = (T::ZERO, T::ONE);
    [
        [q.x, q.y, l, o, o, o, -p.x * q.x, -p.x * q.y, -p.x], //
        [o, o, o, q.x, q.y, l, -p.y * q.x, -p.y * q.y, -p.y],
    ]
}

/// H of four normalised correspondences, |H| = 1, and whether it is the only one.
fn of_four<T: Real>([a, b, c, d]: [(Point2<T>, Point2<T>); 4]) -> (Matrix3<T>, bool) {
    let ([a0, a1], [b0, b1], [c0, c1], [d0, d1]) = (equations(a), equations(b), equations(c), equations(d));
    let (h, pivots) = null_of_rows(&mut [a0, a1, b0, b1, c0, c1, d0, d1]);
    (matrix3(&rows3(h)), rank(&pivots, T::of(1e-6).max(T::EPSILON * T::of(32.0))) == 8)
}

/// H of more normalised correspondences than four, |H| = 1, and whether it is the only one.
pub(crate) fn least_squares<T: Real>(
    seen: impl Iterator<Item = (Point2<T>, Point2<T>)>,
) -> (Matrix3<T>, bool) {
    let mut sums = Projective::<T, 3>::new();
    for (p, q) in seen {
        sums.add(p.x, p.y, &[q.x, q.y, T::ONE]);
    }
    let ldl = Ldl::<T, 9>::new(&mut sums.normal_matrix());
    (matrix3(&rows3(ldl.null_vector())), rank(ldl.pivots(), T::EPSILON * T::of(32.0)) >= 8)
}

/// A place that numbers reach.
fn finite<T: Real>(place: Option<Point2<T>>) -> Option<Point2<T>> {
    place.filter(|p| p.x.is_finite() && p.y.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(to: [(f64, f64); 4]) -> [Correspondence<f64>; 4] {
        let from = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        core::array::from_fn(|i| Correspondence::new(to[i].0, to[i].1, from[i].0, from[i].1))
    }

    #[test]
    fn four_corners() {
        // p = p' / (1 + u' / 2): the side at u' = 2 is halved.
        let h = Homography::from_correspondences(&square([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 2.0)]))
            .expect("H");
        let expected = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.0, 1.0);
        assert!((h.matrix() / h.matrix().m33 - expected).amax() < 1e-14, "{}", h.matrix());
        let middle = h.to_first(&Point2::new(1.0, 1.0)).expect("it is finite");
        assert!((middle - Point2::new(2.0 / 3.0, 2.0 / 3.0)).amax() < 1e-15);
        assert!((h.to_second(&middle).expect("it is finite") - Point2::new(1.0, 1.0)).amax() < 1e-14);
        assert!((h.to_opencv() * expected - Matrix3::identity()).amax() < 1e-14);
        // One px off in the first image: 1 there, and in the second (5/3, 2/3) to (10, 4) / 1.
        let off = Correspondence::new(5.0 / 3.0, 2.0 / 3.0, 1.0, 1.0);
        let there = h.to_second(&off.first).expect("it is finite");
        assert!((h.symmetric_squared_px2(&off) - 1.0 - (there - off.second).norm_squared()).abs() < 1e-12);
    }

    #[test]
    fn what_has_none_is_refused() {
        use HomographyError::{Line, NotFinite, Repeated, Singular, TooFew};
        let of = |to| Homography::from_correspondences(&square(to));
        assert_eq!(of([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 2.0)]), Err(Line));
        assert_eq!(of([(0.0, 0.0), (1.0, 0.0), (f64::NAN, 0.0), (0.0, 2.0)]), Err(NotFinite));
        assert_eq!(of([(1.0, 2.0); 4]), Err(Repeated));
        let good = square([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 2.0)]);
        assert_eq!(Homography::from_correspondences(&good[..3]), Err(TooFew));
        assert_eq!(Homography::from_correspondences(&[good[0], good[1], good[2], good[2]]), Err(Repeated));
        assert_eq!(Homography::from_matrix(&Matrix3::<f64>::from_element(1.0)), Err(Singular));
    }

    #[test]
    fn a_matrix_and_its_inverse_are_judged_alike() {
        // The last column is 1e-7 of its length from the plane of the others, and no row is near the others'.
        let leaning = Matrix3::new(1.0, 0.0, 1e3, 0.0, 1.0, 1e3, 0.0, 0.0, 1e-4_f32);
        for matrix in [leaning, leaning.transpose()] {
            let h = Homography::from_matrix(&matrix).expect("H");
            let again = Homography::from_matrix(h.inverse().matrix()).expect("its inverse");
            assert!((again.inverse().matrix() - h.matrix()).amax() < 1e-5, "{matrix}");
        }
    }
}
