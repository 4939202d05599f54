//! 3x3 matrices without the panics that nalgebra's own conversions leave in small code.

use super::vector::dot;
use crate::geometry::Real;
use nalgebra::{Matrix3, Vector3};

/// The matrix of three rows; nalgebra's own leaves a panic in small code.
pub(crate) fn matrix3<T: Real>(&[[a, b, c], [d, e, f], [g, h, i]]: &[[T; 3]; 3]) -> Matrix3<T> {
    Matrix3::new(a, b, c, d, e, f, g, h, i)
}

/// The columns of a matrix; nalgebra's own conversion leaves a panic in small code.
pub(crate) fn columns3<T: Real>(m: &Matrix3<T>) -> [Vector3<T>; 3] {
    [
        Vector3::new(m.m11, m.m21, m.m31), //
        Vector3::new(m.m12, m.m22, m.m32),
        Vector3::new(m.m13, m.m23, m.m33),
    ]
}

/// Nine elements as three rows.
pub(crate) fn rows3<T>([a, b, c, d, e, f, g, h, i]: [T; 9]) -> [[T; 3]; 3] {
    [[a, b, c], [d, e, f], [g, h, i]]
}

/// `A B`, compiled once for all callers so that small programs hold one copy.
#[inline(never)]
pub(crate) fn product<T: Real>(a: &Matrix3<T>, b: &Matrix3<T>) -> Matrix3<T> {
    a * b
}

/// `A^T`.
#[inline]
pub(crate) fn transposed3<T: Real>([[a, b, c], [d, e, f], [g, h, i]]: [[T; 3]; 3]) -> [[T; 3]; 3] {
    [[a, d, g], [b, e, h], [c, f, i]]
}

/// `A B^T`.
#[inline]
pub(crate) fn times_transposed3<T: Real>(a: &[[T; 3]; 3], [b, c, d]: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    let mut product = [[T::ZERO; 3]; 3];
    for (to, row) in product.iter_mut().zip(a) {
        *to = [dot(row, b), dot(row, c), dot(row, d)];
    }
    product
}
