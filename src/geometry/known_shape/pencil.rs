//! Line segments that converge, and their vanishing point by least squares.

use crate::geometry::Real;
use crate::geometry::linear::Ldl;
use nalgebra::{Point2, Vector3};

/// A piece of a straight line in the image: its ends, undistorted px
/// ([`Camera::undistort`](crate::geometry::camera::Camera::undistort)).
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LineSegment<T: Real> {
    /// One end of the segment.
    pub from: Point2<T>,
    /// The other end of the segment.
    pub to: Point2<T>,
}

/// A segment in coordinates that are small numbers: its middle, and half of the way from end to end.
#[derive(Clone, Copy)]
pub(super) struct Scaled<T: Real> {
    middle: Vector3<T>,
    half: Vector3<T>,
}

/// Why lines have no vanishing point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum VanishingPointError {
    /// A number is infinite or not a number, or one of the vanishing point would be.
    NotFinite,
    /// Fewer than two segments.
    TooFew,
    /// All segments are on one line, or of no length.
    Line,
}

error_text!(VanishingPointError {
    Self::NotFinite => "a number is not finite",
    Self::TooFew => "a vanishing point needs two segments",
    Self::Line => "all segments are on one line",
});

/// How often a vanishing point's weights are found anew.
const ROUNDS: usize = 6;

impl<T: Real> LineSegment<T> {
    /// The segment between two places (column, row), undistorted px.
    pub fn new(from: (T, T), to: (T, T)) -> Self {
        Self { from: Point2::new(from.0, from.1), to: Point2::new(to.0, to.1) }
    }

    pub(super) fn is_finite(&self) -> bool {
        [self.from.x, self.from.y, self.to.x, self.to.y].iter().all(|x| x.is_finite())
    }

    /// In units of `scale` px from `centre`.
    pub(super) fn scaled(&self, centre: &Point2<T>, scale: T) -> Scaled<T> {
        let (from, to) = ((self.from - centre) / scale, (self.to - centre) / scale);
        let (middle, half) = ((from + to) * T::of(0.5), (to - from) * T::of(0.5));
        Scaled { middle: middle.push(T::ONE), half: half.push(T::ZERO) }
    }
}

impl<T: Real> Scaled<T> {
    /// The vector g for which `g . v` is the distance of an end from the line through the middle and `v`:
    /// `half x middle` over the length of that line's normal, held fixed while `v` moves little. Zero where
    /// that line is undetermined.
    pub(super) fn gradient(&self, v: &Vector3<T>) -> Vector3<T> {
        let size = self.middle.cross(v).xy().norm();
        if size > T::ZERO { self.half.cross(&self.middle) / size } else { Vector3::zeros() }
    }
}

/// The point, homogeneous and of length one, from whose lines the ends of two segments or more are least
/// away, and the sum of the squared distances.
///
/// Least squares with weights that are found anew from each point, six times.
pub(super) fn vanishing_point<T: Real>(
    segments: impl Iterator<Item = Scaled<T>> + Clone,
) -> Result<(Vector3<T>, T), VanishingPointError> {
    let (count, finite) = segments.clone().fold((0, true), |(count, finite), segment| {
        (count + 1, finite && segment.middle.iter().chain(&segment.half).all(|x| x.is_finite()))
    });
    if !finite {
        return Err(VanishingPointError::NotFinite);
    }
    if count < 2 {
        return Err(VanishingPointError::TooFew);
    }
    let mut point = None;
    for _ in 0..ROUNDS {
        let mut matrix = [[T::ZERO; 3]; 3];
        for segment in segments.clone() {
            let line = match &point {
                Some(v) => segment.gradient(v),
                None => segment.half.cross(&segment.middle),
            };
            for (row, &a) in matrix.iter_mut().zip(line.iter()) {
                for (element, &b) in row.iter_mut().zip(line.iter()) {
                    *element += a * b;
                }
            }
        }
        let ldl = Ldl::new(&mut matrix);
        let [largest, second, _] = *ldl.pivots();
        if !(second > largest * T::EPSILON * T::of(64.0)) {
            return Err(VanishingPointError::Line);
        }
        point = Some(Vector3::from(ldl.null_vector()));
    }
    let v = point.unwrap_or_else(Vector3::zeros);
    let squares = segments.fold(T::ZERO, |sum, segment| {
        let distance = segment.gradient(&v).dot(&v);
        sum + distance * distance
    });
    Ok((v, squares))
}
