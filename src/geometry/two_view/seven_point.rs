//! The seven-point algorithm for F (Hartley & Zisserman 2004, 11.1.2).

use crate::geometry::Real;
use crate::geometry::linear::{basis_of_rows, columns3, cubic_roots, larger, matrix3, rank, rows3};
use nalgebra::{Matrix3, Point2};

/// Up to three fundamental matrices, of any size.
pub(crate) type Candidates<T> = heapless::Vec<Matrix3<T>, 3>;

/// The singular matrices F with `p^T F p' = 0` for seven pairs of normalised points, one or three (Hartley &
/// Zisserman 2004, 11.1.2): what the seven equations leave free is a pencil `G + x H`, and `det (G + x H)` is
/// a cubic of x.
///
/// None for a degenerate sample: seven equations of which one depends on the others, as those of repeated
/// points or of seven points on a plane do; `1e-7` of the largest pivot (in `f32` 32 roundings) count as
/// nothing.
#[inline]
pub(crate) fn seven_point<T: Real>(seen: &[(Point2<T>, Point2<T>); 7]) -> Candidates<T> {
    let mut candidates = Candidates::new();
    let mut rows = [[T::ONE; 9]; 7];
    for (row, (p, q)) in rows.iter_mut().zip(seen) {
        *row = [p.x * q.x, p.x * q.y, p.x, p.y * q.x, p.y * q.y, p.y, q.x, q.y, T::ONE];
    }
    let ([g, h], pivots) = basis_of_rows(&mut rows);
    if rank(&pivots, larger(T::of(1e-7), T::EPSILON * T::of(32.0))) < 7 {
        return candidates;
    }
    let (g, h) = (matrix3(&rows3(g)), matrix3(&rows3(h)));
    let (of_g, of_h) = (cofactors(&g), cofactors(&h));
    let determinant = |m: &Matrix3<T>, of: &Matrix3<T>| m.m11 * of.m11 + m.m21 * of.m21 + m.m31 * of.m31;
    let (c0, c3) = (determinant(&g, &of_g), determinant(&h, &of_h));
    let (c1, c2) = (of_g.dot(&h), of_h.dot(&g));
    // The leading coefficient is the larger one, so that no root is at infinity.
    let swapped = c3.abs() < c0.abs();
    let (roots, count) = cubic_roots(if swapped { [c3, c2, c1, c0] } else { [c0, c1, c2, c3] });
    for &x in roots.iter().take(count) {
        let f = if swapped { h + g * x } else { g + h * x };
        // There are no more than three.
        let _ = candidates.push(f);
    }
    candidates
}

/// The derivative of the determinant by each element.
fn cofactors<T: Real>(m: &Matrix3<T>) -> Matrix3<T> {
    let [a, b, c] = columns3(m);
    Matrix3::from_columns(&[b.cross(&c), c.cross(&a), a.cross(&b)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectified_pair_is_among_the_candidates() {
        // Seven corners of a box, rows equal: F = [0 0 0; 0 0 -1; 0 1 0] over its size.
        let seen =
            [(0, 0, 8), (9, 0, 9), (0, 7, 6), (9, 7, 7), (2, 2, 4), (6, 1, 3), (3, 5, 2)].map(|(u, v, d)| {
                (
                    Point2::new(f64::from(u), f64::from(v)) / 9.0,
                    Point2::new(f64::from(u - d), f64::from(v)) / 9.0,
                )
            });
        let candidates = seven_point(&seen);
        let f = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0) / 2.0_f64.sqrt();
        let off = candidates
            .iter()
            .map(|c| c / c.norm())
            .map(|c| (c - f).amax().min((c + f).amax()))
            .fold(f64::MAX, f64::min);
        assert!(off < 1e-12, "{off}");
        for c in &candidates {
            assert!(c.determinant().abs() < 1e-14);
            let residual =
                |(p, q): &(Point2<f64>, Point2<f64>)| p.to_homogeneous().dot(&(c * q.to_homogeneous()));
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
