//! The singular value decomposition of a 3x3 matrix, by one-sided Jacobi rotations (Hestenes 1958).

use super::matrix::columns3;
use crate::geometry::Real;
use nalgebra::{Matrix3, Vector3};

/// `A = U diag(s) V^T` with U and V rotations, `s0 >= s1 >= |s2|`; s2 has the sign of A's determinant.
///
/// Hestenes' one-sided Jacobi method: rotations from the right make the columns of A orthogonal (Golub & Van
/// Loan 2013, 8.6.3). A is not squared, so that small values keep their digits. Where s1 is zero, U and V are
/// not defined.
pub(crate) struct Svd3<T> {
    pub(crate) u: Matrix3<T>,
    pub(crate) values: [T; 3],
    pub(crate) v: Matrix3<T>,
}

/// Sweeps over the three pairs of columns, at most: five are enough for any 3x3 matrix of `f64` that was
/// tried.
const MOST_SWEEPS: usize = 12;

impl<T: Real> Svd3<T> {
    pub(crate) fn new(matrix: &Matrix3<T>) -> Self {
        let mut a = columns3(matrix);
        let mut v = [Vector3::x(), Vector3::y(), Vector3::z()];
        for _ in 0..MOST_SWEEPS {
            let [a0, a1, a2] = &mut a;
            let [v0, v1, v2] = &mut v;
            let rotated = [
                rotate_columns(a0, a1, v0, v1),
                rotate_columns(a0, a2, v0, v2),
                rotate_columns(a1, a2, v1, v2),
            ];
            if !rotated.contains(&true) {
                break;
            }
        }
        let mut columns = [(a[0].norm(), a[0], v[0]), (a[1].norm(), a[1], v[1]), (a[2].norm(), a[2], v[2])];
        sort(&mut columns);
        let [(s0, a0, v0), (s1, a1, v1), (_, a2, _)] = columns;
        let (u0, u1) = (a0.unscale(s0), a1.unscale(s1));
        let (u2, v2) = (u0.cross(&u1), v0.cross(&v1));
        // The third column as it came out, but for the sign of V's third.
        let s2 = (matrix * v2).dot(&u2);
        let s2 = if s2 < T::ZERO { -a2.norm() } else { a2.norm() };
        Self {
            u: Matrix3::from_columns(&[u0, u1, u2]),
            values: [s0, s1, s2],
            v: Matrix3::from_columns(&[v0, v1, v2]),
        }
    }
}

/// Makes two columns orthogonal, the same rotation in V; whether they were not.
fn rotate_columns<T: Real>(
    a: &mut Vector3<T>,
    b: &mut Vector3<T>,
    v: &mut Vector3<T>,
    w: &mut Vector3<T>,
) -> bool {
    let (aa, bb, ab) = (a.norm_squared(), b.norm_squared(), a.dot(b));
    // The square of the cosine, at the rounding of a dot product.
    let rounding = T::EPSILON * T::of(2.0);
    if ab * ab <= rounding * rounding * aa * bb || ab == T::ZERO {
        return false;
    }
    let zeta = (bb - aa) / (ab + ab);
    let tangent = T::ONE / (zeta.abs() + (T::ONE + zeta * zeta).sqrt());
    let tangent = if zeta < T::ZERO { -tangent } else { tangent };
    let cosine = T::ONE / (T::ONE + tangent * tangent).sqrt();
    let sine = cosine * tangent;
    (*a, *b) = (*a * cosine - *b * sine, *a * sine + *b * cosine);
    (*v, *w) = (*v * cosine - *w * sine, *v * sine + *w * cosine);
    true
}

/// The largest first.
fn sort<T: Real>(columns: &mut [(T, Vector3<T>, Vector3<T>); 3]) {
    let [a, b, c] = columns;
    if a.0 < b.0 {
        core::mem::swap(a, b);
    }
    if b.0 < c.0 {
        core::mem::swap(b, c);
    }
    if a.0 < b.0 {
        core::mem::swap(a, b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_diagonal_comes_back() {
        // diag(1, 2, -3) with the rows one place on, and a rotation by 3-4-5 about z from the right.
        let shift = Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0_f64);
        let rotation = Matrix3::new(0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0);
        let matrix = shift * Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, -3.0)) * rotation;
        let Svd3 { u, values, v } = Svd3::new(&matrix);
        for (value, expected) in values.iter().zip([3.0, 2.0, -1.0]) {
            assert!((value - expected).abs() < 1e-15, "{values:?}");
        }
        assert!((u.determinant() - 1.0).abs() < 1e-15 && (v.determinant() - 1.0).abs() < 1e-15);
        let again = u * Matrix3::from_diagonal(&Vector3::from(values)) * v.transpose();
        assert!((again - matrix).amax() < 1e-15, "{again}");
    }
}
