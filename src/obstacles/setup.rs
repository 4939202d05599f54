//! What a start settles: limits, a rig in integers, and the number of cells.

use super::cells::Cells;
use super::config::{GroundSource, ObstacleConfig, ObstacleError};
use super::ground::{Ground, RigNumbers};
use crate::depth::DepthScale;
use crate::units::Disparity;

/// What a start settles. Before it, all is zero, as is all of a new finder.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setup {
    pub(super) config: ObstacleConfig,
    /// `f b`, millimetres times steps of disparity.
    pub(super) millimetre_steps: u32,
    /// `doffs`, steps of disparity.
    pub(super) offset_steps: i32,
    pub(super) rig: RigNumbers,
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) height: usize,
    pub(super) largest: Disparity,
    /// Columns of cells that end within the largest disparity from the left edge: fewer can be searched
    /// there.
    pub(super) narrow: u16,
    /// Bearings of the first and the last column of pixels, thousandths of a radian.
    pub(super) ends_mrad: [i16; 2],
}

impl Setup {
    pub(super) const NOT_STARTED: Self = Self {
        config: ObstacleConfig::ZERO,
        millimetre_steps: 0,
        offset_steps: 0,
        rig: RigNumbers::ZERO,
        columns: 0,
        rows: 0,
        height: 0,
        largest: Disparity::ZERO,
        narrow: 0,
        ends_mrad: [0; 2],
    };

    /// Settles all of it for frames of `size`, with at least one column and one row of cells.
    pub(super) fn new(
        config: &ObstacleConfig,
        scale: &DepthScale,
        size: [u16; 2],
        largest: Disparity,
    ) -> Result<Self, ObstacleError> {
        config.check()?;
        let [width, height] = size.map(usize::from);
        let part = |side: usize, cell: u8| side.checked_div(usize::from(cell)).unwrap_or(0);
        let (columns, rows) = (part(width, config.cell_width), part(height, config.cell_height));
        if columns == 0 {
            return Err(ObstacleError::Columns { needed: 1 });
        }
        if rows == 0 {
            return Err(ObstacleError::Rows { needed: 1 });
        }
        let rig = RigNumbers::new(scale);
        let last = (columns * usize::from(config.cell_width) - 1) as f32;
        Ok(Self {
            config: *config,
            millimetre_steps: scale.millimetre_steps(),
            offset_steps: scale.offset_steps(),
            rig,
            columns,
            rows,
            height,
            largest,
            narrow: (largest.raw() / Disparity::ONE).checked_div(config.cell_width.into()).unwrap_or(0),
            ends_mrad: [rig.bearing_mrad(0.0), rig.bearing_mrad(last)],
        })
    }

    /// Rows of pixels above the horizon: those in which no column sees the ground, or half of those above the
    /// principal point where none is known.
    pub(super) fn sky(&self, ground: Option<Ground>) -> u16 {
        let ends = [0, self.columns.saturating_sub(1)].map(|x| self.cells(&[]).right_16ths(x));
        match ground {
            _ if self.config.ground == GroundSource::Absent => 0,
            Some(ground) => ground.rows_above(ends),
            None => u16::try_from(self.rig.cy_halves.div_euclid(4)).unwrap_or(0),
        }
    }

    /// The cells of a frame, with the numbers that their geometry needs.
    pub(super) fn cells<'a>(&self, cells: &'a [Disparity]) -> Cells<'a> {
        Cells {
            cells,
            columns: self.columns,
            rows: self.rows,
            cell_height: self.config.cell_height.into(),
            cell_width: self.config.cell_width.into(),
            cx_16ths: self.rig.cx_16ths.into(),
            offset: self.offset_steps,
            farthest: i32::from(ObstacleConfig::FARTHEST_SIGMAS * self.config.sigma_steps),
        }
    }
}
