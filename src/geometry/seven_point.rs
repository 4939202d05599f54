//! F from seven correspondences, as few as determine it.

#![allow(clippy::needless_range_loop, reason = "an element is named by its row and column, as in the equations")]

use super::Real;
use super::linear::{cubic_roots, matrix3, rows3};
use nalgebra::{Matrix3, Point2};

/// Up to three fundamental matrices.
pub(crate) type Candidates<T> = heapless::Vec<Matrix3<T>, 3>;

/// The singular matrices F with `p^T F p' = 0` for seven pairs of normalised points, one or three (Hartley & Zisserman
/// 2004, 11.1.2): what the seven equations leave free is a pencil `G + x H`, and `det (G + x H)` is a cubic of x.
///
/// None for a degenerate sample: seven equations of which one depends on the others, as those of repeated points or of
/// seven points on a plane do; `1e-7` of the largest pivot (in `f32` 32 roundings) count as nothing.
#[inline]
pub(crate) fn seven_point<T: Real>(seen: &[(Point2<T>, Point2<T>); 7]) -> Candidates<T> {
    let rows = seen.map(|(p, q)| [p.x * q.x, p.x * q.y, p.x, p.y * q.x, p.y * q.y, p.y, q.x, q.y, T::ONE]);
    let mut candidates = Candidates::new();
    let Some([g, h]) = pencil(rows) else { return candidates };
    let (g, h) = (matrix3(&rows3(g)), matrix3(&rows3(h)));
    let (of_g, of_h) = (cofactors(&g), cofactors(&h));
    let (c0, c3) = (of_g.column(0).dot(&g.column(0)), of_h.column(0).dot(&h.column(0)));
    let (c1, c2) = (of_g.dot(&h), of_h.dot(&g));
    // The leading coefficient is the larger one, so that no root is at infinity.
    let turned = c3.abs() < c0.abs();
    let (roots, count) = cubic_roots(if turned { [c3, c2, c1, c0] } else { [c0, c1, c2, c3] });
    for &x in roots.iter().take(count) {
        let f = if turned { h + g * x } else { g + h * x };
        // There are no more than three.
        let _ = candidates.push(f / f.norm());
    }
    candidates
}

/// The derivative of the determinant by each element.
fn cofactors<T: Real>(m: &Matrix3<T>) -> Matrix3<T> {
    let (a, b, c) = (m.column(0), m.column(1), m.column(2));
    Matrix3::from_columns(&[b.cross(&c), c.cross(&a), a.cross(&b)])
}

/// Two vectors, each of length one, that span what seven rows leave free, by elimination with the largest element of
/// each row as its pivot; `None` when a row depends on those before it.
#[inline(always)]
fn pencil<T: Real>(mut rows: [[T; 9]; 7]) -> Option<[[T; 9]; 2]> {
    let mut order: [usize; 9] = core::array::from_fn(|i| i);
    let mut inverse_pivots = [T::ZERO; 7];
    let mut most = T::ZERO;
    let least = T::of(1e-7).max(T::EPSILON * T::of(32.0));
    for k in 0..7 {
        let mut best = k;
        for j in k + 1..9 {
            if rows[k][j].abs() > rows[k][best.min(8)].abs() {
                best = j;
            }
        }
        let best = best.min(8);
        if best != k {
            order.swap(k, best);
            for row in &mut rows {
                row.swap(k, best);
            }
        }
        let pivot = rows[k][k];
        most = most.max(pivot.abs());
        if !(pivot.abs() > least * most) {
            return None;
        }
        inverse_pivots[k] = T::ONE / pivot;
        for i in k + 1..7 {
            let factor = rows[i][k] * inverse_pivots[k];
            for j in k + 1..9 {
                rows[i][j] -= factor * rows[k][j];
            }
        }
    }
    Some([7, 8].map(|free| {
        let mut x = [T::ZERO; 9];
        x[free] = T::ONE;
        for i in (0..7).rev() {
            let mut sum = rows[i][free];
            for j in i + 1..7 {
                sum += rows[i][j] * x[j];
            }
            x[i] = -sum * inverse_pivots[i];
        }
        let by = T::ONE / x.iter().fold(T::ZERO, |sum, &v| sum + v * v).sqrt();
        let mut restored = [T::ZERO; 9];
        for (&value, &place) in x.iter().zip(&order) {
            if let Some(slot) = restored.get_mut(place) {
                *slot = value * by;
            }
        }
        restored
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectified_pair_is_among_the_candidates() {
        // Seven corners of a box, rows equal: F = [0 0 0; 0 0 -1; 0 1 0] over its size.
        let seen = [(0, 0, 8), (9, 0, 9), (0, 7, 6), (9, 7, 7), (2, 2, 4), (6, 1, 3), (3, 5, 2)].map(|(u, v, d)| {
            (Point2::new(f64::from(u), f64::from(v)) / 9.0, Point2::new(f64::from(u - d), f64::from(v)) / 9.0)
        });
        let candidates = seven_point(&seen);
        let f = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0) / 2.0_f64.sqrt();
        let off = candidates.iter().map(|c| (c - f).amax().min((c + f).amax())).fold(f64::MAX, f64::min);
        assert!(off < 1e-12, "{off}");
        for c in &candidates {
            assert!(c.determinant().abs() < 1e-14);
            let residual = |(p, q): &(Point2<f64>, Point2<f64>)| p.to_homogeneous().dot(&(c * q.to_homogeneous()));
            assert!(seen.iter().all(|s| residual(s).abs() < 1e-14));
        }
    }

    #[test]
    fn repeated_points_give_none() {
        let seen = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.2), (0.3, 0.9), (0.3, 0.9_f64)]
            .map(|(u, v)| (Point2::new(u, v), Point2::new(u * u + 0.1, v - 0.3 * u)));
        assert!(seven_point(&seen).is_empty());
    }
}
