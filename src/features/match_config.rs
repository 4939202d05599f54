//! Configuration of matching: ratio test, search range and epipolar constraint.

use super::Feature;
use crate::geometry::two_view::{Fundamental, Line};
use nalgebra::Point2;

/// Lines on which partners lie, when it is known how the cameras stand to each other.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Epipolar {
    /// F with `p^T F p' = 0`: p in the left picture, p' in the right one.
    pub fundamental: Fundamental<f32>,
    /// How far from its line `l' = F^T p` a partner may lie, px. Of a point at the epipole, which has no
    /// line, partners may lie everywhere.
    pub tolerance_px: f32,
}

/// What a match has to be.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MatchConfig {
    /// A match has fewer different bits than so many percent of the second best partner (Lowe 2004, 7.1): 1
    /// to 100.
    pub ratio_percent: u8,
    /// The second best partner is one that lies at least so far from the best, px along the row or the
    /// column: the same corner found once more, on another level, is no other one.
    pub apart_px: f32,
    /// Largest Hamming distance accepted between two descriptors.
    pub most_different: u16,
    /// Largest difference of pyramid level between partners.
    pub levels_apart: u8,
    /// How far partners may lie apart along the row, px.
    pub along_px: f32,
    /// How far partners may lie apart across the rows, px.
    pub across_px: f32,
    /// The lines on which they lie, if they are known.
    pub epipolar: Option<Epipolar>,
}

impl MatchConfig {
    /// 80 % of the second best, which lies 4 px from the best; at most a quarter of the bits different; one
    /// level apart at most; everywhere in the picture.
    pub const fn new() -> Self {
        Self {
            ratio_percent: 80,
            apart_px: 4.0,
            most_different: 64,
            levels_apart: 1,
            along_px: f32::INFINITY,
            across_px: f32::INFINITY,
            epipolar: None,
        }
    }

    /// Whether the numbers make sense.
    pub(super) fn check(&self) -> Result<(), MatchConfigError> {
        if !(1..=100).contains(&self.ratio_percent) {
            return Err(MatchConfigError::Ratio);
        }
        // Not a number compares as false.
        if !(self.along_px >= 0.0 && self.across_px >= 0.0 && self.apart_px >= 0.0) {
            return Err(MatchConfigError::Range);
        }
        match &self.epipolar {
            Some(e) if e.tolerance_px.is_nan() || e.tolerance_px < 0.0 => Err(MatchConfigError::Epipolar),
            _ => Ok(()),
        }
    }

    /// The places where partners of one left feature may be.
    pub(super) fn around(&self, left: &Feature) -> Places {
        let band = self.epipolar.and_then(|e| {
            let line = e.fundamental.line_in_second(&Point2::new(left.x_px, left.y_px))?;
            Some((line, e.tolerance_px))
        });
        Places { x_px: left.x_px, y_px: left.y_px, level: left.level, band }
    }

    /// Whether a right feature lies there.
    pub(super) fn admits(&self, places: &Places, right: &Feature) -> bool {
        let on_line = |(line, most): &(Line<f32>, f32)| {
            line.distance_px(&Point2::new(right.x_px, right.y_px)).abs() <= *most
        };
        places.level.abs_diff(right.level) <= self.levels_apart
            && (places.x_px - right.x_px).abs() <= self.along_px
            && (places.y_px - right.y_px).abs() <= self.across_px
            && places.band.as_ref().is_none_or(on_line)
    }
}

impl Default for MatchConfig {
    fn default() -> Self {
        Self::new()
    }
}

/// Why there are no matches.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum MatchConfigError {
    /// The ratio is not 1 to 100 percent.
    Ratio,
    /// A distance is negative or not a number.
    Range,
    /// The distance from the epipolar line is negative or not a number.
    Epipolar,
    /// A picture has more features than the matcher holds.
    TooMany {
        /// How many it would have to hold.
        needed: usize,
    },
}

error_text!(MatchConfigError {
    Self::Ratio => "the ratio is not 1 to 100 percent",
    Self::Range => "a distance is negative or no number",
    Self::Epipolar => "the distance from the epipolar line is negative or no number",
    Self::TooMany { needed } => "the matcher would have to hold {needed} features",
});

/// Where the partners of one feature may be.
pub(super) struct Places {
    x_px: f32,
    y_px: f32,
    level: u8,
    /// The line, and how far from it.
    band: Option<(Line<f32>, f32)>,
}
