//! The cross product as a matrix.

use super::Real;
use super::linear::product;
use nalgebra::{Matrix3, Vector3};

/// `[a]x`, with `[a]x b = a x b`: skew-symmetric and, but for a = 0, of rank 2 (Hartley & Zisserman 2004,
/// A4.3).
///
/// ```
/// use stereopsis::geometry::skew;
/// use nalgebra::Vector3;
/// let (a, b) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(4.0, 5.0, 6.0));
/// assert_eq!(skew(&a) * b, Vector3::new(-3.0, 6.0, -3.0));
/// ```
pub fn skew<T: Real>(a: &Vector3<T>) -> Matrix3<T> {
    let o = T::ZERO;
    Matrix3::new(o, -a.z, a.y, a.z, o, -a.x, -a.y, a.x, o)
}

/// A rotation that is `1 + [w]x` to first order, by a quaternion: exact at every size, and without an angle.
pub(crate) fn turn<T: Real>(w: &Vector3<T>) -> Matrix3<T> {
    let half = w * T::of(0.5);
    let by = T::of(2.0) / (T::ONE + half.norm_squared());
    let cross = skew(&half);
    Matrix3::identity() + (cross + product(&cross, &cross)) * by
}
