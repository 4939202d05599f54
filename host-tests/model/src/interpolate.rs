//! Poses between two known ones.

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion};
use stereopsis::geometry::camera::Pose;

/// A share of the way from one pose to another: along a line, and about one axis.
pub fn between(from: &Pose<f64>, to: &Pose<f64>, share: f64) -> Pose<f64> {
    let of = |p: &Pose<f64>| {
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*p.rotation()));
        Isometry3::from_parts(Translation3::from(*p.translation()), turn)
    };
    let (a, b) = (of(from), of(to));
    let turn = a.rotation.try_slerp(&b.rotation, share, 1e-9).unwrap_or(a.rotation);
    let place = a.translation.vector.lerp(&b.translation.vector, share);
    Pose::new(*turn.to_rotation_matrix().matrix(), place).unwrap_or(*from)
}
