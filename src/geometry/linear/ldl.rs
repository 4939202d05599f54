//! Pivoted Cholesky factors `L D L^T`, and the null vector by inverse iteration (Golub & Van Loan 2013).

use super::vector::{combine, dot, larger, unit};
use crate::geometry::Real;

/// A symmetric, positive semi-definite N x N matrix M as a sum `r r^T / d` of one term for each unknown: `L D
/// L^T` with the largest remaining diagonal element d as the next pivot, so that the pivots fall and their
/// number over a threshold is the rank (Golub & Van Loan 2013, 4.2.8).
///
/// Nothing is swapped: r is zero where the pivots before it are, so that whole rows can be worked on.
pub(crate) struct Ldl<T, const N: usize> {
    rows: [[T; N]; N],
    pivots: [T; N],
    /// Index of the unknown that each pivot eliminates.
    places: [usize; N],
}

/// Steps to the null vector at most, of two solutions each. One is enough where M is singular, three to six
/// where the smallest eigenvalue is a tenth of the next; where the two are nearly one, both eigenvectors are
/// as good.
const MOST_STEPS: usize = 16;

impl<T: Real, const N: usize> Ldl<T, N> {
    /// Factors M, both of whose triangles are filled, and overwrites it.
    pub(crate) fn new(m: &mut [[T; N]; N]) -> Self {
        let mut factor = Self { rows: [[T::ZERO; N]; N], pivots: [T::ZERO; N], places: [0; N] };
        // Below this a pivot is rounding, and may even be negative.
        let mut floor = T::of(1e-30);
        let slots = factor.rows.iter_mut().zip(&mut factor.pivots).zip(&mut factor.places);
        for (k, ((row, pivot_slot), place_slot)) in slots.enumerate() {
            // Those that were pivots are less than any number.
            let (mut place, mut pivot) = (0, -T::ONE / T::ZERO);
            for (i, row) in m.iter().enumerate() {
                if row[i] > pivot {
                    (place, pivot) = (i, row[i]);
                }
            }
            let place = place.min(N - 1);
            if k == 0 {
                floor = larger(floor, pivot * T::EPSILON);
            }
            let pivot = larger(floor, pivot);
            let inverse = T::ONE / pivot;
            *row = m[place];
            row[place] = pivot;
            for (other, &by) in m.iter_mut().zip(row.iter()) {
                // Zero for all that were pivots before.
                if by != T::ZERO {
                    combine(other, T::ONE, row, -by * inverse);
                }
                other[place] = T::ZERO;
            }
            m[place] = [T::ZERO; N];
            m[place][place] = -T::ONE / T::ZERO;
            (*pivot_slot, *place_slot) = (pivot, place);
        }
        factor
    }

    /// The pivots, which fall, to epsilon of the first: what is left of the matrix after so many directions.
    pub(crate) fn pivots(&self) -> &[T; N] {
        &self.pivots
    }

    /// The solution x of `M x = b`. Where M is singular, the pivots that are rounding count as
    /// [`Real::EPSILON`] of the largest.
    pub(crate) fn solve(&self, b: &[T; N]) -> [T; N] {
        let mut b = *b;
        let mut y = [T::ZERO; N];
        for (y, (row, &pivot, place)) in y.iter_mut().zip(self.terms()) {
            *y = b[place];
            combine(&mut b, T::ONE, row, -*y / pivot);
        }
        self.back(&y)
    }

    /// The vector x with `r^T x = y` for all rows r.
    fn back(&self, y: &[T; N]) -> [T; N] {
        let mut x = [T::ZERO; N];
        for ((row, &pivot, place), &y) in self.terms().zip(y).rev() {
            x[place] = (y - dot(row, &x)) / pivot;
        }
        x
    }

    /// The row r, the pivot d and the place of d for each term.
    fn terms(&self) -> impl DoubleEndedIterator<Item = (&[T; N], &T, usize)> + ExactSizeIterator {
        // At most N - 1 anyway; the compiler cannot know.
        let terms = self.rows.iter().zip(&self.pivots).zip(&self.places);
        terms.map(|((row, pivot), &place)| (row, pivot, place.min(N - 1)))
    }

    /// The eigenvector of the smallest eigenvalue, of length one: what minimises `x^T M x` with `|x| = 1`.
    ///
    /// Inverse iteration; every step takes the best vector that x and `M^-1 x` span, by a 2x2
    /// eigenproblem (Lanczos' method on `M^-1`, begun anew after two vectors; Golub & Van Loan 2013,
    /// 10.1). Plain inverse iteration takes 44 steps per digit where two eigenvalues are within 5 %, as
    /// they are with few noisy rows.
    pub(crate) fn null_vector(&self) -> [T; N] {
        // Backwards from the last pivot alone: the null vector itself when that pivot is zero.
        let mut last = [T::ZERO; N];
        last[N - 1] = T::ONE;
        let mut x = self.back(&last);
        unit(&mut x);
        let enough = (T::EPSILON * T::of(8.0)).max(T::of(1e-10));
        for _ in 0..MOST_STEPS {
            let mut y = self.solve(&x);
            let xx = dot(&x, &y);
            combine(&mut y, T::ONE, &x, -xx);
            let xy = dot(&y, &y).sqrt();
            if !(xy > xx * T::EPSILON) {
                break;
            }
            combine(&mut y, T::ONE / xy, &x, T::ZERO);
            let yy = dot(&y, &self.solve(&y));
            // The larger eigenvalue's vector of [xx xy; xy yy] is (cosine, sine).
            let half = (xx - yy) * T::of(0.5);
            let root = (half * half + xy * xy).sqrt();
            let (cosine, sine) = if half > T::ZERO { (half + root, xy) } else { (xy, root - half) };
            combine(&mut x, cosine, &y, sine);
            unit(&mut x);
            if sine <= enough * cosine {
                break;
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::Ldl;

    #[test]
    fn solves_a_small_system() {
        // [4 2; 2 3] (1, 2) = (8, 8).
        let ldl = Ldl::new(&mut [[4.0, 2.0], [2.0, 3.0_f64]]);
        assert_eq!(ldl.solve(&[8.0, 8.0]), [1.0, 2.0]);
        // The pivots are 4 and 3 - 2 * 2 / 4 = 2.
        assert_eq!(ldl.pivots(), &[4.0, 2.0]);
        // The larger one goes first.
        assert_eq!(Ldl::new(&mut [[3.0, 2.0], [2.0, 4.0_f64]]).solve(&[8.0, 8.0]), [2.0, 1.0]);
    }

    #[test]
    fn finds_the_null_vector() {
        // a a^T + b b^T with a = (1, 0, 2), b = (0, 1, 2): both are orthogonal to (2, 2, -1) / 3.
        let x = Ldl::new(&mut [[1.0, 0.0, 2.0], [0.0, 1.0, 2.0], [2.0, 2.0, 8.0_f64]]).null_vector();
        let sign = x[0].signum();
        for (x, expected) in x.iter().zip([2.0, 2.0, -1.0]) {
            assert!((sign * x - expected / 3.0).abs() < 1e-15, "{x}");
        }
    }

    #[test]
    fn finds_the_smallest_eigenvector() {
        // Eigenvalues 1 and 3, with (1, -1) and (1, 1).
        let x = Ldl::new(&mut [[2.0, 1.0], [1.0, 2.0_f64]]).null_vector();
        assert!((x[0] + x[1]).abs() < 1e-9 && (x[0] * x[0] - 0.5).abs() < 1e-9, "{x:?}");
    }
}
