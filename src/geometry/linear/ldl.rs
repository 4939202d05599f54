//! `L D L^T` with the largest pivot first, and the null vector.

use crate::geometry::Real;

/// A symmetric, positive semi-definite N x N matrix M, factored as `P M P^T = L D L^T`: the largest remaining diagonal
/// element is the next pivot, so that the pivots fall and their number over a threshold is the rank (Golub & Van Loan
/// 2013, 4.2.8).
pub(crate) struct Ldl<T, const N: usize> {
    /// L below the diagonal, `D L^T` on it and above.
    rows: [[T; N]; N],
    /// Which row of M stands where.
    order: [usize; N],
    inverse_pivots: [T; N],
}

/// Steps of inverse iteration at most. Each divides what is left of the other eigenvectors by the ratio of the two
/// smallest eigenvalues; the starting vector is exact where M is singular.
const MOST_STEPS: usize = 32;

impl<T: Real, const N: usize> Ldl<T, N> {
    /// Factors M, of which both triangles are filled.
    #[inline(always)]
    pub(crate) fn new(mut rows: [[T; N]; N]) -> Self {
        let mut order: [usize; N] = core::array::from_fn(|i| i);
        let mut inverse_pivots = [T::ZERO; N];
        let mut floor = T::ZERO;
        for k in 0..N {
            let mut best = k;
            for i in k + 1..N {
                if rows[i][i] > rows[best.min(N - 1)][best.min(N - 1)] {
                    best = i;
                }
            }
            let best = best.min(N - 1);
            if best != k {
                rows.swap(k, best);
                order.swap(k, best);
                for row in &mut rows {
                    row.swap(k, best);
                }
            }
            if k == 0 {
                // Below this a pivot is rounding, and may even be negative.
                floor = (rows[k][k] * T::EPSILON).max(T::of(1e-30));
            }
            rows[k][k] = rows[k][k].max(floor);
            inverse_pivots[k] = T::ONE / rows[k][k];
            for i in k + 1..N {
                let factor = rows[i][k] * inverse_pivots[k];
                for j in k + 1..N {
                    rows[i][j] -= factor * rows[k][j];
                }
                rows[i][k] = factor;
            }
        }
        Self { rows, order, inverse_pivots }
    }

    /// The pivot `k` over the largest, 1 to epsilon: what is left of the matrix after `k` directions.
    pub(crate) fn relative_pivot(&self, k: usize) -> T {
        match self.inverse_pivots.get(k) {
            Some(&inverse) => T::ONE / (inverse * self.rows[0][0]),
            None => T::ZERO,
        }
    }

    /// x of `L D L^T x = b`, in the factor's order.
    fn solve_ordered(&self, mut x: [T; N]) -> [T; N] {
        for i in 0..N {
            let mut sum = x[i];
            for j in 0..i {
                sum -= self.rows[i][j] * x[j];
            }
            x[i] = sum;
        }
        self.back(x)
    }

    /// x of `D L^T x = y`.
    fn back(&self, mut x: [T; N]) -> [T; N] {
        for i in (0..N).rev() {
            let mut sum = x[i];
            for j in i + 1..N {
                sum -= self.rows[i][j] * x[j];
            }
            x[i] = sum * self.inverse_pivots[i];
        }
        x
    }

    /// From the factor's order to the matrix's.
    fn restored(&self, ordered: [T; N]) -> [T; N] {
        let mut x = [T::ZERO; N];
        for (&value, &place) in ordered.iter().zip(&self.order) {
            if let Some(slot) = x.get_mut(place) {
                *slot = value;
            }
        }
        x
    }

    /// x of `M x = b`. Where M is singular, the pivots that are rounding count as [`Real::EPSILON`] of the largest.
    pub(crate) fn solve(&self, b: &[T; N]) -> [T; N] {
        let ordered = core::array::from_fn(|i| b.get(self.order[i]).copied().unwrap_or(T::ZERO));
        self.restored(self.solve_ordered(ordered))
    }

    /// The eigenvector of the smallest eigenvalue, of length one: what minimises `|M^(1/2) x|` with `|x| = 1`.
    #[inline(always)]
    pub(crate) fn null_vector(&self) -> [T; N] {
        // Backwards from the last pivot alone: the null vector itself when that pivot is zero.
        let mut x = [T::ZERO; N];
        x[N - 1] = T::ONE;
        let mut x = unit(self.back(x));
        let enough = T::EPSILON.sqrt() * T::of(0.0625);
        for _ in 0..MOST_STEPS {
            let next = unit(self.solve_ordered(x));
            // M is positive: the step turns x by less than a right angle, never over.
            let change = x.iter().zip(&next).fold(T::ZERO, |most, (&a, &b)| most.max((a - b).abs()));
            x = next;
            if change <= enough {
                break;
            }
        }
        self.restored(x)
    }
}

/// `x` at length one.
fn unit<T: Real, const N: usize>(x: [T; N]) -> [T; N] {
    // By the largest element first: its square may be more than a number holds.
    let most = x.iter().fold(T::ZERO, |most, &v| most.max(v.abs()));
    let by = T::ONE / most;
    let x = x.map(|v| v * by);
    let by = T::ONE / x.iter().fold(T::ZERO, |sum, &v| sum + v * v).sqrt();
    x.map(|v| v * by)
}

#[cfg(test)]
mod tests {
    use super::Ldl;

    #[test]
    fn solves_a_small_system() {
        // [4 2; 2 3] (1, 2) = (8, 8).
        let ldl = Ldl::new([[4.0, 2.0], [2.0, 3.0_f64]]);
        assert_eq!(ldl.solve(&[8.0, 8.0]), [1.0, 2.0]);
        // The pivots are 4 and 3 - 2 * 2 / 4 = 2.
        assert_eq!(ldl.relative_pivot(1), 0.5);
        // The larger one goes first.
        assert_eq!(Ldl::new([[3.0, 2.0], [2.0, 4.0_f64]]).solve(&[8.0, 8.0]), [2.0, 1.0]);
    }

    #[test]
    fn finds_the_null_vector() {
        // a a^T + b b^T with a = (1, 0, 2), b = (0, 1, 2): both are orthogonal to (2, 2, -1) / 3.
        let x = Ldl::new([[1.0, 0.0, 2.0], [0.0, 1.0, 2.0], [2.0, 2.0, 8.0_f64]]).null_vector();
        let sign = x[0].signum();
        for (x, expected) in x.iter().zip([2.0, 2.0, -1.0]) {
            assert!((sign * x - expected / 3.0).abs() < 1e-15, "{x}");
        }
    }

    #[test]
    fn finds_the_smallest_eigenvector() {
        // Eigenvalues 1 and 3, with (1, -1) and (1, 1).
        let x = Ldl::new([[2.0, 1.0], [1.0, 2.0_f64]]).null_vector();
        assert!((x[0] + x[1]).abs() < 1e-9 && (x[0] * x[0] - 0.5).abs() < 1e-9, "{x:?}");
    }
}
