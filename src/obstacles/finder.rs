//! Rows of a frame in, its ground, stixels and sectors out.

use super::column::Column;
use super::config::{GroundSource, ObstacleConfig, ObstacleError};
use super::grid::Filling;
use super::ground::{CarriedGround, Ground};
use super::interval::Interval;
use super::ransac::fit;
use super::setup::Setup;
use super::state::ObstaclesState;
use super::stixel::Labelling;
use super::surfaces::stixels;
use super::watchdog::BlindReason;
use crate::depth::DepthScale;
use crate::units::{Disparity, PixelFlags};

/// Obstacles of frames of up to `C` columns and `R` rows of cells, in fixed memory: about `2 C R + 30 C + 17
/// R` bytes.
///
/// Rows go in as they leave the matcher; after the last one, [`Self::finish`] makes the frame's ground,
/// stixels and sectors. All of it is integer arithmetic, the same on every core.
#[derive(Debug)]
pub struct Obstacles<const C: usize, const R: usize> {
    cells: [[Disparity; C]; R],
    filling: [Filling; C],
    intervals: [Interval; R],
    columns: [Column; C],
    labels: [u8; R],
    bearings: [i16; C],
    state: ObstaclesState,
}

/// A borrowed [`Obstacles`] of any size.
#[derive(Debug)]
pub struct ObstaclesView<'a> {
    pub(super) cells: &'a mut [Disparity],
    pub(super) filling: &'a mut [Filling],
    pub(super) intervals: &'a mut [Interval],
    pub(super) columns: &'a mut [Column],
    pub(super) labels: &'a mut [u8],
    pub(super) bearings: &'a mut [i16],
    pub(super) state: &'a mut ObstaclesState,
}

impl<const C: usize, const R: usize> Obstacles<C, R> {
    /// Creates a finder that has to be started.
    pub const fn new() -> Self {
        const { assert!(C > 0 && R > 0 && R < 256, "1 to 255 rows of cells, and a column") };
        Self {
            cells: [[Disparity::ZERO; C]; R],
            filling: [Filling::EMPTY; C],
            intervals: [Interval::ZERO; R],
            columns: [Column::EMPTY; C],
            labels: [0; R],
            bearings: [0; C],
            state: ObstaclesState::new(),
        }
    }

    /// The finder without its capacities.
    pub fn as_mut_view(&mut self) -> ObstaclesView<'_> {
        ObstaclesView {
            cells: self.cells.as_flattened_mut(),
            filling: &mut self.filling,
            intervals: &mut self.intervals,
            columns: &mut self.columns,
            labels: &mut self.labels,
            bearings: &mut self.bearings,
            state: &mut self.state,
        }
    }

    /// Starts on frames of a size, see [`ObstaclesView::start`].
    pub fn start(
        &mut self,
        config: &ObstacleConfig,
        scale: &DepthScale,
        size: [u16; 2],
        largest: Disparity,
    ) -> Result<(), ObstacleError> {
        self.as_mut_view().start(config, scale, size, largest)
    }

    /// Begins a frame, see [`ObstaclesView::begin`].
    pub fn begin(&mut self) {
        self.as_mut_view().begin();
    }

    /// Takes a row, see [`ObstaclesView::push`].
    pub fn push(&mut self, y: usize, disparities: &[Disparity], flags: &[PixelFlags], confidences: &[u8]) {
        self.as_mut_view().push(y, disparities, flags, confidences);
    }

    /// Ends a frame, see [`ObstaclesView::finish`].
    pub fn finish(&mut self) -> Result<(), BlindReason> {
        self.as_mut_view().finish()
    }
}

impl<const C: usize, const R: usize> Default for Obstacles<C, R> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'a> ObstaclesView<'a> {
    /// A finder in the caller's memory: `filling`, `columns` and `bearings` have one of each for every
    /// column of cells, `intervals` and `labels` have one for every row of cells, `cells` holds
    /// all cells of a frame. It does not matter what is in them before [`Self::start`], which names what is
    /// too short; later views need what the last one left, and one that has less is as if not started.
    pub fn new(
        state: &'a mut ObstaclesState,
        cells: &'a mut [Disparity],
        filling: &'a mut [Filling],
        intervals: &'a mut [Interval],
        columns: &'a mut [Column],
        labels: &'a mut [u8],
        bearings: &'a mut [i16],
    ) -> Self {
        Self { cells, filling, intervals, columns, labels, bearings, state }
    }
}

impl ObstaclesView<'_> {
    /// Starts on frames of `size` (width and height, px) from a rig, with disparities of up to `largest`;
    /// what was carried is forgotten. Columns and rows of pixels that fill no cell are left out.
    pub fn start(
        &mut self,
        config: &ObstacleConfig,
        scale: &DepthScale,
        size: [u16; 2],
        largest: Disparity,
    ) -> Result<(), ObstacleError> {
        self.state.setup = Setup::NOT_STARTED;
        self.state.is_finished = false;
        let setup = self.settled(config, scale, size, largest)?;
        let half = f32::from(config.cell_width - 1) / 2.0;
        for (x, to) in self.bearings.iter_mut().enumerate() {
            *to = setup.rig.bearing_mrad((x * usize::from(config.cell_width)) as f32 + half);
        }
        self.state.carried = CarriedGround::NONE;
        self.state.setup = setup;
        self.begin();
        Ok(())
    }

    /// Says why [`Self::start`] would be refused, and changes nothing.
    pub fn check(
        &self,
        config: &ObstacleConfig,
        scale: &DepthScale,
        size: [u16; 2],
        largest: Disparity,
    ) -> Result<(), ObstacleError> {
        self.settled(config, scale, size, largest).map(|_| ())
    }

    /// What a start settles, if this memory is enough for it.
    fn settled(
        &self,
        config: &ObstacleConfig,
        scale: &DepthScale,
        size: [u16; 2],
        largest: Disparity,
    ) -> Result<Setup, ObstacleError> {
        let setup = Setup::new(config, scale, size, largest)?;
        self.check_memory(&setup)?;
        Ok(setup)
    }

    /// Whether this memory is enough for what a start settled.
    fn check_memory(&self, setup: &Setup) -> Result<(), ObstacleError> {
        let most_columns = self.columns.len().min(self.filling.len()).min(self.bearings.len());
        let most_rows = self.labels.len().min(self.intervals.len()).min(255);
        if setup.columns > most_columns {
            return Err(ObstacleError::Columns { needed: setup.columns });
        }
        if setup.rows > most_rows || setup.rows * setup.columns > self.cells.len() {
            return Err(ObstacleError::Rows { needed: setup.rows });
        }
        Ok(())
    }

    /// Sets the pose of the camera from this frame on, as [`GroundSource::Given`] has it.
    pub fn set_pose(&mut self, pitch_mrad: i16, roll_mrad: i16, height_mm: u16) -> Result<(), ObstacleError> {
        let setup = self.setup().ok_or(ObstacleError::NotStarted)?;
        let ground = GroundSource::Given { pitch_mrad, roll_mrad, height_mm };
        let config = ObstacleConfig { ground, ..setup.config };
        config.check()?;
        self.state.setup.config = config;
        Ok(())
    }

    /// Ends a frame: finds its ground, stixels and surfaces, and says if the frame is to be trusted. The
    /// ground is carried over frames that are not.
    pub fn finish(&mut self) -> Result<(), BlindReason> {
        let Some(setup) = self.setup() else { return Err(BlindReason::NoFrame) };
        self.pass(&setup, setup.height);
        let (config, rig) = (&setup.config, &setup.rig);
        let [rows, cells] = [setup.height, setup.columns * setup.rows].map(|count| count as u32);
        self.state.blind = self.state.watchdog.judge(config, rows, cells);
        let cells = setup.cells(self.cells);
        let measured = match config.ground {
            GroundSource::Absent => None,
            GroundSource::Given { pitch_mrad, roll_mrad, height_mm } => {
                self.state.carried = CarriedGround::NONE;
                Ground::given(pitch_mrad, roll_mrad, height_mm, rig)
            }
            GroundSource::Searched { .. } if self.state.blind.is_none() => {
                fit(&cells, self.state.carried.ground, config, rig)
            }
            GroundSource::Searched { .. } => None,
        };
        self.state.carried.update(measured, cells.corners(), rig);
        let labelling =
            Labelling::new(cells, self.state.carried.ground, *config, self.intervals, setup.narrow);
        let columns = self.columns.get_mut(..setup.columns).unwrap_or_default();
        stixels(&labelling, columns, self.labels.get_mut(..setup.rows).unwrap_or_default());
        self.state.is_finished = true;
        self.state.blind.map_or(Ok(()), Err)
    }

    /// What the start settled, if there was one and this memory is enough for it.
    pub(super) fn setup(&self) -> Option<Setup> {
        let setup = &self.state.setup;
        (setup.columns > 0 && self.check_memory(setup).is_ok()).then_some(*setup)
    }

    /// Why the last frame is not to be trusted, if it is not. From the begin of a frame to its end there is
    /// none: [`BlindReason::NoFrame`].
    pub fn blind(&self) -> Option<BlindReason> {
        let is_finished = self.state.is_finished && self.setup().is_some();
        if is_finished { self.state.blind } else { Some(BlindReason::NoFrame) }
    }

    /// The disparity of a cell of the frame that was finished last, until the next one begins; none of a cell
    /// that is not there.
    pub fn cell(&self, column: usize, row: usize) -> Disparity {
        let Some(setup) = self.setup().filter(|_| self.state.is_finished) else { return Disparity::NONE };
        let is_inside = column < setup.columns && row < setup.rows;
        let cell = is_inside.then(|| self.cells.get(row * setup.columns + column)).flatten();
        cell.copied().unwrap_or(Disparity::NONE)
    }
}
