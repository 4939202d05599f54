//! Small dense linear algebra that is bounded and cannot panic.
//!
//! nalgebra's decompositions iterate without a bound, and leave panics in a binary; these do not.
//!
//! * [`Ldl`]: `L D L^T` of a symmetric, positive semi-definite matrix, and its null vector by inverse iteration.
//! * [`null_of_rows`]: the one vector that N - 1 rows leave free, by elimination.
//! * [`Projective`]: the normal equations of `p ~ M q`.
//! * [`Svd3`]: singular values of a 3x3 matrix, by Jacobi rotations of its columns.

#![allow(clippy::needless_range_loop, reason = "an element is named by its row and column, as in the equations")]

mod elimination;
mod ldl;
mod projective;
mod svd3;

use nalgebra::Matrix3;

pub(crate) use elimination::null_of_rows;
pub(crate) use ldl::Ldl;
pub(crate) use projective::Projective;
pub(crate) use svd3::Svd3;

/// The matrix of nine elements, row by row. (nalgebra's own leaves a panic in small code.)
pub(crate) fn matrix3<T: Copy + nalgebra::Scalar>(elements: &[T; 9]) -> Matrix3<T> {
    let [a, b, c, d, e, f, g, h, i] = *elements;
    Matrix3::new(a, b, c, d, e, f, g, h, i)
}
