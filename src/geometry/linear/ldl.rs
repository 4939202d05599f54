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

/// Steps to the null vector at most, of two solutions each. One is enough where M is singular, three to six where the
/// smallest eigenvalue is a tenth of the next; where the two are nearly one, both eigenvectors are as good.
const MOST_STEPS: usize = 16;

impl<T: Real, const N: usize> Ldl<T, N> {
    /// Factors M, of which both triangles are filled.
    pub(crate) fn new(mut rows: [[T; N]; N]) -> Self {
        let mut order = [0; N];
        for (place, slot) in order.iter_mut().enumerate() {
            *slot = place;
        }
        let mut inverse_pivots = [T::ZERO; N];
        let mut floor = T::ZERO;
        for k in 0..N {
            let (mut best, mut largest) = (k, rows[k][k]);
            for i in k + 1..N {
                if rows[i][i] > largest {
                    (best, largest) = (i, rows[i][i]);
                }
            }
            // Says to the compiler that it is within the array.
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
        let mut ordered = [T::ZERO; N];
        for (slot, &place) in ordered.iter_mut().zip(&self.order) {
            *slot = b.get(place).copied().unwrap_or(T::ZERO);
        }
        self.restored(self.solve_ordered(ordered))
    }

    /// The eigenvector of the smallest eigenvalue, of length one: what minimises `x^T M x` with `|x| = 1`.
    ///
    /// Inverse iteration, of which every step takes the best of all that x and `M^-1 x` span, by a 2x2 eigenproblem
    /// (Lanczos' method on `M^-1`, begun anew after two vectors; Golub & Van Loan 2013, 10.1). Plain inverse iteration
    /// takes 44 steps per digit where two eigenvalues are within 5 %, as they are with few noisy rows.
    pub(crate) fn null_vector(&self) -> [T; N] {
        // Backwards from the last pivot alone: the null vector itself when that pivot is zero.
        let mut x = [T::ZERO; N];
        x[N - 1] = T::ONE;
        let mut x = unit(self.back(x));
        let enough = (T::EPSILON * T::of(8.0)).max(T::of(1e-10));
        for _ in 0..MOST_STEPS {
            let w = self.solve_ordered(x);
            let xx = dot(&x, &w);
            let across = combined(&w, T::ONE, &x, -xx);
            let xy = dot(&across, &across).sqrt();
            if !(xy > xx * T::EPSILON) {
                break;
            }
            let y = across.map(|v| v / xy);
            let yy = dot(&y, &self.solve_ordered(y));
            // The larger eigenvalue's vector of [xx xy; xy yy] is (cosine, sine).
            let half = (xx - yy) * T::of(0.5);
            let root = (half * half + xy * xy).sqrt();
            let (cosine, sine) = if half > T::ZERO { (half + root, xy) } else { (xy, root - half) };
            x = unit(combined(&x, cosine, &y, sine));
            if sine <= enough * cosine {
                break;
            }
        }
        self.restored(x)
    }
}

/// `a s + b t`.
fn combined<T: Real, const N: usize>(a: &[T; N], s: T, b: &[T; N], t: T) -> [T; N] {
    let mut sum = *a;
    for (a, &b) in sum.iter_mut().zip(b) {
        *a = *a * s + b * t;
    }
    sum
}

/// `a^T b`.
fn dot<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    a.iter().zip(b).fold(T::ZERO, |sum, (&a, &b)| sum + a * b)
}

/// `x` at length one.
fn unit<T: Real, const N: usize>(x: [T; N]) -> [T; N] {
    // By the largest element first: its square may be more than a number holds.
    let most = x.iter().fold(T::ZERO, |most, &v| most.max(v.abs()));
    let by = T::ONE / most;
    let x = x.map(|v| v * by);
    let by = T::ONE / dot(&x, &x).sqrt();
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
