//! Why there are no features or no matches.

use super::FeatureConfig;
use core::fmt;

/// Why features cannot be looked for like that.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FeatureConfigError {
    /// Lines are longer than the detector's capacity.
    Width {
        /// Capacity, px.
        most: usize,
    },
    /// Cells are smaller than [`FeatureConfig::LEAST_CELL`], or none is to be kept in them.
    Cells,
    /// More corners are to be kept than the detector has slots for.
    Slots {
        /// How many would have been enough.
        needed: usize,
    },
}

impl fmt::Display for FeatureConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Width { most } => write!(f, "lines have more than {most} pixels"),
            Self::Cells => {
                write!(f, "cells are smaller than {} px or hold no corner", FeatureConfig::LEAST_CELL)
            }
            Self::Slots { needed } => write!(f, "a row of cells needs {needed} slots"),
        }
    }
}

impl core::error::Error for FeatureConfigError {}

/// Why a line was not taken.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FeatureLineError {
    /// The detector was not started, or all lines of the frame have come.
    NoLineDue,
    /// The line has another length than the configuration says.
    Length {
        /// What was due, px.
        needed: usize,
    },
}

impl fmt::Display for FeatureLineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLineDue => write!(f, "no line is due: start a frame"),
            Self::Length { needed } => write!(f, "a line of {needed} pixels is due"),
        }
    }
}

impl core::error::Error for FeatureLineError {}

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

impl fmt::Display for MatchConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ratio => write!(f, "the ratio is not 1 to 100 percent"),
            Self::Range => write!(f, "a distance is negative or no number"),
            Self::Epipolar => write!(f, "the distance from the epipolar line is negative or no number"),
            Self::TooMany { needed } => write!(f, "the matcher would have to hold {needed} features"),
        }
    }
}

impl core::error::Error for MatchConfigError {}
