//! Configuration of a detector of features in C, and what became of its corners.
#![allow(unsafe_code)]

use super::Status;
use super::state::checked;
use super::status::either;
use crate::features::{FeatureConfig, FeatureConfigError, Level, Orientation};

/// How the features of a picture are found, filled by `stereopsis_detection_default` and then open to
/// changes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CDetection {
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
    /// Side of the square cells over which corners are spread, px: 16 at least.
    pub cell_px: u16,
    /// How many corners are kept in a cell, the strongest first: 1 at least. A detector needs as many slots
    /// as are kept in a row of cells.
    pub per_cell: u16,
    /// A corner differs from its circle by more than so many grey levels.
    pub threshold: u8,
    /// Whether descriptors turn with the picture, for any turn of the camera, with fewer matches; 0 means no.
    pub turned: u8,
}

/// What became of a picture's corners.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CDetectionCounts {
    /// Corners that were found.
    pub corners: u32,
    /// Corners dropped because stronger ones of their cell took its slots.
    pub crowded_out: u32,
    /// Features dropped because the caller's list was full.
    pub dropped: u32,
}

impl From<CDetection> for FeatureConfig {
    fn from(config: CDetection) -> Self {
        Self {
            width: config.width,
            height: config.height,
            threshold: config.threshold,
            cell_px: config.cell_px,
            per_cell: config.per_cell,
            orientation: if config.turned == 0 { Orientation::Upright } else { Orientation::Centroid },
            level: Level::FULL,
        }
    }
}

impl From<FeatureConfigError> for Status {
    fn from(e: FeatureConfigError) -> Self {
        match e {
            FeatureConfigError::Width { .. } => Self::DetectorWidth,
            FeatureConfigError::Cells => Self::DetectorCells,
            FeatureConfigError::Slots { .. } => Self::DetectorSlots,
        }
    }
}

/// Fills a configuration, as `stereopsis_detection_default`.
///
/// # Safety
///
/// `config` is null or points to a configuration's bytes.
pub unsafe fn detection_default(width: u16, height: u16, config: *mut CDetection) -> Status {
    either(checked(config).map(|()| {
        let FeatureConfig { width, height, threshold, cell_px, per_cell, .. } =
            FeatureConfig::new(width, height);
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { config.write(CDetection { width, height, cell_px, per_cell, threshold, turned: 0 }) };
        Status::Ok
    }))
}
