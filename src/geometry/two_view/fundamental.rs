//! The fundamental matrix (Hartley & Zisserman 2004, 9.2): two views in pixels.

use super::essential::{Essential, EssentialError};
use super::line::{Epipole, Line};
use crate::geometry::camera::{Camera, Pose};
use crate::geometry::{Real, linear};
use nalgebra::{Matrix3, Point2, Vector3};

/// F, with `p^T F p' = 0` for a point seen at p in the first and at p' in the second image, both homogeneous
/// px (Hartley & Zisserman 2004, 9.2; there, and in OpenCV, with the images exchanged: `x2^T F x1 = 0`, the
/// transpose).
///
/// Singular. Its scale says nothing; it is held with `|F| = 1` (the root of the sum of its elements'
/// squares).
///
/// In `f32` distances to it are good to a few thousandths of a pixel in images of 640 x 480, mostly ten times
/// better: F has three orders of magnitude between its elements and more, and `p^T F p'` is a difference of
/// numbers near one.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Fundamental<T: Real> {
    matrix: Matrix3<T>,
}

deserialize_checked! { Fundamental<T> { matrix: Matrix3<T> } by |stored| Self::from_matrix(&stored.matrix) }

/// Why a matrix is no fundamental matrix.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FundamentalError {
    /// A number is infinite or not a number.
    NotFinite,
    /// The matrix has rank one or less, where two is needed.
    Rank,
}

error_text!(FundamentalError {
    Self::NotFinite => "a number of the matrix is not finite",
    Self::Rank => "the matrix has rank one or less",
});

impl<T: Real> Fundamental<T> {
    /// The singular matrix that is nearest to `matrix`, after rows and columns were brought to one size:
    /// pixels and the homogeneous one differ by orders of magnitude, and so do the elements of F.
    pub fn from_matrix(matrix: &Matrix3<T>) -> Result<Self, FundamentalError> {
        if !matrix.iter().all(|x| x.is_finite()) {
            return Err(FundamentalError::NotFinite);
        }
        let balanced = Balanced::new(matrix).ok_or(FundamentalError::Rank)?;
        let svd = linear::Svd3::new(&balanced.matrix);
        if !(svd.values[1] > svd.values[0] * T::EPSILON * T::of(16.0)) {
            return Err(FundamentalError::Rank);
        }
        let [_, _, v] = linear::columns3(&svd.v);
        let singular = balanced.matrix - balanced.matrix * v * v.transpose();
        Self::of_singular(&balanced.restored(&singular)).sound().ok_or(FundamentalError::NotFinite)
    }

    /// Whether it is of size one, which what is not finite is not.
    pub(crate) fn is_sound(&self) -> bool {
        (self.matrix.norm_squared() - T::ONE).abs() < T::of(2e-4)
    }

    /// This matrix, if it is of size one.
    pub(crate) fn sound(self) -> Option<Self> {
        self.is_sound().then_some(self)
    }

    /// The matrix at size one, of what is known to be singular and finite.
    pub(crate) fn of_singular(matrix: &Matrix3<T>) -> Self {
        let scaled = matrix / matrix.amax();
        Self { matrix: scaled / scaled.norm() }
    }

    /// The matrix at size one, of the rows of what is known to be singular and finite.
    pub(crate) fn of_rows(mut rows: [[T; 3]; 3]) -> Self {
        linear::unit(rows.as_flattened_mut());
        Self { matrix: linear::matrix3(&rows) }
    }

    /// `F = K^-T E K'^-1`.
    ///
    /// Lenses are not in it: it holds for undistorted pixels ([`Camera::undistort`]).
    pub fn from_essential(essential: &Essential<T>, first: &Camera<T>, second: &Camera<T>) -> Self {
        let left = linear::product(&first.inverse_matrix().transpose(), essential.matrix());
        Self::of_singular(&linear::product(&left, &second.inverse_matrix()))
    }

    /// `F = K^-T [t]x R K'^-1`, of two cameras and the pose of the second beside the first.
    pub fn from_cameras(
        pose: &Pose<T>,
        first: &Camera<T>,
        second: &Camera<T>,
    ) -> Result<Self, EssentialError> {
        Ok(Self::from_essential(&Essential::from_pose(pose)?, first, second))
    }

    /// What OpenCV writes as F, with `x2^T F x1 = 0`: the transpose.
    pub fn from_opencv(matrix: &Matrix3<T>) -> Result<Self, FundamentalError> {
        Self::from_matrix(&matrix.transpose())
    }

    /// The matrix in OpenCV's order, `x2^T F x1 = 0`.
    pub fn to_opencv(&self) -> Matrix3<T> {
        self.matrix.transpose()
    }

    /// F, with |F| = 1.
    pub fn matrix(&self) -> &Matrix3<T> {
        &self.matrix
    }

    /// The fundamental matrix with the images exchanged: the transpose.
    pub fn swapped(&self) -> Self {
        Self { matrix: self.matrix.transpose() }
    }

    /// `l = F p'`: the line of the first image on which what the second shows at `second` is seen. `None` for
    /// the epipole (to rounding), whose line is undetermined, and where the line is the one at infinity.
    pub fn line_in_first(&self, second: &Point2<T>) -> Option<Line<T>> {
        let line = self.matrix * second.to_homogeneous();
        // At the epipole nothing is left of the sums but their rounding.
        let terms = self.matrix.abs() * second.to_homogeneous().abs();
        let rounding = T::EPSILON * T::of(4.0) * terms.x.max(terms.y);
        if line.x.abs().max(line.y.abs()) <= rounding { None } else { Line::new(&line) }
    }

    /// `l' = F^T p`: the line of the second image on which what the first shows at `first` is seen. `None`
    /// where [`Self::line_in_first`] has none.
    pub fn line_in_second(&self, first: &Point2<T>) -> Option<Line<T>> {
        self.swapped().line_in_first(first)
    }

    /// The epipole e, the second camera's centre in the first image: `F^T e = 0`.
    pub fn epipole_in_first(&self) -> Epipole<T> {
        orthogonal(linear::columns3(&self.matrix))
    }

    /// The epipole e', the first camera's centre in the second image: `F e' = 0`.
    pub fn epipole_in_second(&self) -> Epipole<T> {
        self.swapped().epipole_in_first()
    }
}

impl<T: Real> Essential<T> {
    /// `E = K^T F K'`, and the nearest essential matrix of that.
    ///
    /// F knows nothing of lenses: the correspondences it came from have to be undistorted ones
    /// ([`Camera::undistort`]).
    pub fn from_fundamental(
        fundamental: &Fundamental<T>,
        first: &Camera<T>,
        second: &Camera<T>,
    ) -> Result<Self, EssentialError> {
        let right = linear::product(&first.matrix().transpose(), fundamental.matrix());
        Self::nearest(&linear::product(&right, &second.matrix()))
    }
}

/// What is orthogonal to three vectors in a plane: the cross product of the two that are the farthest from
/// parallel. Each component keeps its own digits, however different their sizes.
fn orthogonal<T: Real>([a, b, c]: [Vector3<T>; 3]) -> Epipole<T> {
    let candidate = |a: Vector3<T>, b: Vector3<T>| {
        let (sizes, cross) = (a.norm_squared() * b.norm_squared(), a.cross(&b));
        let sine = if sizes > T::ZERO { cross.norm_squared() / sizes } else { T::ZERO };
        (sine, cross)
    };
    let mut best = candidate(a, b);
    for other in [candidate(a, c), candidate(b, c)] {
        if other.0 > best.0 {
            best = other;
        }
    }
    Epipole::new(&best.1)
}

/// A matrix whose rows and columns were divided by their largest elements.
struct Balanced<T: Real> {
    matrix: Matrix3<T>,
    rows: Vector3<T>,
    columns: Vector3<T>,
}

impl<T: Real> Balanced<T> {
    /// `None` when the matrix is zero.
    fn new(matrix: &Matrix3<T>) -> Option<Self> {
        let size = matrix.amax();
        if size == T::ZERO {
            return None;
        }
        let mut matrix = matrix / size;
        let (mut rows, mut columns) = (Vector3::from_element(T::ONE), Vector3::from_element(T::ONE));
        let by = |size: T| if size > T::ZERO { size } else { T::ONE };
        for (mut row, scale) in matrix.row_iter_mut().zip(rows.iter_mut()) {
            *scale = by(row.amax());
            row /= *scale;
        }
        for (mut column, scale) in matrix.column_iter_mut().zip(columns.iter_mut()) {
            *scale = by(column.amax());
            column /= *scale;
        }
        Some(Self { matrix, rows, columns })
    }

    /// A matrix of the balanced size, back at the size of the original.
    fn restored(&self, matrix: &Matrix3<T>) -> Matrix3<T> {
        Matrix3::from_fn(|i, j| matrix[(i, j)] * self.rows[i] * self.columns[j])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectified_pair() {
        // f = 500, camera 2 to the right: F is [0 0 0; 0 0 -1; 0 1 0], rows equal, epipoles at infinity along
        // u.
        let camera = Camera::new(500.0, 500.0, 320.0, 240.0_f64).expect("a camera");
        let pose = Pose::new(Matrix3::identity(), Vector3::new(0.1, 0.0, 0.0)).expect("a pose");
        let f = Fundamental::from_cameras(&pose, &camera, &camera).expect("a baseline");
        let expected = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0) / 2.0_f64.sqrt();
        assert!((f.matrix() - expected).amax() < 1e-15, "{}", f.matrix());
        let line = f.line_in_first(&Point2::new(100.0, 33.0)).expect("a line");
        assert!((line.distance_px(&Point2::new(500.0, 35.0)).abs() - 2.0).abs() < 1e-12);
        assert_eq!(f.epipole_in_first().pixel(), None);
        assert_eq!(f.epipole_in_second().homogeneous().xy().map(f64::abs), nalgebra::Vector2::new(1.0, 0.0));
    }

    #[test]
    fn a_camera_that_moves_forward() {
        // The epipoles are the principal points.
        let camera = Camera::new(500.0, 500.0, 320.0, 240.0_f64).expect("a camera");
        let pose = Pose::new(Matrix3::identity(), Vector3::new(0.0, 0.0, 1.0)).expect("a pose");
        let f = Fundamental::from_cameras(&pose, &camera, &camera).expect("a baseline");
        for epipole in [f.epipole_in_first(), f.epipole_in_second()] {
            let pixel = epipole.pixel().expect("it is in the image");
            assert!((pixel - Point2::new(320.0, 240.0)).amax() < 1e-9, "{pixel}");
        }
        assert_eq!(f.line_in_first(&Point2::new(320.0, 240.0)), None, "every line goes through the epipole");
    }

    #[test]
    fn the_nearest_singular_matrix() {
        let f = Fundamental::from_matrix(&Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 1.0_f64)))
            .expect("a rank");
        assert!(f.matrix().determinant().abs() < 1e-15);
        assert_eq!(Fundamental::from_matrix(&Matrix3::<f64>::from_element(2.0)), Err(FundamentalError::Rank));
        assert_eq!(Fundamental::from_matrix(&Matrix3::<f64>::zeros()), Err(FundamentalError::Rank));
        assert_eq!(
            Fundamental::from_matrix(&Matrix3::from_element(f32::NAN)),
            Err(FundamentalError::NotFinite)
        );
    }
}
