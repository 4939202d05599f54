//! The vector that N - 1 equations leave free.

use crate::geometry::Real;

/// x with `A x = 0` for M = N - 1 rows of N numbers, of length one, by elimination: the largest element of each row in
/// turn is its pivot. The second number is the smallest pivot over the largest: next to nothing where a row depends on
/// those before it.
///
/// A is not squared on the way, as it is in normal equations: half as many digits are lost.
pub(crate) fn null_of_rows<T: Real, const M: usize, const N: usize>(mut rows: [[T; N]; M]) -> ([T; N], T) {
    const { assert!(M + 1 == N, "one row less than unknowns") };
    let mut order = [0; N];
    for (place, slot) in order.iter_mut().enumerate() {
        *slot = place;
    }
    let mut inverse_pivots = [T::ZERO; M];
    let (mut least, mut most) = (T::ZERO, T::ZERO);
    for k in 0..M {
        let mut best = k;
        let mut size = rows[k][k].abs();
        for j in k + 1..N {
            let here = rows[k][j].abs();
            if here > size {
                (best, size) = (j, here);
            }
        }
        let best = best.min(N - 1);
        if best != k {
            order.swap(k, best);
            for row in &mut rows {
                row.swap(k, best);
            }
        }
        (least, most) = if k == 0 { (size, size) } else { (least.min(size), most.max(size)) };
        let pivot = rows[k][k];
        // A row that depends on the others: any number will do, the caller is told by the smallest pivot.
        inverse_pivots[k] = if size > T::ZERO { T::ONE / pivot } else { T::ZERO };
        for i in k + 1..M {
            let factor = rows[i][k] * inverse_pivots[k];
            for j in k + 1..N {
                rows[i][j] -= factor * rows[k][j];
            }
        }
    }
    let mut x = [T::ZERO; N];
    x[N - 1] = T::ONE;
    for i in (0..M).rev() {
        let mut sum = T::ZERO;
        for j in i + 1..N {
            sum += rows[i][j] * x[j];
        }
        x[i] = -sum * inverse_pivots[i];
    }
    let by = T::ONE / x.iter().fold(T::ZERO, |sum, &v| sum + v * v).sqrt();
    let mut restored = [T::ZERO; N];
    for (&value, &place) in x.iter().zip(&order) {
        if let Some(slot) = restored.get_mut(place) {
            *slot = value * by;
        }
    }
    (restored, if most > T::ZERO { least / most } else { T::ZERO })
}

#[cfg(test)]
mod tests {
    use super::null_of_rows;

    #[test]
    fn two_rows_leave_their_cross_product() {
        // (1, 0, 2) x (0, 1, 2) = (-2, -2, 1).
        let (x, pivot) = null_of_rows::<f64, 2, 3>([[1.0, 0.0, 2.0], [0.0, 1.0, 2.0]]);
        let sign = -x[0].signum();
        for (x, expected) in x.iter().zip([-2.0, -2.0, 1.0]) {
            assert!((sign * x - expected / 3.0).abs() < 1e-15, "{x}");
        }
        // The pivots are 2 and, in the second row less the first, 1: (0 - 1, 1, 0).
        assert_eq!(pivot, 0.5);
    }

    #[test]
    fn a_row_that_depends_on_another_is_told() {
        let (_, pivot) = null_of_rows::<f64, 2, 3>([[1.0, 3.0, 2.0], [-2.0, -6.0, -4.0]]);
        assert_eq!(pivot, 0.0);
    }
}
