//! The relative pose of two views: a rotation and a direction, without scale.

use crate::geometry::Real;
use crate::geometry::camera::Pose;
use nalgebra::{Matrix3, Point3, Unit, Vector3};

/// R and the direction of t: all that two views say of a pose. How far apart the cameras are is not in the
/// images; a scene twice as large seen by cameras twice as far apart looks the same.
///
/// With a baseline or a length in the scene it becomes a [`Pose`] in metres.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RelativePose<T: Real> {
    rotation: Matrix3<T>,
    direction: Unit<Vector3<T>>,
}

deserialize_checked! {
    RelativePose<T> { rotation: Matrix3<T>, direction: Vector3<T> }
    by |stored| match Pose::new(stored.rotation, stored.direction) {
        Ok(pose) => Self::of(&pose).ok_or("the direction between the cameras is zero"),
        Err(_) => Err("the rotation between the cameras is none, or a number is not finite"),
    }
}

/// Why a length gives no scale.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ScaleError {
    /// The length is not greater than zero, or not finite.
    Length,
    /// The two points are one, or not finite.
    SamePoint,
    /// The place of one of the two views or points is not known.
    Unknown,
}

error_text!(ScaleError {
    Self::Length => "the known length must be greater than zero and finite",
    Self::SamePoint => "the two points of the known length must be different and finite",
    Self::Unknown => "where both ends of the known length are must be known",
});

impl<T: Real> RelativePose<T> {
    /// A relative pose of a rotation and a direction of length one.
    pub(crate) fn new(rotation: Matrix3<T>, direction: Unit<Vector3<T>>) -> Self {
        Self { rotation, direction }
    }

    /// What is left of a pose when lengths are not known; `None` when the cameras stand in one place.
    pub fn of(pose: &Pose<T>) -> Option<Self> {
        let size = pose.translation().amax();
        let direction = Unit::try_new(pose.translation() / size, T::ZERO)?;
        Some(Self::new(*pose.rotation(), direction))
    }

    /// R, from camera 2 into camera 1.
    pub fn rotation(&self) -> &Matrix3<T> {
        &self.rotation
    }

    /// The direction of t: from camera 1 to camera 2, in camera 1. Length one, which is not a metre.
    pub fn direction(&self) -> &Unit<Vector3<T>> {
        &self.direction
    }

    /// The pose whose unit of length is the baseline: what is triangulated with it is in baselines, not in
    /// metres.
    pub fn in_baselines(&self) -> Pose<T> {
        Pose::of_parts(self.rotation, self.direction.into_inner())
    }

    /// The pose in metres of cameras that are `baseline_m` apart.
    pub fn with_baseline(&self, baseline_m: T) -> Result<Pose<T>, ScaleError> {
        scaled(self.rotation, self.direction.into_inner(), baseline_m)
    }

    /// The pose in metres, of two points that were triangulated in baselines ([`Self::in_baselines`]) and are
    /// `length_m` apart in truth.
    pub fn with_length(&self, a: &Point3<T>, b: &Point3<T>, length_m: T) -> Result<Pose<T>, ScaleError> {
        let baselines = (a - b).norm();
        if !(baselines > T::ZERO && baselines.is_finite()) {
            return Err(ScaleError::SamePoint);
        }
        self.with_baseline(length_m / baselines)
    }
}

/// The pose of a translation in units of a length.
pub(crate) fn scaled<T: Real>(
    rotation: Matrix3<T>,
    translation: Vector3<T>,
    length_m: T,
) -> Result<Pose<T>, ScaleError> {
    if !(length_m > T::ZERO && length_m.is_finite()) {
        return Err(ScaleError::Length);
    }
    Pose::of_parts(rotation, translation * length_m).sound().ok_or(ScaleError::Length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaled_by_what_is_known() {
        let pose = Pose::new(Matrix3::identity(), Vector3::new(0.0, 3.0, 4.0)).expect("a pose");
        let relative = RelativePose::of(&pose).expect("a baseline");
        assert_eq!(relative.direction().into_inner(), Vector3::new(0.0, 0.6, 0.8_f64));
        assert_eq!(relative.with_baseline(5.0), Ok(pose));
        // Two baselines apart and 10 m in truth.
        let (a, b) = (Point3::new(1.0, 0.0, 3.0), Point3::new(1.0, 2.0, 3.0));
        assert_eq!(relative.with_length(&a, &b, 10.0), Ok(pose));
        assert_eq!(relative.with_length(&a, &a, 10.0), Err(ScaleError::SamePoint));
        assert_eq!(relative.with_baseline(-1.0), Err(ScaleError::Length));
        assert_eq!(relative.with_baseline(f64::NAN), Err(ScaleError::Length));
        assert_eq!(RelativePose::of(&Pose::<f64>::identity()), None);
    }
}
