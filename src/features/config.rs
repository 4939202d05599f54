//! Configuration of the feature detector.

use super::Level;

/// What corners are described by.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Orientation {
    /// The patch as it stands: the most distinctive, for rotations of up to about 15 degrees. For cameras
    /// that are mounted alike.
    #[default]
    Upright,
    /// The patch turned so that its bright side, seen from the middle, lies to the right: for any turn of the
    /// camera, with fewer matches (ORB; Rublee, Rabaud, Konolige & Bradski, ICCV 2011).
    Centroid,
}

/// How a picture's features are found.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FeatureConfig {
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
    /// A corner differs from its circle by more than so many grey levels.
    pub threshold: u8,
    /// Side of the square cells over which corners are spread, px: [`Self::LEAST_CELL`] at least.
    pub cell_px: u16,
    /// How many corners are kept in a cell, the strongest first: 1 at least.
    pub per_cell: u16,
    /// How they are described.
    pub orientation: Orientation,
    /// Level of the picture in its pyramid.
    pub level: Level,
}

impl FeatureConfig {
    /// Corners keep so far from the picture's edge, px: the patch and its smoothing. A feature's place
    /// between pixels may be up to 1.75 px nearer to it.
    pub const MARGIN: u16 = 17;
    /// The least side of a cell, px: at most two rows of cells have corners that wait for their patch.
    pub const LEAST_CELL: u16 = 16;

    /// Five corners of over 12 grey levels in every 32 x 32 px of a full picture, upright.
    pub const fn new(width: u16, height: u16) -> Self {
        let (orientation, level) = (Orientation::Upright, Level::FULL);
        Self { width, height, threshold: 12, cell_px: 32, per_cell: 5, orientation, level }
    }

    /// No picture. All zeros: a detector in a `static` that waits takes RAM and no flash.
    pub(super) const NONE: Self = Self {
        width: 0,
        height: 0,
        threshold: 0,
        cell_px: 0,
        per_cell: 0,
        orientation: Orientation::Upright,
        level: Level::NONE,
    };

    /// How many slots a detector needs for this: a row of cells with as many as are kept in each.
    pub const fn slots(&self) -> usize {
        if self.cell_px == 0 {
            0
        } else {
            self.width.div_ceil(self.cell_px) as usize * self.per_cell as usize
        }
    }

    /// Whether a detector with this capacity can do it.
    pub(super) fn check(&self, widest: usize, slots: usize) -> Result<(), FeatureConfigError> {
        let needed = self.slots();
        if usize::from(self.width) > widest {
            return Err(FeatureConfigError::Width { most: widest });
        }
        if self.cell_px < Self::LEAST_CELL || self.per_cell == 0 {
            return Err(FeatureConfigError::Cells);
        }
        if needed > slots {
            return Err(FeatureConfigError::Slots { needed });
        }
        Ok(())
    }
}

/// Why features cannot be looked for like that.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FeatureConfigError {
    /// Lines are longer than the detector's capacity.
    Width {
        /// The capacity of the detector, px.
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

error_text!(FeatureConfigError {
    Self::Width { most } => "lines have more than {most} pixels",
    Self::Cells => "cells are smaller than {} px or hold no corner" (FeatureConfig::LEAST_CELL),
    Self::Slots { needed } => "a row of cells needs {needed} slots",
});
