//! F from eight correspondences or more.

use super::linear::{Ldl, matrix3, null_of_rows};
use super::normalise::Normalisation;
use super::{Correspondence, Fundamental, Real, degenerate};
use nalgebra::{Matrix3, Vector3};

/// Why correspondences give no fundamental matrix.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum EightPointError {
    /// Fewer than eight correspondences.
    TooFew,
    /// A number is infinite or not a number.
    NotFinite,
    /// Fewer than eight correspondences that are not the same.
    Repeated,
    /// In one of the images all points are on a line.
    Line,
    /// One homography maps all points: they are on a plane, or the camera has only turned.
    Plane,
    /// Two or more matrices fit, for no reason of the above: all points and both camera centres are on one quadric, such
    /// as a sphere, a cylinder or a pair of planes.
    Undetermined,
}

impl core::fmt::Display for EightPointError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::TooFew => "a fundamental matrix needs eight correspondences",
            Self::NotFinite => "a coordinate is not finite",
            Self::Repeated => "a fundamental matrix needs eight correspondences that are not the same",
            Self::Line => "the points of an image are on a line",
            Self::Plane => "the points are on a plane, or the camera has only turned: a homography is the answer",
            Self::Undetermined => "more than one fundamental matrix fits the points",
        })
    }
}

impl core::error::Error for EightPointError {}

/// The fundamental matrix of eight correspondences or more, px, by the normalised eight-point algorithm: F minimises
/// `sum (p^T F p')^2` with `|F| = 1` over points normalised after Hartley, and is then replaced by the nearest singular
/// matrix (Longuet-Higgins 1981; Hartley 1997; Hartley & Zisserman 2004, algorithm 11.1). All correspondences are used:
/// one that is wrong spoils the result.
///
/// Eight are solved by elimination, more by their normal equations. Sampson's error (root mean square) on exact points of
/// a 640 x 480 image is under 1e-9 px in `f64`. In `f32` it is under 0.001 px for eight and under 0.002 px for twenty or
/// more, mostly a tenth of that, near the rounding of the coordinates themselves; from 0.1 px of noise on `f32` and `f64`
/// err alike. With 9 to 11 correspondences the normal equations lose more in `f32`: 0.02 px, and one set of nine in sixty
/// is refused as [`EightPointError::Undetermined`].
///
/// A set that is degenerate to 0.0007 px is refused by name. Points that are on a plane only to within their noise are
/// not refused here, for the noise is not known: [`choose`](super::choose) tells those.
///
/// ```
/// use stereopsis::geometry::{Correspondence, EightPointError, eight_point};
/// // The corners of a box, seen by a rectified pair: rows are equal.
/// let corners = [(0, 0, 8), (9, 0, 9), (0, 7, 6), (9, 7, 7), (2, 2, 4), (6, 1, 3), (3, 5, 2), (7, 6, 5)];
/// let seen = corners.map(|(u, v, d)| Correspondence::new(f64::from(u), f64::from(v), f64::from(u - d), f64::from(v)));
/// let f = eight_point(&seen)?;
/// assert!(seen.iter().all(|s| f.sampson_px(s).abs() < 1e-12));
/// assert_eq!(eight_point(&seen[..7]), Err(EightPointError::TooFew));
/// # Ok::<(), EightPointError>(())
/// ```
pub fn eight_point<T: Real>(seen: &[Correspondence<T>]) -> Result<Fundamental<T>, EightPointError> {
    solve(seen.iter().map(|&s| (s, T::ONE)))
}

/// The same with each squared residual times its weight: `sum w (p^T F p')^2`. A weight of zero leaves a correspondence
/// out altogether, and so does a negative one; correspondences without a weight are left out.
pub fn eight_point_weighted<T: Real>(
    seen: &[Correspondence<T>],
    weights: &[T],
) -> Result<Fundamental<T>, EightPointError> {
    let weighted = seen.iter().copied().zip(weights.iter().copied());
    // What is not a number stays in, and is refused.
    solve(weighted.filter(|&(_, weight)| !(weight <= T::ZERO)))
}

#[inline(always)]
fn solve<T: Real>(
    seen: impl Iterator<Item = (Correspondence<T>, T)> + Clone,
) -> Result<Fundamental<T>, EightPointError> {
    let plain = seen.clone().map(|(s, _)| s);
    let count = plain.clone().count();
    if count < 8 {
        return Err(EightPointError::TooFew);
    }
    // A sum with something infinite or not a number in it is neither.
    let sum = seen.clone().fold(T::ZERO, |sum, (s, w)| sum + s.first.x + s.first.y + s.second.x + s.second.y + w);
    if !sum.is_finite() {
        return Err(EightPointError::NotFinite);
    }
    let first = Normalisation::of(plain.clone().map(|s| s.first), count);
    let second = Normalisation::of(plain.clone().map(|s| s.second), count);
    let (Some(first), Some(second)) = (first, second) else {
        // One point in one of the images: nothing is more on a line.
        let repeated = degenerate::distinct::<T, 8>(plain) < 8;
        return Err(if repeated { EightPointError::Repeated } else { EightPointError::Line });
    };
    let normalised = seen.map(|(s, weight)| (first.apply(s.first), second.apply(s.second), weight));

    // The row of a correspondence: f11 f12 f13 f21 ... of p^T F p', which are p's numbers times those of p'.
    let (f, pivot, suspicious, least) = if count == 8 {
        let mut rows = [[T::ONE; 9]; 8];
        for (row, (p, q, _)) in rows.iter_mut().zip(normalised) {
            *row = [p.x * q.x, p.x * q.y, p.x, p.y * q.x, p.y * q.y, p.y, q.x, q.y, T::ONE];
        }
        let (f, pivot) = null_of_rows(rows);
        (f, pivot, T::of(1e-4), T::EPSILON * T::of(64.0))
    } else {
        let ldl = Ldl::<T, 9>::new(normal_matrix(normalised));
        (
            ldl.null_vector(),
            ldl.relative_pivot(7),
            T::of(1e-8).max(T::EPSILON * T::of(32.0)),
            T::of(1e-14).max(T::EPSILON * T::of(4.0)),
        )
    };
    if !(pivot > suspicious) {
        if let Some(reason) = degenerate::reason(plain, count, &first, &second) {
            return Err(reason);
        }
        if !(pivot > least) {
            return Err(EightPointError::Undetermined);
        }
    }
    let singular = nearest_singular(&matrix3(&f));
    let f = second.after(&first.after(&singular.transpose()).transpose());
    Ok(Fundamental::of_singular(&f))
}

/// The sum of `w r r^T` over the rows r of all correspondences. r is p times p', so that of its 81 elements only six of
/// p p^T times six of p' p'^T differ.
#[allow(clippy::needless_range_loop, reason = "an element is named by its row and column")]
fn normal_matrix<T: Real>(seen: impl Iterator<Item = (nalgebra::Point2<T>, nalgebra::Point2<T>, T)>) -> [[T; 9]; 9] {
    let mut sums = [[T::ZERO; 6]; 6];
    for (p, q, w) in seen {
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
fn nearest_singular<T: Real>(f: &Matrix3<T>) -> Matrix3<T> {
    let squared: [[T; 3]; 3] = f.tr_mul(f).into();
    let v = Vector3::from(Ldl::<T, 3>::new(squared).null_vector());
    f - f * v * v.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_singular_matrix_drops_the_smallest_value() {
        let f = Matrix3::from_diagonal(&Vector3::new(3.0, 0.5, 2.0_f64));
        assert_eq!(nearest_singular(&f), Matrix3::from_diagonal(&Vector3::new(3.0, 0.0, 2.0)));
    }

    #[test]
    fn the_normal_matrix_is_the_rows_squared() {
        let (p, q) = (nalgebra::Point2::new(2.0, 3.0), nalgebra::Point2::new(5.0, 7.0_f64));
        let row = [10.0, 14.0, 2.0, 15.0, 21.0, 3.0, 5.0, 7.0, 1.0];
        let normal = normal_matrix([(p, q, 0.5)].into_iter());
        assert_eq!(normal, row.map(|a| row.map(|b| 0.5 * a * b)));
    }
}
