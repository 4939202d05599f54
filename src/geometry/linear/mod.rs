//! Small dense linear algebra that is bounded and cannot panic.
//!
//! nalgebra's decompositions iterate without a bound, and leave panics in a binary; these do not.
//!
//! * [`Ldl`]: `L D L^T` of a symmetric, positive semi-definite matrix, and its null vector by inverse
//!   iteration.
//! * [`null_of_rows`]: the one vector that N - 1 rows leave free, by elimination; [`pencil_of_rows`]: the two
//!   that N - 2 do. [`rank`]: how many pivots count.
//! * [`covariance6`]: the inverse of an information of six numbers.
//! * [`cubic_roots`]: the real roots of a cubic.
//! * [`Projective`]: the normal equations of `p ~ M q`.
//! * [`Svd3`]: singular values of a 3x3 matrix, by Jacobi rotations of its columns.

#![allow(
    clippy::needless_range_loop,
    reason = "an element is named by its row and column, as in the equations"
)]

mod covariance;
mod cubic;
mod elimination;
mod ldl;
mod projective;
mod svd3;

use super::Real;
use nalgebra::{Matrix3, Vector3};

pub(crate) use covariance::covariance6;
pub(crate) use cubic::cubic_roots;
pub(crate) use elimination::{null_of_rows, pencil_of_rows, rank};
pub(crate) use ldl::Ldl;
pub(crate) use projective::Projective;
pub(crate) use svd3::Svd3;

/// The matrix of three rows. (nalgebra's own leaves a panic in small code.)
pub(crate) fn matrix3<T: Real>(&[[a, b, c], [d, e, f], [g, h, i]]: &[[T; 3]; 3]) -> Matrix3<T> {
    Matrix3::new(a, b, c, d, e, f, g, h, i)
}

/// The columns. (nalgebra's own conversion leaves a panic in small code.)
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

/// `A B`: nalgebra's own, in a small program once.
#[inline(never)]
pub(crate) fn product<T: Real>(a: &Matrix3<T>, b: &Matrix3<T>) -> Matrix3<T> {
    a * b
}

// What follows takes slices, so that it is in a small program once.

/// `a^T b`.
#[inline]
pub(crate) fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::ZERO, |sum, (&a, &b)| sum + a * b)
}

/// `a = a s + b t`.
#[inline]
fn combine<T: Real>(a: &mut [T], s: T, b: &[T], t: T) {
    for (a, &b) in a.iter_mut().zip(b) {
        *a = *a * s + b * t;
    }
}

/// Brings `x` to length one.
pub(crate) fn unit<T: Real>(x: &mut [T]) {
    // By the largest element first: its square may be more than a number holds.
    let by = T::ONE / x.iter().fold(T::ZERO, |most, &v| most.max(v.abs()));
    x.iter_mut().for_each(|v| *v *= by);
    let by = T::ONE / dot(x, x).sqrt();
    x.iter_mut().for_each(|v| *v *= by);
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
