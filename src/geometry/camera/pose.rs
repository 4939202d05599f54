//! The pose of one camera beside another: a rigid motion of SE(3), and its increment.

use crate::geometry::Real;
use crate::geometry::linear::{Svd3, all_finite, cayley};
use nalgebra::{Matrix3, Point3, Vector3};

/// R and t, which carry a point of camera 2 into camera 1: `P = R P' + t`. So t is the centre of camera 2 in
/// camera 1.
///
/// Lengths are metres, unless whoever made it says otherwise.
///
/// OpenCV's stereo pose goes the other way, `P' = R_cv P + T_cv`: [`Pose::from_opencv`], [`Pose::to_opencv`].
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Pose<T: Real> {
    rotation: Matrix3<T>,
    translation: Vector3<T>,
}

deserialize_checked! {
    Pose<T> { rotation: Matrix3<T>, translation: Vector3<T> }
    by |pose| Self::new(pose.rotation, pose.translation)
}

/// Why numbers are no pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PoseError {
    /// A number is infinite or not a number, or the square of the translation's length is.
    NotFinite,
    /// The matrix is no rotation: the square of a column's length is off by more than 2e-4, or the product of
    /// two columns is, or it mirrors.
    NotARotation,
}

error_text!(PoseError {
    Self::NotFinite => "a number of the pose is not finite",
    Self::NotARotation => "the matrix is no rotation",
});

impl<T: Real> Pose<T> {
    /// Camera 2 where camera 1 is.
    pub fn identity() -> Self {
        Self { rotation: Matrix3::identity(), translation: Vector3::zeros() }
    }

    /// Largest element of `R^T R - I`. Four decimals put each number off by 5e-5, which moves the square of a
    /// unit column's length by 1e-4 times the sum of its three numbers: by 1.74e-4 at most.
    pub(super) const TOLERANCE: f64 = 2e-4;

    /// No pose yet, in what waits for one. All zeros.
    pub(crate) const NOTHING: Self = {
        let o = T::ZERO;
        Self { rotation: Matrix3::new(o, o, o, o, o, o, o, o, o), translation: Vector3::new(o, o, o) }
    };

    /// A pose of a rotation that is given to four decimals or more; the nearest exact one is held.
    pub fn new(rotation: Matrix3<T>, translation: Vector3<T>) -> Result<Self, PoseError> {
        let tolerance = T::of(Self::TOLERANCE);
        let Self { rotation, translation } = Self::of_parts(rotation, translation).checked(tolerance)?;
        let svd = Svd3::new(&rotation);
        Ok(Self { rotation: svd.u * svd.v.transpose(), translation })
    }

    /// This pose, if it keeps what a pose promises: the matrix is a rotation, with `R^T R` off by `tolerance`
    /// at the most, and the length of the translation is a number.
    pub(crate) fn checked(self, tolerance: T) -> Result<Self, PoseError> {
        let Self { rotation, translation } = &self;
        if !(all_finite(rotation.as_slice()) && translation.norm_squared().is_finite()) {
            return Err(PoseError::NotFinite);
        }
        let off = (rotation.transpose() * rotation - Matrix3::identity()).amax();
        // What overflows is not less either.
        if !(off <= tolerance) || rotation.determinant() < T::ZERO {
            return Err(PoseError::NotARotation);
        }
        Ok(self)
    }

    /// [`Self::checked`] for what is computed: by [`Self::new`]'s tolerance, where sane numbers are off by
    /// rounding.
    pub(crate) fn sound(self) -> Option<Self> {
        self.checked(T::of(Self::TOLERANCE)).ok()
    }

    /// A pose of what is known to be a rotation.
    pub(crate) const fn of_parts(rotation: Matrix3<T>, translation: Vector3<T>) -> Self {
        Self { rotation, translation }
    }

    /// The pose that OpenCV's `stereoCalibrate` writes as R, T, with `P' = R P + T`.
    pub fn from_opencv(rotation: Matrix3<T>, translation: Vector3<T>) -> Result<Self, PoseError> {
        Ok(Self::new(rotation, translation)?.inverse())
    }

    /// R and T as OpenCV writes them: `P' = R P + T`.
    pub fn to_opencv(&self) -> (Matrix3<T>, Vector3<T>) {
        let Self { rotation, translation } = self.inverse();
        (rotation, translation)
    }

    /// The rotation R.
    pub fn rotation(&self) -> &Matrix3<T> {
        &self.rotation
    }

    /// The translation t, the centre of camera 2 in camera 1.
    pub fn translation(&self) -> &Vector3<T> {
        &self.translation
    }

    /// `P = R P' + t`: from camera 2 into camera 1.
    pub fn transform(&self, second: &Point3<T>) -> Point3<T> {
        Point3::from(self.rotation * second.coords + self.translation)
    }

    /// `P' = R^T (P - t)`: from camera 1 into camera 2.
    pub fn inverse_transform(&self, first: &Point3<T>) -> Point3<T> {
        Point3::from(self.rotation.tr_mul(&(first.coords - self.translation)))
    }

    /// Camera 1 as seen from camera 2.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation: -(rotation * self.translation) }
    }

    /// From camera 3 into camera 1, where `next` carries a point of camera 3 into camera 2.
    pub fn then(&self, next: &Self) -> Self {
        Self {
            rotation: self.rotation * next.rotation,
            translation: self.rotation * next.translation + self.translation,
        }
    }

    /// The pose after a step in its tangent space: three numbers that rotate it about the camera's own axes
    /// (radians to first order, Cayley's map) and three that move it along them.
    pub(crate) fn moved(&self, &[a, b, c, x, y, z]: &[T; 6]) -> Self {
        let rotation = self.rotation * cayley(&Vector3::new(a, b, c));
        Self { rotation, translation: self.translation + rotation * Vector3::new(x, y, z) }
    }

    /// What many products of rotations have drifted to, as a rotation again (Gram and Schmidt).
    pub(crate) fn orthonormal(&self) -> Self {
        let m = &self.rotation;
        let x = Vector3::new(m.m11, m.m21, m.m31);
        let x = x * (T::ONE / x.norm());
        let y = Vector3::new(m.m12, m.m22, m.m32);
        let y = y - x * x.dot(&y);
        let y = y * (T::ONE / y.norm());
        let z = x.cross(&y);
        let rotation = Matrix3::new(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z);
        Self { rotation, translation: self.translation }
    }

    /// The angle of the rotation, radians, 0 to pi.
    pub fn angle_rad(&self) -> T {
        let r = &self.rotation;
        let axis = Vector3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12);
        // Twice the sine and twice the cosine.
        axis.norm().atan2(r.trace() - T::ONE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter turn about Y: Z goes to X.
    const QUARTER: Matrix3<f64> = Matrix3::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0);

    #[test]
    fn carries_points_both_ways() {
        let pose = Pose::new(QUARTER, Vector3::new(1.0, 2.0, 3.0)).expect("a rotation");
        let there = pose.transform(&Point3::new(0.5, 1.0, 4.0));
        assert_eq!(there, Point3::new(5.0, 3.0, 2.5));
        assert_eq!(pose.inverse_transform(&there), Point3::new(0.5, 1.0, 4.0));
        assert_eq!(pose.inverse().transform(&there), Point3::new(0.5, 1.0, 4.0));
        assert_eq!(pose.then(&pose.inverse()), Pose::identity());
        assert!((pose.angle_rad() - core::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn opencv_goes_the_other_way() {
        // A right camera 0.1 m to the right: OpenCV's T is (-0.1, 0, 0).
        let pose = Pose::from_opencv(Matrix3::identity(), Vector3::new(-0.1, 0.0, 0.0)).expect("a rotation");
        assert_eq!(*pose.translation(), Vector3::new(0.1, 0.0, 0.0));
        assert_eq!(pose.to_opencv().1, Vector3::new(-0.1, 0.0, 0.0));
    }

    #[test]
    fn what_is_no_rotation_is_refused() {
        let o = Vector3::zeros();
        assert_eq!(Pose::new(Matrix3::identity() * 1.1, o), Err(PoseError::NotARotation));
        assert_eq!(Pose::new(-Matrix3::<f64>::identity(), o), Err(PoseError::NotARotation));
        assert_eq!(Pose::new(QUARTER, Vector3::new(f64::NAN, 0.0, 0.0)), Err(PoseError::NotFinite));
    }
}
