//! The normalised eight-point algorithm (Longuet-Higgins 1981; Hartley 1997).

use super::correspondence::Correspondence;
use super::degenerate::{self, EightPointError};
use super::fundamental::Fundamental;
use super::normalise::Both;
use super::weighted::Weighted;
use crate::geometry::Real;
use crate::geometry::linear::{
    Ldl, basis_of_rows, dot, larger, rank, rows3, times_transposed3, transposed3, unit,
};

/// Squarings at most: of a second singular value that is a thousandth more than the smallest e^-8 is left
/// after them, and where the two are nearer than that, either matrix is as near.
const MOST_SQUARINGS: usize = 12;

/// The fundamental matrix of eight correspondences or more, px, by the normalised eight-point algorithm: F
/// minimises `sum (p^T F p')^2` with `|F| = 1` over points normalised after Hartley, and is then replaced by
/// the nearest singular matrix (Longuet-Higgins 1981; Hartley 1997; Hartley & Zisserman 2004, algorithm
/// 11.1). All correspondences are used: one that is wrong spoils the result.
///
/// Eight are solved by elimination, more by their normal equations. Sampson's error (root mean square) on
/// exact points of a 640 x 480 image is under 1e-9 px in `f64`. In `f32` it is under 0.001 px for eight and
/// under 0.002 px for twenty or more, mostly a tenth of that, near the rounding of the coordinates
/// themselves; from 0.1 px of noise on `f32` and `f64` err alike. With 9 to 11 correspondences the normal
/// equations lose more in `f32`: 0.02 px, and one set of nine in sixty is refused as
/// [`EightPointError::Undetermined`].
///
/// A set that is degenerate to 0.0007 px is refused by name; in `f32` to 0.02 px for eight and to 0.3 px for
/// more. Points that are on a plane only to within their noise are not refused here, for the noise is not
/// known: [`choose`](super::choose) finds those.
///
/// ```
/// use stereopsis::geometry::two_view::{Correspondence, EightPointError, eight_point};
/// // The corners of a box, seen by a rectified pair: rows are equal.
/// let corners = [(0, 0, 8), (9, 0, 9), (0, 7, 6), (9, 7, 7), (2, 2, 4), (6, 1, 3), (3, 5, 2), (7, 6, 5)];
/// let px = |x: i32| f64::from(x);
/// let seen = corners.map(|(u, v, d)| Correspondence::new(px(u), px(v), px(u - d), px(v)));
/// let f = eight_point(&seen)?;
/// assert!(seen.iter().all(|s| f.sampson_px(s).abs() < 1e-12));
/// assert_eq!(eight_point(&seen[..7]), Err(EightPointError::TooFew));
/// # Ok::<(), EightPointError>(())
/// ```
pub fn eight_point<T: Real>(seen: &[Correspondence<T>]) -> Result<Fundamental<T>, EightPointError> {
    solve(Weighted::alike(seen))
}

/// The fundamental matrix of eight correspondences or more with weights: it minimises `sum w (p^T F p')^2`. A
/// weight of zero leaves a correspondence out altogether, and so does a negative one; correspondences without
/// a weight are left out.
pub fn eight_point_weighted<T: Real>(
    seen: &[Correspondence<T>],
    weights: &[T],
) -> Result<Fundamental<T>, EightPointError> {
    solve(Weighted::new(seen, weights))
}

fn solve<T: Real>(seen: Weighted<'_, T>) -> Result<Fundamental<T>, EightPointError> {
    // A sum with something infinite or not a number in it is neither.
    let (count, sum) = seen.iter().fold((0, T::ZERO), |(count, sum), (s, w)| {
        (count + 1, sum + s.first.x + s.first.y + s.second.x + s.second.y + w)
    });
    if count < 8 {
        return Err(EightPointError::TooFew);
    }
    if !sum.is_finite() {
        return Err(EightPointError::NotFinite);
    }
    let Some(both) = Both::of(seen) else {
        // One point in one of the images: nothing is more on a line.
        let repeated = degenerate::distinct::<T, 8>(seen) < 8;
        return Err(if repeated { EightPointError::Repeated } else { EightPointError::Line });
    };

    // Elimination works on the equations, the factor on their squares.
    let on_it = T::of(degenerate::ON_IT);
    let (f, pivots, on_it, least) = if count == 8 {
        let (f, pivots) = of_eight(seen, &both);
        (f, pivots, larger(on_it, T::EPSILON * T::of(1024.0)), T::EPSILON * T::of(64.0))
    } else {
        let ldl = Ldl::<T, 9>::new(&mut normal_matrix(seen, &both));
        let [a, b, c, d, e, f, g, h, _] = *ldl.pivots();
        let least = larger(T::of(1e-14), T::EPSILON * T::of(4.0));
        let on_it = larger(on_it * on_it, T::EPSILON * T::of(32.0));
        (ldl.null_vector(), [a, b, c, d, e, f, g, h], on_it, least)
    };
    let f = rows3(f);
    let full = rank(&pivots, on_it);
    if full < 8 {
        // Of any size until here.
        let mut f = f;
        unit(f.as_flattened_mut());
        let cofactors = cofactors(&f);
        if let Some(reason) = degenerate::reason(seen, full, dot(&f[0], &cofactors[0]), &cofactors) {
            return Err(reason);
        }
        if rank(&pivots, least) < 8 {
            return Err(EightPointError::Undetermined);
        }
    }
    let found = Fundamental::of_rows(both.in_pixels(nearest_singular(&f)));
    if found.is_sound() { Ok(found) } else { Err(EightPointError::NotFinite) }
}

/// The elements of the normalised F of eight correspondences, of any size, and the pivots of its equations.
///
/// A row has the factors of f11, f12, f13, f21 ... in `p^T F p'`: p's numbers times those of p'. That of f33
/// is one in all rows: less the first, the others have eight unknowns, and the first, whose pivot is that
/// one, gives f33.
fn of_eight<T: Real>(seen: Weighted<'_, T>, both: &Both<T>) -> ([T; 9], [T; 8]) {
    let mut rows = [[T::ZERO; 8]; 8];
    for (row, (seen, _)) in rows.iter_mut().zip(seen.iter()) {
        let (p, q) = both.apply(seen);
        *row = [p.x * q.x, p.x * q.y, p.x, p.y * q.x, p.y * q.y, p.y, q.x, q.y];
    }
    let [first, others @ ..] = &mut rows;
    for row in others.iter_mut() {
        row.iter_mut().zip(first.iter()).for_each(|(element, &of_first)| *element -= of_first);
    }
    let ([x], [p, q, r, s, t, u, v]) = basis_of_rows(others);
    let [a, b, c, d, e, f, g, h] = x;
    ([a, b, c, d, e, f, g, h, -dot(first, &x)], [T::ONE, p, q, r, s, t, u, v])
}

/// The sum of `w r r^T` over the rows r of all correspondences. r is p times p', so that of its 81 elements
/// only six of p p^T times six of p' p'^T differ.
#[allow(clippy::needless_range_loop, reason = "an element is named by its row and column")]
fn normal_matrix<T: Real>(seen: Weighted<'_, T>, both: &Both<T>) -> [[T; 9]; 9] {
    let mut sums = [[T::ZERO; 6]; 6];
    for (seen, w) in seen.iter() {
        let (p, q) = both.apply(seen);
        let (a, b) = (p.x * w, p.y * w);
        let p = [a * p.x, a * p.y, b * p.y, a, b, w];
        let q = [q.x * q.x, q.x * q.y, q.y * q.y, q.x, q.y, T::ONE];
        for (row, &a) in sums.iter_mut().zip(&p) {
            for (sum, &b) in row.iter_mut().zip(&q) {
                *sum += a * b;
            }
        }
    }
    /// Where the product of numbers i and j of (x, y, 1) stands among the six.
    const PRODUCT: [[usize; 3]; 3] = [[0, 1, 3], [1, 2, 4], [3, 4, 5]];
    let mut normal = [[T::ZERO; 9]; 9];
    for i in 0..9 {
        for j in 0..9 {
            // At most 5 anyway; the compiler cannot know.
            let (p, q) = (PRODUCT[i / 3][j / 3].min(5), PRODUCT[i % 3][j % 3].min(5));
            normal[i][j] = sums[p][q];
        }
    }
    normal
}

/// `F - (F v) v^T` with v the singular vector of the smallest singular value: the nearest singular matrix.
///
/// v is the eigenvector of the largest eigenvalue of `C^T C`, where C is F's matrix of cofactors: its
/// singular values are the products of two of F's. The matrix is squared until nothing else is left in it.
fn nearest_singular<T: Real>(f: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    let columns = transposed3(cofactors(f));
    let mut power = times_transposed3(&columns, &columns);
    for _ in 0..MOST_SQUARINGS {
        let by = T::ONE / trace(&power);
        power.as_flattened_mut().iter_mut().for_each(|x| *x *= by);
        // It is symmetric.
        power = times_transposed3(&power, &power);
        // One less the sum of the squared eigenvalues, whose sum is one: about two of the second, which was
        // squared now.
        if T::ONE - trace(&power) <= T::EPSILON.sqrt() {
            break;
        }
    }
    let by = T::ONE / trace(&power);
    let off = times_transposed3(f, &power);
    let mut nearest = *f;
    for (x, &off) in nearest.as_flattened_mut().iter_mut().zip(off.as_flattened()) {
        *x -= off * by;
    }
    nearest
}

fn trace<T: Real>(m: &[[T; 3]; 3]) -> T {
    m[0][0] + m[1][1] + m[2][2]
}

/// The derivatives of the determinant by the elements: the cross products of the rows.
fn cofactors<T: Real>([a, b, c]: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    [cross(b, c), cross(c, a), cross(a, b)]
}

/// `a x b`.
#[inline(never)]
fn cross<T: Real>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_singular_matrix_drops_the_smallest_value() {
        let f = [[3.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 2.0_f64]];
        let found = nearest_singular(&f);
        let expected = [[3.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.0]];
        let off = found.as_flattened().iter().zip(expected.as_flattened()).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-15, "{found:?}");
    }

    #[test]
    fn the_normal_matrix_is_the_rows_squared() {
        // Normalised, the points are (-1, 0) and (1, 0) times the root of two, in both images.
        let seen = [(10.0, 14.0), (12.0, 14.0_f64)].map(|(u, v)| Correspondence::new(u, v, u + 3.0, v - 5.0));
        let (seen, r) = (Weighted::new(&seen, &[0.5, 0.5]), 2.0_f64.sqrt());
        let both = Both::of(seen).expect("two points");
        let normal = normal_matrix(seen, &both);
        let rows = [-r, r].map(|x| [x * x, 0.0, x, 0.0, 0.0, 0.0, x, 0.0, 1.0]);
        for (i, j) in (0..9).flat_map(|i| (0..9).map(move |j| (i, j))) {
            let expected: f64 = rows.iter().map(|row| 0.5 * row[i] * row[j]).sum();
            assert!((normal[i][j] - expected).abs() < 1e-14, "{i} {j}");
        }
    }
}
