//! Projection of a calibrated camera, or a rig of two, with its Jacobian.

use super::view::{ProjectionJacobian, View, chain_rule, moved};
use crate::geometry::{
    Real,
    camera::{Camera, Pose, ProjectionError},
};
use nalgebra::{Point2, Point3, Vector2, Vector3};

/// A calibrated camera: six numbers move, its lens does not.
///
/// A point that is not in front of it is not seen.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CameraView<T: Real> {
    /// The camera.
    pub camera: Camera<T>,
    /// Where it stands: from the camera into the world.
    pub pose: Pose<T>,
}

/// Two calibrated cameras that are mounted to each other: six numbers move them both.
///
/// Eye 0 is the first camera; every other is the second. The distance between the two gives the scene its
/// scale.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigView<T: Real> {
    /// The two cameras of the rig.
    pub cameras: [Camera<T>; 2],
    /// The second camera beside the first: from the second into the first.
    pub second: Pose<T>,
    /// Where the first stands: from it into the world.
    pub pose: Pose<T>,
}

/// The pixel of a point in the camera's frame, and the derivatives of u and v by it.
pub(super) fn pixel_jacobian<T: Real>(
    camera: &Camera<T>,
    own: &Point3<T>,
) -> Result<(Point2<T>, [Vector3<T>; 2]), ProjectionError> {
    if !(own.z > T::ZERO) {
        return Err(ProjectionError::Behind);
    }
    let by = T::ONE / own.z;
    let (x, y) = (own.x * by, own.y * by);
    let (plane, lens) = camera.lens().distort_with_derivative(&Vector2::new(x, y));
    let ((fx, fy), (cx, cy), skew) = (camera.focal_px(), camera.principal_point(), camera.skew_px());
    let pixel = Point2::new(fx * plane.x + skew * plane.y + cx, fy * plane.y + cy);
    let row = |by_x: T, by_y: T| Vector3::new(by_x * by, by_y * by, -(by_x * x + by_y * y) * by);
    let u = row(fx * lens.m11 + skew * lens.m21, fx * lens.m12 + skew * lens.m22);
    Ok((pixel, [u, row(fy * lens.m21, fy * lens.m22)]))
}

impl<T: Real> View<T, 6> for CameraView<T> {
    const EMPTY: Self = Self { camera: Camera::EMPTY, pose: Pose::NOTHING };

    fn pose(&self) -> &Pose<T> {
        &self.pose
    }

    fn with_pose(&self, pose: Pose<T>) -> Self {
        Self { pose, ..*self }
    }

    fn jacobian(&self, _: u16, world: &Point3<T>) -> Result<ProjectionJacobian<T, 6>, ProjectionError> {
        let own = self.pose.inverse_transform(world);
        let (pixel, rows) = pixel_jacobian(&self.camera, &own)?;
        let [(u, du), (v, dv)] = chain_rule(rows, &own, &self.pose);
        Ok(ProjectionJacobian { pixel, by_view: [u, v], by_point: [du, dv] })
    }

    fn project(&self, _: u16, world: &Point3<T>) -> Result<Point2<T>, ProjectionError> {
        self.camera.project(&self.pose.inverse_transform(world))
    }

    fn moved(&self, &[a, b, c, x, y, z]: &[T; 6]) -> Self {
        self.with_pose(moved(&self.pose, [a, b, c], [x, y, z]))
    }
}

impl<T: Real> RigView<T> {
    /// The camera of an eye.
    fn camera(&self, eye: u16) -> &Camera<T> {
        let [first, second] = &self.cameras;
        if eye == 0 { first } else { second }
    }
}

impl<T: Real> View<T, 6> for RigView<T> {
    const EMPTY: Self = Self { cameras: [Camera::EMPTY; 2], second: Pose::NOTHING, pose: Pose::NOTHING };

    fn pose(&self) -> &Pose<T> {
        &self.pose
    }

    fn with_pose(&self, pose: Pose<T>) -> Self {
        Self { pose, ..*self }
    }

    fn jacobian(&self, eye: u16, world: &Point3<T>) -> Result<ProjectionJacobian<T, 6>, ProjectionError> {
        let own = self.pose.inverse_transform(world);
        let (pixel, rows) = if eye == 0 {
            pixel_jacobian(self.camera(0), &own)?
        } else {
            let (pixel, rows) = pixel_jacobian(self.camera(eye), &self.second.inverse_transform(&own))?;
            (pixel, rows.map(|row| self.second.rotation() * row))
        };
        let [(u, du), (v, dv)] = chain_rule(rows, &own, &self.pose);
        Ok(ProjectionJacobian { pixel, by_view: [u, v], by_point: [du, dv] })
    }

    fn project(&self, eye: u16, world: &Point3<T>) -> Result<Point2<T>, ProjectionError> {
        let own = self.pose.inverse_transform(world);
        let own = if eye == 0 { own } else { self.second.inverse_transform(&own) };
        self.camera(eye).project(&own)
    }

    fn moved(&self, &[a, b, c, x, y, z]: &[T; 6]) -> Self {
        self.with_pose(moved(&self.pose, [a, b, c], [x, y, z]))
    }
}
