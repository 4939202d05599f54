//! Small dense linear algebra that is bounded and cannot panic.
//!
//! nalgebra's decompositions iterate without a bound, and leave panics in a binary; these do not.
//!
//! * [`Ldl`]: `L D L^T` of a symmetric, positive semi-definite matrix, and its null vector by inverse iteration.
//! * [`null_of_rows`]: the one vector that N - 1 rows leave free, by elimination.
//! * [`cubic_roots`]: the real roots of a cubic, in closed form.
//! * [`Svd3`]: singular values of a 3x3 matrix, by Jacobi rotations of its columns.

mod cubic;
mod elimination;
mod ldl;
mod svd3;

pub(crate) use cubic::cubic_roots;
pub(crate) use elimination::null_of_rows;
pub(crate) use ldl::Ldl;
pub(crate) use svd3::Svd3;
