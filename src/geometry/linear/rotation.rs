//! The cross product as a matrix, and Cayley's map from a vector to a rotation.

use super::matrix::product;
use crate::geometry::Real;
use nalgebra::{Matrix3, Vector3};

/// `[a]x`, with `[a]x b = a x b`: skew-symmetric and, but for a = 0, of rank 2 (Hartley & Zisserman 2004,
/// A4.3).
pub(crate) fn skew<T: Real>(a: &Vector3<T>) -> Matrix3<T> {
    let o = T::ZERO;
    Matrix3::new(o, -a.z, a.y, a.z, o, -a.x, -a.y, a.x, o)
}

/// A rotation that is `1 + [w]x` to first order, by a quaternion: exact at every size, and without an angle.
#[inline(never)]
pub(crate) fn cayley<T: Real>(w: &Vector3<T>) -> Matrix3<T> {
    let half = w * T::of(0.5);
    let by = T::of(2.0) / (T::ONE + half.norm_squared());
    let cross = skew(&half);
    Matrix3::identity() + (cross + product(&cross, &cross)) * by
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cross_product() {
        let (a, b) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(4.0, 5.0, 6.0));
        assert_eq!(skew(&a) * b, Vector3::new(-3.0, 6.0, -3.0));
        let (t, p) = (Vector3::new(0.1, 0.0, 0.0), Vector3::new(0.05, -0.05, 1.0));
        assert!((skew(&t) * p - Vector3::new(0.0, -0.1, -0.005)).amax() < 1e-15);
    }
}
