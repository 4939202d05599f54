//! The equations of the direct linear transform, DLT: `p ~ M q` (Hartley & Zisserman 2004, 4.1).

use crate::geometry::Real;

/// The normal equations of `p ~ M q` for the elements of M, 3 x K, row by row: of every pair the two rows
/// `(q, 0, -x q)` and `(0, q, -y q)`, whose squares sum up to `[S 0 -U; 0 S -V; -U -V W]` with S, U, V and W
/// the sums of 1, x, y and `x^2 + y^2` times `q q^T` (Hartley & Zisserman 2004, 4.1 and 7.1).
pub(crate) struct Projective<T, const K: usize> {
    sums: [[[T; K]; K]; 4],
}

impl<T: Real, const K: usize> Projective<T, K> {
    pub(crate) const fn new() -> Self {
        Self { sums: [[[T::ZERO; K]; K]; 4] }
    }

    /// One pair: p = (x, y, 1), q as it is.
    pub(crate) fn add(&mut self, x: T, y: T, q: &[T; K]) {
        for (sum, factor) in self.sums.iter_mut().zip([T::ONE, x, y, x * x + y * y]) {
            for (row, &a) in sum.iter_mut().zip(q) {
                let a = factor * a;
                for (element, &b) in row.iter_mut().zip(q) {
                    *element += a * b;
                }
            }
        }
    }

    /// The matrix of N = 3 K unknowns.
    pub(crate) fn normal_matrix<const N: usize>(&self) -> [[T; N]; N] {
        const { assert!(N == 3 * K, "three rows of K numbers") };
        let [s, u, v, w] = &self.sums;
        let mut normal = [[T::ZERO; N]; N];
        for i in 0..K {
            for j in 0..K {
                normal[i][j] = s[i][j];
                normal[i + K][j + K] = s[i][j];
                normal[i + 2 * K][j + 2 * K] = w[i][j];
                (normal[i][j + 2 * K], normal[i + 2 * K][j]) = (-u[i][j], -u[i][j]);
                (normal[i + K][j + 2 * K], normal[i + 2 * K][j + K]) = (-v[i][j], -v[i][j]);
            }
        }
        normal
    }
}

#[cfg(test)]
mod tests {
    use super::Projective;

    #[test]
    fn the_rows_squared() {
        let mut equations = Projective::<f64, 2>::new();
        equations.add(3.0, 5.0, &[2.0, 1.0]);
        let rows = [[2.0, 1.0, 0.0, 0.0, -6.0, -3.0], [0.0, 0.0, 2.0, 1.0, -10.0, -5.0]];
        let normal = equations.normal_matrix::<6>();
        for (i, row) in normal.iter().enumerate() {
            for (j, element) in row.iter().enumerate() {
                assert_eq!(*element, rows[0][i] * rows[0][j] + rows[1][i] * rows[1][j], "{i} {j}");
            }
        }
    }
}
