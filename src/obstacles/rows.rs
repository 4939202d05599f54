//! Rows of pixels -> rows of cells, and what the watchdog counts of them.

use super::column::Column;
use super::finder::ObstaclesView;
use super::grid::{Filling, fill};
use super::setup::Setup;
use super::watchdog::Watchdog;
use crate::imaging::PairMonitor;
use crate::units::{Disparity, PixelFlags};

impl ObstaclesView<'_> {
    /// Begins a frame. The one before is forgotten: until this one is finished, nothing can be decided.
    pub fn begin(&mut self) {
        self.state.watchdog = Watchdog::NEW;
        self.state.sky = self.setup().map_or(0, |setup| setup.sky(self.state.carried.ground));
        (self.state.next, self.state.is_finished) = (0, false);
        self.filling.fill(Filling::EMPTY);
        self.cells.fill(Disparity::NONE);
        self.columns.fill(Column::EMPTY);
    }

    /// Takes what the monitor of the cameras says of this frame, before it is finished.
    pub fn cameras(&mut self, monitor: &PairMonitor) {
        self.state.watchdog.cameras(monitor);
    }

    /// Takes row `y` of pixels, with its confidences or none. A row that has been, and one of which anything
    /// is too short, is ignored; rows that are left out count as lost.
    pub fn push(&mut self, y: usize, disparities: &[Disparity], flags: &[PixelFlags], confidences: &[u8]) {
        let Some(setup) = self.setup() else { return };
        let pixels = setup.columns * usize::from(setup.config.cell_width);
        let is_short = disparities.len().min(flags.len()) < pixels
            || !confidences.is_empty() && confidences.len() < pixels;
        if y < self.state.next || y >= setup.height || is_short {
            return;
        }
        self.pass(&setup, y);
        let cells = self.filling.get_mut(..setup.columns).unwrap_or_default();
        let width = usize::from(setup.config.cell_width);
        let least = setup.config.least_confidence(y < self.state.sky.into());
        let all = fill(cells, width, disparities, flags, confidences, least);
        self.state.watchdog.row(all);
        self.state.next = y + 1;
        if self.state.next.is_multiple_of(usize::from(setup.config.cell_height.max(1))) {
            self.close(&setup, y);
        }
    }

    /// Counts the rows before `y` that did not come, and closes the rows of cells that end above it.
    pub(super) fn pass(&mut self, setup: &Setup, y: usize) {
        let missing = y.saturating_sub(self.state.next);
        self.state.watchdog.lost += missing as u32;
        let height = usize::from(setup.config.cell_height.max(1));
        let crossed = y.checked_div(height) != self.state.next.checked_div(height);
        if missing > 0 && crossed {
            self.close(setup, self.state.next);
        }
        self.state.next = y;
    }

    /// Ends the row of cells that row `y` of pixels is in.
    fn close(&mut self, setup: &Setup, y: usize) {
        let config = &setup.config;
        let row = y.checked_div(usize::from(config.cell_height)).unwrap_or(usize::MAX);
        let most = config.cell_width.div_ceil(3).wrapping_mul(config.cell_height);
        let cells = self.cells.chunks_exact_mut(setup.columns.max(1)).nth(row).unwrap_or_default();
        if row >= setup.rows {
            return;
        }
        for (cell, filling) in cells.iter_mut().zip(self.filling.iter_mut()) {
            *cell = filling.answer(most);
            self.state.watchdog.answered += u32::from(cell.is_some());
            *filling = Filling::EMPTY;
        }
    }
}
