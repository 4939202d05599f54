//! A correspondence: one point of the world in two images.

use crate::geometry::Real;
use nalgebra::Point2;

/// Where one point of the world is in two images: p in the first, p' in the second, px.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Correspondence<T: Real> {
    /// The point p in the first (left) image: column, row.
    pub first: Point2<T>,
    /// The point p' in the second (right) image: column, row.
    pub second: Point2<T>,
}

impl<T: Real> Correspondence<T> {
    /// The point at column `u`, row `v` of the first image and at `u2`, `v2` of the second, px.
    pub const fn new(u: T, v: T, u2: T, v2: T) -> Self {
        Self { first: Point2::new(u, v), second: Point2::new(u2, v2) }
    }

    /// The correspondence with the images exchanged.
    pub fn swapped(&self) -> Self {
        Self { first: self.second, second: self.first }
    }

    /// Whether all four numbers are finite.
    pub fn is_finite(&self) -> bool {
        [self.first.x, self.first.y, self.second.x, self.second.y].iter().all(|x| x.is_finite())
    }
}
