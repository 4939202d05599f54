//! IPPE: the two rotations of a plane that have the same homography Jacobian (Collins & Bartoli 2014).

use crate::geometry::Real;
use crate::geometry::linear::skew;
use nalgebra::{Matrix2, Matrix3, Matrix3x2, Vector2, Vector3};

/// The two rotations that a homography from a plane to the plane Z = 1 may mean, and its scale at the origin;
/// `None` where it mirrors the plane.
pub(super) fn rotations<T: Real>(h: &Matrix3<T>) -> Option<(T, [Matrix3<T>; 2])> {
    let h = h / h.m33;
    let p = Vector2::new(h.m13, h.m23);
    let jacobian =
        Matrix2::new(h.m11 - h.m31 * p.x, h.m12 - h.m32 * p.x, h.m21 - h.m31 * p.y, h.m22 - h.m32 * p.y);
    // The frame whose Z is the ray of the origin.
    let (far, length) = ((T::ONE + p.norm_squared()).sqrt(), p.norm());
    let axis = Vector3::new(-p.y, p.x, T::ZERO) / if length > T::ZERO { length } else { T::ONE };
    let (sine, cosine) = (length / far, T::ONE / far);
    let cross = skew(&axis);
    let ray = Matrix3::identity() + cross * sine + cross * cross * (T::ONE - cosine);
    // [1 | -p] of its X and Y.
    let b = ray.fixed_view::<2, 2>(0, 0).into_owned() - p * ray.fixed_view::<1, 2>(2, 0);
    let determinant = b.m11 * b.m22 - b.m12 * b.m21;
    let inverse = Matrix2::new(b.m22, -b.m12, -b.m21, b.m11) / determinant;
    let a = inverse * jacobian;
    if !(a.m11 * a.m22 - a.m12 * a.m21 > T::ZERO) {
        return None;
    }
    // The larger singular value: a rotation's upper left corner has one of length one.
    let (first, second) = (a.row(0), a.row(1));
    let (half, across) = ((first.norm_squared() - second.norm_squared()) * T::of(0.5), first.dot(&second));
    let mean = a.norm_squared() * T::of(0.5);
    let scale = (mean + (half * half + across * across).sqrt()).sqrt();
    let corner = a / scale;
    // What is left of the columns' length is the third row; of its sign there are two.
    let rest = Matrix2::identity() - corner.transpose() * corner;
    let row = Vector2::new(rest.m11.max(T::ZERO).sqrt(), rest.m22.max(T::ZERO).sqrt());
    let row = Vector2::new(row.x, if rest.m12 < T::ZERO { -row.y } else { row.y });
    let with = |row: Vector2<T>| {
        let columns = Matrix3x2::new(corner.m11, corner.m12, corner.m21, corner.m22, row.x, row.y);
        let (x, y): (Vector3<T>, Vector3<T>) = (columns.column(0).into(), columns.column(1).into());
        let x = x / x.norm();
        let z = x.cross(&y);
        let z = z / z.norm();
        ray * Matrix3::from_columns(&[x, z.cross(&x), z])
    };
    Some((scale, [with(row), with(-row)]))
}
