//! The five-point algorithm for E of calibrated cameras (Nister 2004).

#![allow(
    clippy::needless_range_loop,
    reason = "an element is named by its row and column, as in the equations"
)]

use crate::geometry::Real;
use crate::geometry::linear::{basis_of_rows, polynomial_roots, rank, unit};
use nalgebra::{Matrix3, Point2, Vector3};

/// Up to ten essential matrices.
pub(crate) type EssentialCandidates<T> = heapless::Vec<Matrix3<T>, 10>;

/// Coefficients of x, y, z and 1.
type Linear = [f64; 4];
/// Those of x^2, xy, y^2, xz, yz, z^2, x, y, z, 1.
type Quadratic = [f64; 10];
/// Those of x^3, y^3, x^2 y, x y^2, x^2 z, x^2, y^2 z, y^2, xyz, xy, and of x z^2, xz, x, y z^2, yz, y, z^3,
/// z^2, z, 1.
type Cubic = [f64; 20];

/// The place of each product of two of x, y, z and 1 among the coefficients of a [`Quadratic`].
const SECOND: [[usize; 4]; 4] = [[0, 1, 3, 6], [1, 2, 4, 7], [3, 4, 5, 8], [6, 7, 8, 9]];
/// The place of each product of one of a [`Quadratic`] with x, y, z and 1 in a [`Cubic`].
const THIRD: [[usize; 4]; 10] = [
    [0, 2, 4, 5],
    [2, 3, 8, 9],
    [3, 1, 6, 7],
    [4, 8, 10, 11],
    [8, 6, 13, 14],
    [10, 13, 16, 17],
    [5, 9, 11, 12],
    [9, 7, 14, 15],
    [11, 14, 17, 18],
    [12, 15, 18, 19],
];

/// The essential matrices E with `p^T E p' = 0` for five pairs of points of the plane Z = 1 of calibrated
/// cameras, up to ten (Nister 2004).
///
/// What five equations leave free is `x X + y Y + z Z + W`; that its determinant is zero and its two singular
/// values are alike are ten cubics of x, y and z, of which elimination leaves a polynomial of z of degree
/// ten. Its real roots are bracketed by those of its derivatives, so that the work is bounded: about 70 000
/// operations. None for a degenerate sample.
///
/// In `f64` also for `f32`: the elimination of cubics loses half of the digits, and the polynomial a third.
pub(crate) fn five_point<T: Real>(seen: &[(Point2<T>, Point2<T>); 5]) -> EssentialCandidates<T> {
    let mut candidates = EssentialCandidates::new();
    let mut rows = [[1.0; 9]; 5];
    for (row, (p, q)) in rows.iter_mut().zip(seen) {
        let [a, b, c, d] = [p.x, p.y, q.x, q.y].map(Real::to_f64);
        *row = [a * c, a * d, a, b * c, b * d, b, c, d, 1.0];
    }
    let (mut basis, pivots): ([[f64; 9]; 4], _) = basis_of_rows(&mut rows);
    if rank(&pivots, 1e-9) < 5 {
        return candidates;
    }
    basis.iter_mut().for_each(|vector| unit(vector));
    let Some(below) = eliminated(constraints(&basis)) else { return candidates };
    let rows = in_z(&below);
    let (roots, count) = polynomial_roots(&determinant(&rows));
    for &z in roots.iter().take(count) {
        let Some((x, y)) = others(&rows, z) else { continue };
        let weights = [x, y, z, 1.0];
        let mut e = [0.0; 9];
        for (vector, weight) in basis.iter().zip(weights) {
            e.iter_mut().zip(vector).for_each(|(e, v)| *e += weight * v);
        }
        let size = e.iter().map(|v| v * v).sum::<f64>();
        if size > 0.0 && size.is_finite() {
            let by = 1.0 / nalgebra::ComplexField::sqrt(size);
            let [a, b, c, d, e, f, g, h, i] = e.map(|v| T::of(v * by));
            // There are no more than ten.
            let _ = candidates.push(Matrix3::new(a, b, c, d, e, f, g, h, i));
        }
    }
    candidates
}

fn times(a: &Linear, b: &Linear, sign: f64, to: &mut Quadratic) {
    for i in 0..4 {
        for j in 0..4 {
            to[SECOND[i][j]] += sign * a[i] * b[j];
        }
    }
}

fn times_quadratic(a: &Quadratic, b: &Linear, sign: f64, to: &mut Cubic) {
    for i in 0..10 {
        for j in 0..4 {
            to[THIRD[i][j]] += sign * a[i] * b[j];
        }
    }
}

/// `det E = 0` and `E E^T E - tr(E E^T) E / 2 = 0`.
fn constraints(basis: &[[f64; 9]; 4]) -> [Cubic; 10] {
    let [bx, by, bz, bw] = basis;
    let mut e = [[[0.0; 4]; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            let k = 3 * i + j;
            e[i][j] = [bx[k], by[k], bz[k], bw[k]];
        }
    }
    let mut out = [[0.0; 20]; 10];
    // The determinant along the first row.
    for (i, (j, k)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
        let mut minor = [0.0; 10];
        times(&e[1][j], &e[2][k], 1.0, &mut minor);
        times(&e[1][k], &e[2][j], -1.0, &mut minor);
        times_quadratic(&minor, &e[0][i], 1.0, &mut out[9]);
    }
    let mut squares = [[[0.0; 10]; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            for k in 0..3 {
                times(&e[i][k], &e[j][k], 1.0, &mut squares[i][j]);
            }
        }
    }
    let mut half_trace = [0.0; 10];
    for (k, half) in half_trace.iter_mut().enumerate() {
        *half = 0.5 * (squares[0][0][k] + squares[1][1][k] + squares[2][2][k]);
    }
    for i in 0..3 {
        for k in 0..10 {
            squares[i][i][k] -= half_trace[k];
        }
    }
    for i in 0..3 {
        for j in 0..3 {
            for k in 0..3 {
                times_quadratic(&squares[i][k], &e[k][j], 1.0, &mut out[3 * i + j]);
            }
        }
    }
    out
}

/// Gauss-Jordan elimination of the first ten columns; the last ten of the rows whose pivots are x^2 z, x^2,
/// y^2 z, y^2, xyz and xy.
fn eliminated(mut rows: [Cubic; 10]) -> Option<[[f64; 10]; 6]> {
    for column in 0..10 {
        let (mut best, mut place) = (0.0, column);
        for i in column..10 {
            if rows[i][column].abs() > best {
                (best, place) = (rows[i][column].abs(), i);
            }
        }
        // Nothing, or not a number.
        if !(best > 1e-14) {
            return None;
        }
        rows.swap(column, place.min(9));
        let by = 1.0 / rows[column][column];
        let pivot = rows[column].map(|v| v * by);
        for i in 0..10 {
            let times = rows[i][column];
            if i != column {
                rows[i].iter_mut().zip(&pivot).for_each(|(v, p)| *v -= times * p);
            }
        }
        rows[column] = pivot;
    }
    let mut out = [[0.0; 10]; 6];
    for (out, row) in out.iter_mut().zip(rows.iter().skip(4)) {
        out.iter_mut().zip(row.iter().skip(10)).for_each(|(out, v)| *out = *v);
    }
    Some(out)
}

/// A row `x a(z) + y b(z) + c(z)`: coefficients of rising powers.
type Row = ([f64; 4], [f64; 4], [f64; 5]);

/// Rows without x^2, y^2 and xy: those with z as a factor less z times those without.
fn in_z([x2z, x2, y2z, y2, xyz, xy]: &[[f64; 10]; 6]) -> [Row; 3] {
    let row = |with: &[f64; 10], without: &[f64; 10]| {
        let of = |two: usize, one: usize, zero: usize| {
            [with[zero], with[one] - without[zero], with[two] - without[one], -without[two]]
        };
        let constant =
            [with[9], with[8] - without[9], with[7] - without[8], with[6] - without[7], -without[6]];
        (of(0, 1, 2), of(3, 4, 5), constant)
    };
    [row(x2z, x2), row(y2z, y2), row(xyz, xy)]
}

/// The determinant of the three rows, a polynomial of degree ten.
fn determinant([r, s, t]: &[Row; 3]) -> [f64; 11] {
    let mut out = [0.0; 11];
    for (one, two, three, sign) in
        [(r, s, t, 1.0), (s, t, r, 1.0), (t, r, s, 1.0), (r, t, s, -1.0), (t, s, r, -1.0), (s, r, t, -1.0)]
    {
        for (i, a) in one.0.iter().enumerate() {
            for (j, b) in two.1.iter().enumerate() {
                for (k, c) in three.2.iter().enumerate() {
                    if let Some(to) = out.get_mut(i + j + k) {
                        *to += sign * a * b * c;
                    }
                }
            }
        }
    }
    out
}

/// The x and y that the rows leave for z.
fn others(rows: &[Row; 3], z: f64) -> Option<(f64, f64)> {
    let at = |coefficients: &[f64]| coefficients.iter().rev().fold(0.0, |sum, c| sum * z + c);
    let [r, s, t] = rows.each_ref().map(|(a, b, c)| Vector3::new(at(a), at(b), at(c)));
    // Any two rows have the solution as their cross product: the largest is the surest.
    let [a, b, c] = [r.cross(&s), s.cross(&t), t.cross(&r)];
    let mut best = a;
    for other in [b, c] {
        if other.norm_squared() > best.norm_squared() {
            best = other;
        }
    }
    (best.z.abs() > 1e-12 * best.amax()).then(|| (best.x / best.z, best.y / best.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::camera::Pose;
    use crate::geometry::two_view::Essential;
    use nalgebra::{Point3, Rotation3};

    #[test]
    fn the_true_matrix_is_among_the_candidates() {
        // A camera that is turned by 35 degrees and stands a metre and a half beside the first one.
        let turn = Rotation3::new(Vector3::new(0.1, -0.6, 0.05));
        let pose = Pose::new(*turn.matrix(), Vector3::new(1.5, 0.2, 0.4_f64)).expect("a pose");
        let points = [[-1.0, 0.5, 3.0], [0.4, -0.7, 4.0], [0.9, 0.8, 5.0], [-0.3, 0.1, 3.5], [0.6, 0.2, 6.0]];
        let seen = points.map(|[x, y, z]| {
            let there = pose.inverse_transform(&Point3::new(x, y, z));
            (Point2::new(x / z, y / z), Point2::new(there.x / there.z, there.y / there.z))
        });
        let truth = Essential::from_pose(&pose).expect("a baseline");
        let truth = truth.matrix() / truth.matrix().norm();
        let candidates = five_point(&seen);
        let off = candidates.iter().map(|c| (c - truth).amax().min((c + truth).amax()));
        assert!(off.fold(f64::MAX, f64::min) < 1e-9, "{candidates:?}");
        for e in &candidates {
            // Singular values s, s, 0 of a matrix of size one.
            let squares = e * e.transpose();
            assert!((squares * e * 2.0 - e * squares.trace()).amax() < 1e-7, "{e}");
        }
        let narrow = seen.map(|(p, q)| (p.cast::<f32>(), q.cast::<f32>()));
        let truth = truth.cast::<f32>();
        let candidates = five_point(&narrow);
        let off = candidates.iter().map(|c| (c - truth).amax().min((c + truth).amax()));
        assert!(off.fold(f32::MAX, f32::min) < 1e-4);
    }

    #[test]
    fn repeated_points_give_none() {
        let one = (Point2::new(0.1, 0.2), Point2::new(0.3, -0.1_f64));
        assert!(five_point(&[one; 5]).is_empty());
    }
}
