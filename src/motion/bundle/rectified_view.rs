//! Projection into the left camera of a rectified pair and to a disparity, with its Jacobian.

use super::camera_view::pixel_jacobian;
use super::view::{ProjectionJacobian, View, chain_rule, moved};
use crate::geometry::{
    Real,
    camera::{Camera, Pose, ProjectionError},
};
use nalgebra::{Point2, Point3, Vector3};

/// A calibrated camera that may be the left one of a rectified pair: eye 0 sees pixels, eye 1 sees `(d, 0)`,
/// the disparity in px, `d = f b / Z`. What found a disparity began at the very pixel in the left picture, so
/// that the two have errors of their own; two pixels would share one.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RectifiedView<T: Real> {
    /// The camera.
    pub camera: Camera<T>,
    /// The pair's baseline, zero of one camera.
    pub baseline: T,
    /// Where it stands: from the camera into the world.
    pub pose: Pose<T>,
}

impl<T: Real> RectifiedView<T> {
    /// `f b / Z`, and its jacobian by Z.
    fn disparity(&self, own: &Point3<T>) -> Result<(T, T), ProjectionError> {
        if !(own.z > T::ZERO) {
            return Err(ProjectionError::Behind);
        }
        let (fx, _) = self.camera.focal_px();
        let disparity = fx * self.baseline / own.z;
        Ok((disparity, -disparity / own.z))
    }
}

impl<T: Real> View<T, 6> for RectifiedView<T> {
    const EMPTY: Self = Self { camera: Camera::EMPTY, baseline: T::ZERO, pose: Pose::NOTHING };

    fn pose(&self) -> &Pose<T> {
        &self.pose
    }

    fn with_pose(&self, pose: Pose<T>) -> Self {
        Self { pose, ..*self }
    }

    fn jacobian(&self, eye: u16, world: &Point3<T>) -> Result<ProjectionJacobian<T, 6>, ProjectionError> {
        let own = self.pose.inverse_transform(world);
        let (pixel, rows) = if eye == 0 {
            pixel_jacobian(&self.camera, &own)?
        } else {
            let (disparity, by_z) = self.disparity(&own)?;
            (Point2::new(disparity, T::ZERO), [Vector3::new(T::ZERO, T::ZERO, by_z), Vector3::zeros()])
        };
        let [(u, du), (v, dv)] = chain_rule(rows, &own, &self.pose);
        Ok(ProjectionJacobian { pixel, by_view: [u, v], by_point: [du, dv] })
    }

    fn project(&self, eye: u16, world: &Point3<T>) -> Result<Point2<T>, ProjectionError> {
        let own = self.pose.inverse_transform(world);
        if eye == 0 { self.camera.project(&own) } else { Ok(Point2::new(self.disparity(&own)?.0, T::ZERO)) }
    }

    fn moved(&self, &[a, b, c, x, y, z]: &[T; 6]) -> Self {
        self.with_pose(moved(&self.pose, [a, b, c], [x, y, z]))
    }
}
