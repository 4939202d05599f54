//! The trait of a camera at a pose: projection, Jacobian and update.

use crate::geometry::{
    Real,
    camera::{Pose, ProjectionError},
    linear::cayley,
};
use nalgebra::{Point2, Point3, Vector3};

/// A place from which points are seen, with N numbers that may move: the first three turn it, the next three
/// move its centre, what follows is the lens's.
///
/// A step w of the first three makes the rotation `R C(w)`, a turn about the camera's own axes, where C is
/// Cayley's map `C(w) = I + 2 / (1 + |w/2|^2) ([w/2]x + [w/2]x^2)`: a rotation for every w, without a sine,
/// which turns by `|w|` radians to the second order (Hartley & Zisserman 2004, A4.3; Bauchau & Trainelli
/// 2003). Of the next three, in the world's axes, the centre is moved.
pub trait View<T: Real, const N: usize>: Copy {
    /// What fills a slot that is not in use: zeros.
    const EMPTY: Self;

    /// The pose of the view: R and t carry a point of the camera into the world, t is its centre.
    fn pose(&self) -> &Pose<T>;

    /// Returns the view at another pose.
    fn with_pose(&self, pose: Pose<T>) -> Self;

    /// Where a point of the world is seen by an eye (0, or 1 for the second camera of a rig), px, with the
    /// derivatives.
    fn jacobian(&self, eye: u16, world: &Point3<T>) -> Result<ProjectionJacobian<T, N>, ProjectionError>;

    /// Where a point of the world is seen, px.
    fn project(&self, eye: u16, world: &Point3<T>) -> Result<Point2<T>, ProjectionError>;

    /// Returns the view after a step.
    fn moved(&self, step: &[T; N]) -> Self;
}

/// The projection of a point and its Jacobian.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ProjectionJacobian<T: Real, const N: usize> {
    /// Pixel, px.
    pub pixel: Point2<T>,
    /// The derivative of u and of v by the view's N numbers, at a step of zero.
    pub by_view: [[T; N]; 2],
    /// The derivative of u and of v by the point.
    pub by_point: [[T; 3]; 2],
}

/// The pose after a step of three numbers that turn and three that move.
pub(super) fn moved<T: Real>(pose: &Pose<T>, by: [T; 3], shift: [T; 3]) -> Pose<T> {
    let turned = pose.rotation() * cayley(&Vector3::from(by));
    Pose::of_parts(turned, pose.translation() + Vector3::from(shift)).orthonormal()
}

/// The derivatives of a pixel by a step of the pose and by the point, of those by the point in the camera's
/// frame.
///
/// `P' = C(w)^T R^T (P - t)`: by w it is `[P']x`, by the centre `-R^T`, by P `R^T`.
pub(super) fn chain_rule<T: Real>(
    jacobian: [Vector3<T>; 2],
    own: &Point3<T>,
    pose: &Pose<T>,
) -> [([T; 6], [T; 3]); 2] {
    jacobian.map(|row| {
        let turn = row.cross(&own.coords);
        let place = pose.rotation() * row;
        ([turn.x, turn.y, turn.z, -place.x, -place.y, -place.z], [place.x, place.y, place.z])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    #[test]
    fn a_turn_by_two_tangents_of_a_half() {
        // |w/2| = 1 about Z turns by 2 atan 1, a quarter: X goes to Y.
        let pose = moved(&Pose::<f64>::identity(), [0.0, 0.0, 2.0], [1.0, 2.0, 3.0]);
        assert_eq!(pose.transform(&Point3::new(1.0, 0.0, 0.0)), Point3::new(1.0, 3.0, 3.0));
    }

    #[test]
    fn rotations_stay_rotations() {
        let mut pose = Pose::<f32>::identity();
        for _ in 0..10_000 {
            pose = moved(&pose, [0.3, -0.2, 0.1], [0.0; 3]);
        }
        let off = (pose.rotation().transpose() * pose.rotation() - Matrix3::identity()).amax();
        assert!(off < 1e-6, "{off}");
    }
}
