//! Small dense linear algebra that is bounded and cannot panic.
//!
//! nalgebra's decompositions iterate without a bound, and leave panics in a binary; these do not.
//!
//! * [`Ldl`]: `L D L^T` of a symmetric, positive semi-definite matrix, and its null vector by inverse
//!   iteration.
//! * [`null_of_rows`]: the one vector that N - 1 rows leave free, by elimination; [`basis_of_rows`]: those
//!   that N - K do. [`rank`]: how many pivots count.
//! * [`mod@levenberg_marquardt`]: the loop of damped least squares, over any [`LeastSquares`] problem.
//! * [`covariance6`], [`inverse_information`]: the covariance of numbers as the inverse of their information.
//! * [`cubic_roots`]: the real roots of a cubic. [`polynomial_roots`]: those of a polynomial of degree ten.
//! * [`Projective`]: the normal equations of `p ~ M q`.
//! * [`Svd3`]: singular values of a 3x3 matrix, by Jacobi rotations of its columns.

#![allow(
    clippy::needless_range_loop,
    reason = "an element is named by its row and column, as in the equations"
)]

mod vector;
mod matrix;
mod rotation;
mod cubic;
mod elimination;
mod ldl;
mod levenberg_marquardt;
mod covariance;
mod projective;
mod roots;
mod svd3;

pub(crate) use covariance::{covariance6, inverse_information};
pub(crate) use cubic::cubic_roots;
pub(crate) use elimination::{basis_of_rows, null_of_rows, rank};
pub(crate) use ldl::Ldl;
pub(crate) use levenberg_marquardt::{LeastSquares, NormalEquations, levenberg_marquardt};
pub(crate) use matrix::{columns3, matrix3, product, rows3, times_transposed3, transposed3};
pub(crate) use projective::Projective;
pub(crate) use roots::polynomial_roots;
pub(crate) use rotation::{cayley, skew};
pub(crate) use svd3::Svd3;
pub(crate) use vector::{all_finite, dot, larger, unit};
