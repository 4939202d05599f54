//! Null vectors of fewer equations than unknowns by Gaussian elimination, and rank.

use super::vector::{combine, dot, larger, unit};
use crate::geometry::Real;

/// The vector x with `A x = 0` for M = N - 1 rows of N numbers, of length one, by elimination: the largest
/// element of each row in turn is its pivot. The second result are the pivots: next to nothing where a row
/// depends on those before it ([`rank`]).
///
/// `rows` is what the elimination makes of them. A is not squared on the way, as it is in normal equations:
/// half as many digits are lost.
pub(crate) fn null_of_rows<T: Real, const M: usize, const N: usize>(
    rows: &mut [[T; N]; M],
) -> ([T; N], [T; M]) {
    const { assert!(M + 1 == N, "one row less than unknowns") };
    let (mut pivots, mut places) = ([T::ZERO; M], [0; M]);
    eliminate(rows, &mut pivots, &mut places);
    // One in the column that no row has its pivot in.
    let mut x = [T::ONE; N];
    for &place in &places {
        x[place.min(N - 1)] = T::ZERO;
    }
    solve(rows, &pivots, &places, &mut x);
    unit(&mut x);
    (x, pivots)
}

/// K vectors that span what M = N - K rows leave free, and the pivots: each has a one where no row has its
/// pivot and the other vectors are zero.
#[inline]
pub(crate) fn basis_of_rows<T: Real, const M: usize, const N: usize, const K: usize>(
    rows: &mut [[T; N]; M],
) -> ([[T; N]; K], [T; M]) {
    const { assert!(M + K == N, "K rows less than unknowns") };
    let (mut pivots, mut places) = ([T::ZERO; M], [0; M]);
    eliminate(rows, &mut pivots, &mut places);
    let mut all = [[T::ZERO; N]; K];
    let mut free = (0..N).filter(|place| !places.contains(place));
    for x in &mut all {
        if let Some(slot) = free.next().and_then(|place| x.get_mut(place)) {
            *slot = T::ONE;
        }
        solve(rows, &pivots, &places, x);
    }
    (all, pivots)
}

/// Makes every row's largest element its pivot and zero in all rows below. Nothing is swapped: whole rows are
/// worked on.
#[inline(never)]
fn eliminate<T: Real, const N: usize>(rows: &mut [[T; N]], pivots: &mut [T], places: &mut [usize]) {
    let mut rest = rows;
    for (pivot_slot, place_slot) in pivots.iter_mut().zip(places) {
        let Some((row, below)) = rest.split_first_mut() else { break };
        // A copy, which stays in registers.
        let row = *row;
        let (mut place, mut pivot) = (0, T::ZERO);
        for (j, &element) in row.iter().enumerate() {
            if element.abs() > pivot.abs() {
                (place, pivot) = (j, element);
            }
        }
        // Less than N anyway; the compiler cannot know.
        let place = place.min(N - 1);
        (*place_slot, *pivot_slot) = (place, pivot);
        let inverse = inverse_of(pivot);
        for other in below.iter_mut() {
            let by = other[place] * inverse;
            combine(other, T::ONE, &row, -by);
            other[place] = T::ZERO;
        }
        rest = below;
    }
}

/// From x with the unknowns that are free, and zero for the others, all of it.
#[inline(never)]
fn solve<T: Real, const N: usize>(rows: &[[T; N]], pivots: &[T], places: &[usize], x: &mut [T; N]) {
    for ((row, &pivot), &place) in rows.iter().zip(pivots).zip(places).rev() {
        // What stands in the columns of the pivots above is zero.
        let value = -dot(row, x) * inverse_of(pivot);
        x[place.min(N - 1)] = value;
    }
}

/// What a row is divided by. In one that depends on the others any number will do: the caller sees it by the
/// pivot.
fn inverse_of<T: Real>(pivot: T) -> T {
    if pivot == T::ZERO { T::ZERO } else { T::ONE / pivot }
}

/// How many pivots are more than a `share` of the largest.
#[inline(never)]
pub(crate) fn rank<T: Real>(pivots: &[T], share: T) -> usize {
    let least = pivots.iter().fold(T::ZERO, |most, pivot| larger(most, pivot.abs())) * share;
    pivots.iter().filter(|pivot| pivot.abs() > least).count()
}

#[cfg(test)]
mod tests {
    use super::{basis_of_rows, null_of_rows, rank};

    #[test]
    fn two_rows_leave_their_cross_product() {
        // (1, 0, 2) x (0, 1, 2) = (-2, -2, 1).
        let (x, pivots) = null_of_rows::<f64, 2, 3>(&mut [[1.0, 0.0, 2.0], [0.0, 1.0, 2.0]]);
        let sign = -x[0].signum();
        for (x, expected) in x.iter().zip([-2.0, -2.0, 1.0]) {
            assert!((sign * x - expected / 3.0).abs() < 1e-15, "{x}");
        }
        // The second row less the first is (-1, 1, 0).
        assert_eq!(pivots, [2.0, -1.0]);
    }

    #[test]
    fn a_row_that_depends_on_another_is_told() {
        let (_, pivots) = null_of_rows::<f64, 2, 3>(&mut [[1.0, 3.0, 2.0], [-2.0, -6.0, -4.0]]);
        assert_eq!((pivots, rank(&pivots, 0.1)), ([3.0, 0.0], 1));
        assert_eq!([rank(&[4.0, 1.0], 0.2), rank(&[4.0, 1.0], 0.3), rank(&[0.0, 0.0], 0.1)], [2, 1, 0]);
    }
    #[test]
    fn one_row_leaves_a_plane() {
        let ([a, b], pivots) = basis_of_rows::<f64, 1, 3, 2>(&mut [[1.0, 2.0, -2.0]]);
        assert_eq!((a, b, pivots), ([1.0, -0.5, 0.0], [0.0, 1.0, 1.0], [2.0]));
    }
}
