//! Rectification without calibration, from a fundamental matrix and matches (Hartley 1999).

use crate::geometry::Real;
use crate::geometry::camera::ImageSize;
use crate::geometry::linear::Ldl;
use crate::geometry::two_view::{Correspondence, Fundamental, Homography, HomographyError};
use nalgebra::{Matrix3, Point2, RowVector3, Vector3};

/// Two homographies into images whose rows are aligned, for a pair of which nothing but F and some matches is
/// known.
///
/// The second image's sends its epipole e' to infinity along the rows (Hartley 1999): e' is rotated onto the
/// row through the image's middle, then `[1 0 0; 0 1 0; -1/e 0 1]`, which leaves the middle as it is. The
/// first image's follows but for its first row, because `p'^T F^T p = 0` must become `v' = v`: with `A =
/// H'^-T F^T` its second row is A's third and its third is less A's second. The first row is that which
/// brings matches nearest to their partners' columns; then it is moved so that no match has a disparity under
/// a pixel.
///
/// What comes out has no metric depth. Lenses are not in it: matches of undistorted pixels are meant.
///
/// ```
/// use stereopsis::geometry::camera::{Camera, ImageSize, Pose};
/// use stereopsis::geometry::rectify::UncalibratedRectification;
/// use stereopsis::geometry::two_view::{Correspondence, Fundamental};
/// use nalgebra::{Matrix3, Point3, Vector3};
/// let camera = Camera::new(300.0_f64, 300.0, 160.0, 120.0)?;
/// let pose = Pose::new(Matrix3::identity(), Vector3::new(0.1, 0.02, 0.0))?;
/// let f = Fundamental::from_cameras(&pose, &camera, &camera)?;
/// let seen: [_; 12] = core::array::from_fn(|i| {
///     let i = i as f64;
///     let there = Point3::new(0.3 * (i % 4.0) - 0.4, 0.25 * (i % 3.0) - 0.2, 2.0 + 0.2 * (i % 5.0));
///     let (first, second) = (camera.project(&there), camera.project(&pose.inverse_transform(&there)));
///     Correspondence { first: first.unwrap(), second: second.unwrap() }
/// });
/// let both = UncalibratedRectification::new(&f, &seen, ImageSize { width: 321, height: 241 })?;
/// for seen in &seen {
///     let (first, second) = (both.first(&seen.first).unwrap(), both.second(&seen.second).unwrap());
///     assert!((first.y - second.y).abs() < 1e-9 && first.x - second.x > 0.999);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct UncalibratedRectification<T: Real> {
    to_raw: [Homography<T>; 2],
}

/// Why a pair cannot be rectified without a calibration.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum UncalibratedError {
    /// Fewer matches than a first row has numbers, three.
    TooFew,
    /// A match is infinite or not a number.
    NotFinite,
    /// An epipole is in its image or near it, nearer to the middle than the image's diagonal: one camera
    /// stands before the other, and rows would be torn apart there.
    EpipoleInside,
    /// All matches are on a line.
    Line,
    /// One of the two maps is singular.
    Homography(HomographyError),
}

error_text!(UncalibratedError {
    Self::TooFew => "three matches at least are needed",
    Self::NotFinite => "a match is not finite",
    Self::EpipoleInside => "an epipole is in or near its image: one camera stands before the other",
    Self::Line => "all matches are on a line",
    Self::Homography(error) => "{error}",
});

impl<T: Real> UncalibratedRectification<T> {
    /// Rectifies images of `size` px by their fundamental matrix and matches that agree with it.
    pub fn new(
        f: &Fundamental<T>,
        seen: &[Correspondence<T>],
        size: ImageSize,
    ) -> Result<Self, UncalibratedError> {
        if seen.len() < 3 {
            return Err(UncalibratedError::TooFew);
        }
        if !seen.iter().all(Correspondence::is_finite) {
            return Err(UncalibratedError::NotFinite);
        }
        let half = T::of(0.5);
        let [cx, cy] =
            [size.width, size.height].map(|side| T::count(usize::from(side).saturating_sub(1)) * half);
        // Columns and rows from the middle, in halves of the diagonal: all numbers are of one size.
        let scale = (cx * cx + cy * cy).sqrt().max(T::ONE);
        let by = T::ONE / scale;
        let o = T::ZERO;
        let to_px = Matrix3::new(scale, o, cx, o, scale, cy, o, o, T::ONE);
        let from_px = Matrix3::new(by, o, -cx * by, o, by, -cy * by, o, o, T::ONE);
        let f = to_px.transpose() * f.matrix() * to_px;
        let f = Fundamental::from_matrix(&f).map_err(|_| UncalibratedError::EpipoleInside)?;
        let [first, second] = [f.epipole_in_first(), f.epipole_in_second()].map(|e| *e.homogeneous());
        // Twice half the diagonal.
        let is_far = |e: &Vector3<T>| e.xy().norm() > T::of(2.0) * e.z.abs();
        if !(is_far(&first) && is_far(&second)) {
            return Err(UncalibratedError::EpipoleInside);
        }
        let h2 = to_infinity(&second);
        let inverse = h2.try_inverse().ok_or(UncalibratedError::Homography(HomographyError::Singular))?;
        let a = inverse.transpose() * f.matrix().transpose();
        let (second_row, third_row) = (a.row(2).into_owned(), -a.row(1));
        let in_front = T::ONE.copysign(third_row[2]);
        let rest = [second_row * in_front, third_row * in_front];
        // Of one scale: the middle keeps its place in depth.
        let size_of = rest[1][2].abs().max(T::of(1e-6));
        let rest = rest.map(|row| row / size_of);
        let pairs = seen.iter().map(|seen| {
            let [p, q] = [seen.first, seen.second].map(|p| from_px * p.to_homogeneous());
            let image = h2 * q;
            (p, image.x / image.z)
        });
        let row = first_row(pairs.clone(), &rest[1])?;
        let least = pairs.map(|(p, column)| row.dot(&p.transpose()) / rest[1].dot(&p.transpose()) - column);
        let least = least.fold(T::of(1e9), |a, b| a.min(b));
        let row = row + rest[1] * (by - least);
        let h1 = Matrix3::from_rows(&[row, rest[0], rest[1]]);
        let homography = |h: Matrix3<T>| {
            // `p ~ H p'` where p is raw and p' rectified.
            let inverse = Homography::from_matrix(&(to_px * h * from_px)).map(|h| h.inverse());
            inverse.map_err(UncalibratedError::Homography)
        };
        Ok(Self { to_raw: [homography(h1)?, homography(h2)?] })
    }

    /// From a rectified pixel to a raw one (`p_raw ~ H p`), of the first and of the second image.
    pub fn to_raw(&self) -> &[Homography<T>; 2] {
        &self.to_raw
    }

    /// Where a pixel of the first image is in its rectified one; `None` at infinity.
    pub fn first(&self, raw: &Point2<T>) -> Option<Point2<T>> {
        self.to_raw[0].to_second(raw)
    }

    /// Where a pixel of the second image is in its rectified one; `None` at infinity.
    pub fn second(&self, raw: &Point2<T>) -> Option<Point2<T>> {
        self.to_raw[1].to_second(raw)
    }
}

/// The epipole rotated onto the X axis by the smaller of the two angles, and from there to infinity.
fn to_infinity<T: Real>(e: &Vector3<T>) -> Matrix3<T> {
    let along = e.xy().norm();
    let (c, s) = (e.x / along, e.y / along);
    let sign = T::ONE.copysign(c);
    let (c, s) = (c * sign, s * sign);
    let (o, l) = (T::ZERO, T::ONE);
    let rotation = Matrix3::new(c, s, o, -s, c, o, o, o, l);
    // `-1 / e` with e = sign along / z.
    let tilt = -e.z / (along * sign);
    Matrix3::new(l, o, o, o, l, o, tilt, o, l) * rotation
}

/// The row h with the least `sum (h p / w - column)^2`, where `w = third p`.
fn first_row<T: Real>(
    pairs: impl Iterator<Item = (Vector3<T>, T)>,
    third: &RowVector3<T>,
) -> Result<RowVector3<T>, UncalibratedError> {
    let (mut matrix, mut vector) = ([[T::ZERO; 3]; 3], [T::ZERO; 3]);
    for (p, column) in pairs {
        let p = p / third.dot(&p.transpose());
        for ((row, to), x) in matrix.iter_mut().zip(&mut vector).zip(p.iter()) {
            *to += *x * column;
            row.iter_mut().zip(p.iter()).for_each(|(to, y)| *to += *x * *y);
        }
    }
    let factors = Ldl::new(&mut matrix);
    let [most, _, least] = *factors.pivots();
    // Also what is not a number.
    if !(least > most * T::EPSILON * T::of(64.0)) {
        return Err(UncalibratedError::Line);
    }
    Ok(RowVector3::from(factors.solve(&vector)))
}
