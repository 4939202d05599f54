//! The essential matrix (Longuet-Higgins 1981): two views in the cameras' own frames.

use crate::geometry::Real;
use crate::geometry::camera::Pose;
use crate::geometry::linear::{Svd3, columns3, product, skew};
use nalgebra::{Matrix3, Vector3};

/// `E = [t]x R`, with `p^T E p' = 0` for rays p of camera 1 and p' of camera 2, and `P = R P' + t`
/// (Longuet-Higgins 1981; Hartley & Zisserman 2004, 9.6).
///
/// Its scale says nothing; it is held with singular values (1, 1, 0), which stands for |t| = 1.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Essential<T: Real> {
    matrix: Matrix3<T>,
}

deserialize_checked! { Essential<T> { matrix: Matrix3<T> } by |stored| Self::nearest(&stored.matrix) }

/// Why there is no essential matrix.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum EssentialError {
    /// A number is infinite or not a number.
    NotFinite,
    /// The two cameras have one centre: t is zero.
    NoBaseline,
    /// The matrix has rank one or less, where two is needed.
    Rank,
}

error_text!(EssentialError {
    Self::NotFinite => "a number of the matrix is not finite",
    Self::NoBaseline => "the two cameras stand in one place",
    Self::Rank => "the matrix has rank one or less",
});

impl<T: Real> Essential<T> {
    /// `E = [t]x R`.
    pub fn from_pose(pose: &Pose<T>) -> Result<Self, EssentialError> {
        let t = pose.translation();
        let size = t.amax();
        if !size.is_finite() {
            return Err(EssentialError::NotFinite);
        }
        if size == T::ZERO {
            return Err(EssentialError::NoBaseline);
        }
        let scaled = t / size;
        Ok(Self { matrix: product(&skew(&(scaled / scaled.norm())), pose.rotation()) })
    }

    /// The essential matrix that is nearest to a matrix: its first two singular values by their mean, its
    /// third by zero (Hartley & Zisserman 2004, 11.7.3).
    pub fn nearest(matrix: &Matrix3<T>) -> Result<Self, EssentialError> {
        let size = matrix.amax();
        if !size.is_finite() {
            return Err(EssentialError::NotFinite);
        }
        if size == T::ZERO {
            return Err(EssentialError::Rank);
        }
        let Svd3 { u, values: [s0, s1, _], v } = Svd3::new(&(matrix / size));
        if !(s1 > s0 * T::EPSILON * T::of(16.0)) {
            return Err(EssentialError::Rank);
        }
        let [u0, u1, _] = columns3(&u);
        let matrix = product(&Matrix3::from_columns(&[u0, u1, Vector3::zeros()]), &v.transpose());
        // |E|^2 = 2 of singular values (1, 1, 0).
        let is_sound = (matrix.norm_squared() - T::of(2.0)).abs() < T::of(1e-3);
        if is_sound { Ok(Self { matrix }) } else { Err(EssentialError::NotFinite) }
    }

    /// What OpenCV writes as E, with `x2^T E x1 = 0`: the transpose.
    pub fn from_opencv(matrix: &Matrix3<T>) -> Result<Self, EssentialError> {
        Self::nearest(&matrix.transpose())
    }

    /// The matrix in OpenCV's order, `x2^T E x1 = 0`.
    pub fn to_opencv(&self) -> Matrix3<T> {
        self.matrix.transpose()
    }

    /// E, with singular values (1, 1, 0).
    pub fn matrix(&self) -> &Matrix3<T> {
        &self.matrix
    }

    /// `p^T E p'` of two rays: zero when they meet.
    pub fn residual(&self, first: &Vector3<T>, second: &Vector3<T>) -> T {
        first.dot(&(self.matrix * second))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parallel_cameras() {
        // Camera 2 two metres to the right: [t]x with t = (1, 0, 0).
        let pose = Pose::new(Matrix3::identity(), Vector3::new(2.0, 0.0, 0.0)).expect("a pose");
        let e = Essential::from_pose(&pose).expect("a baseline");
        assert_eq!(*e.matrix(), Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0_f64));
        // (1, 1, 4) of camera 1 is (-1, 1, 4) of camera 2: one row in both.
        assert_eq!(e.residual(&Vector3::new(0.25, 0.25, 1.0), &Vector3::new(-0.25, 0.25, 1.0)), 0.0);
        assert_eq!(Essential::from_pose(&Pose::<f64>::identity()), Err(EssentialError::NoBaseline));
    }

    #[test]
    fn the_nearest_one() {
        // diag(3, 1, 0.5): the first two become one.
        let e =
            Essential::nearest(&Matrix3::from_diagonal(&Vector3::new(3.0, 1.0, 0.5_f64))).expect("rank 2");
        assert!((e.matrix() - Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0))).amax() < 1e-15);
        assert_eq!(Essential::nearest(&Matrix3::<f64>::from_element(1.0)), Err(EssentialError::Rank));
        assert_eq!(Essential::nearest(&Matrix3::<f64>::zeros()), Err(EssentialError::Rank));
        assert_eq!(Essential::nearest(&Matrix3::from_element(f32::NAN)), Err(EssentialError::NotFinite));
    }
}
