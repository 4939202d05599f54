//! Projection through a lens that is refined too: f, k1 and k2 (Agarwal et al. 2010).

use super::view::{ProjectionJacobian, View, chain_rule, moved};
use crate::geometry::{
    Real,
    camera::{Pose, ProjectionError},
};
use nalgebra::{Point2, Point3, Vector3};

/// A camera with square pixels, the origin of pixels at its centre, and a lens `q = 1 + k1 r^2 + k2 r^4`
/// (Agarwal et al. 2010, "Bundle Adjustment in the Large"): `(u, v) = f q (x, y)`, `(x, y) = (X / Z, Y / Z)`.
/// Nine numbers move.
///
/// X is right, Y down and Z forward, as everywhere here; there Y is up and Z backward, so that v and the
/// second and third row of the rotation change their sign. As there, a point behind the camera is seen
/// through its centre; none is in the plane of the centre itself.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RadialView<T: Real> {
    /// Where it stands: from the camera into the world.
    pub pose: Pose<T>,
    /// Focal length, px.
    pub focal_px: T,
    /// The coefficient of r^2.
    pub k1: T,
    /// The coefficient of r^4.
    pub k2: T,
}

impl<T: Real> View<T, 9> for RadialView<T> {
    const EMPTY: Self = Self { pose: Pose::NOTHING, focal_px: T::ZERO, k1: T::ZERO, k2: T::ZERO };

    fn pose(&self) -> &Pose<T> {
        &self.pose
    }

    fn with_pose(&self, pose: Pose<T>) -> Self {
        Self { pose, ..*self }
    }

    fn jacobian(&self, _: u16, world: &Point3<T>) -> Result<ProjectionJacobian<T, 9>, ProjectionError> {
        let own = self.pose.inverse_transform(world);
        if own.z == T::ZERO {
            return Err(ProjectionError::Behind);
        }
        let (two, f) = (T::of(2.0), self.focal_px);
        let by = T::ONE / own.z;
        let (x, y) = (own.x * by, own.y * by);
        let r2 = x * x + y * y;
        let q = T::ONE + r2 * (self.k1 + r2 * self.k2);
        let dq = self.k1 + two * r2 * self.k2;
        let row = |by_x: T, by_y: T| Vector3::new(by_x * by, by_y * by, -(by_x * x + by_y * y) * by);
        let across = f * two * x * y * dq;
        let rows = [row(f * (q + two * x * x * dq), across), row(across, f * (q + two * y * y * dq))];
        let [(u, du), (v, dv)] = chain_rule(rows, &own, &self.pose);
        let with_lens =
            |[a, b, c, d, e, g]: [T; 6], x: T| [a, b, c, d, e, g, q * x, f * r2 * x, f * r2 * r2 * x];
        Ok(ProjectionJacobian {
            pixel: Point2::new(f * q * x, f * q * y),
            by_view: [with_lens(u, x), with_lens(v, y)],
            by_point: [du, dv],
        })
    }

    fn project(&self, _: u16, world: &Point3<T>) -> Result<Point2<T>, ProjectionError> {
        let own = self.pose.inverse_transform(world);
        if own.z == T::ZERO {
            return Err(ProjectionError::Behind);
        }
        let by = T::ONE / own.z;
        let (x, y) = (own.x * by, own.y * by);
        let r2 = x * x + y * y;
        let scale = self.focal_px * (T::ONE + r2 * (self.k1 + r2 * self.k2));
        Ok(Point2::new(scale * x, scale * y))
    }

    fn moved(&self, &[a, b, c, x, y, z, f, k1, k2]: &[T; 9]) -> Self {
        Self {
            pose: moved(&self.pose, [a, b, c], [x, y, z]),
            focal_px: self.focal_px + f,
            k1: self.k1 + k1,
            k2: self.k2 + k2,
        }
    }
}
