//! The rotations of both cameras into the rectified frame (Bouguet).

use super::config::{Axis, RectifyError};
use crate::geometry::Real;
use crate::geometry::camera::Pose;
use crate::geometry::linear::{cayley, skew};
use nalgebra::{Matrix3, Vector3};

/// Rotations of the first and of the second camera into their shared frame, whose X (or Y) is along the
/// baseline, and that axis.
///
/// Each camera rotates by half of R, then both by the smallest rotation that lays the axis along the baseline
/// (Bouguet's method: both images are altered alike, and as little as can be). All is done with products and
/// roots, so that every core gives the same bits.
pub(super) fn aligned<T: Real>(pose: &Pose<T>) -> Result<([Matrix3<T>; 2], Axis), RectifyError> {
    let half = half_of(pose.rotation())?;
    // From the first camera to the second, in the frame between them.
    let baseline = half.tr_mul(pose.translation());
    let Some(along) = baseline.try_normalize(T::ZERO) else { return Err(RectifyError::Forward) };
    let (axis, unit, component) = if along.x.abs() >= along.y.abs() {
        (Axis::Horizontal, Vector3::x(), along.x)
    } else {
        (Axis::Vertical, Vector3::y(), along.y)
    };
    if !(component.abs() > T::of(0.5)) {
        return Err(RectifyError::Forward);
    }
    if component < T::ZERO {
        return Err(RectifyError::Swapped(axis));
    }
    let smallest = smallest_rotation(&along, &unit);
    Ok(([smallest * half.transpose(), smallest * half], axis))
}

/// H with `H H = R`, by the rotation's quaternion: half the angle is the mean of it and of no rotation.
fn half_of<T: Real>(r: &Matrix3<T>) -> Result<Matrix3<T>, RectifyError> {
    // Beyond 104 degrees.
    if !(r.trace() > T::of(0.5)) {
        return Err(RectifyError::Apart);
    }
    let w = (T::ONE + r.trace()).sqrt() * T::of(0.5);
    let axis = Vector3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12);
    Ok(cayley(&(axis * (T::of(0.5) / (w * (w + T::ONE))))))
}

/// The smallest rotation of a unit vector to another that is not opposite (Rodrigues, without an
/// angle): `1 + [v]x + [v]x^2 / (1 + c)` with `v = from x to`, `c = from . to`.
fn smallest_rotation<T: Real>(from: &Vector3<T>, to: &Vector3<T>) -> Matrix3<T> {
    let cross = skew(&from.cross(to));
    Matrix3::identity() + cross + cross * cross / (T::ONE + from.dot(to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_a_quarter_is_an_eighth() {
        let quarter = Matrix3::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0_f64);
        let half = half_of(&quarter).expect("not far apart");
        assert!((half * half - quarter).amax() < 1e-15);
        assert!((half.m11 - 0.5_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn one_axis_goes_to_another() {
        let from = Vector3::new(0.6, 0.8, 0.0_f64);
        let smallest = smallest_rotation(&from, &Vector3::x());
        assert!((smallest * from - Vector3::x()).amax() < 1e-15);
        assert!((smallest.m33 - 1.0).abs() < 1e-15);
    }
}
