//! Shape from focus without capacities: the way of a line through smoothing, measure, windows and cells.

use super::box_filter::BoxFilter;
use super::map_state::FocusMapState;
use super::peak::BIAS;
use super::{
    AllInFocusRow, Breathing, FocusCell, FocusConfig, FocusConfigError, FocusLineError, FocusPeak, NoFocus,
    binomial, modified_laplacian,
};
use crate::imaging::RowRing;

/// Lines, rows of smoothed pixels, and rows of their measure that are kept; numbers for a cell of a row.
pub(super) const LINES: usize = 3;
const SMOOTH: usize = 3;
const MEASURED: usize = 2;
pub(super) const ROWS: usize = SMOOTH + MEASURED;
pub(super) const SUMS: usize = 1 + 2 * BoxFilter::ROWS;

/// A borrowed [`FocusMap`](super::FocusMap) of any size.
#[derive(Debug)]
pub struct FocusMapView<'a> {
    pub(super) state: &'a mut FocusMapState,
    pub(super) lines: &'a mut [u8],
    /// Three smoothed rows, and two of the measure.
    pub(super) rows: &'a mut [u16],
    /// The sums of a row of cells, and two box filters.
    pub(super) sums: &'a mut [u32],
    pub(super) sharper: &'a mut [bool],
    pub(super) cells: &'a mut [FocusCell],
}

impl<'a> FocusMapView<'a> {
    /// Bytes of `lines` for every pixel of the longest line.
    pub const LINES: usize = LINES;
    /// Numbers of `rows` for every pixel of the longest line.
    pub const ROWS: usize = ROWS;
    /// Numbers of `sums` for every cell of a row.
    pub const SUMS: usize = SUMS;

    /// A map in the caller's memory: `lines`, `rows` and `sums` are as long as the constants say, `sharper`
    /// has a flag for every cell of a row, `cells` holds all cells of a frame. It does not matter what is in
    /// them before [`Self::start`]; a view of a stack under way needs as much, with what the last one left.
    pub fn new(
        state: &'a mut FocusMapState,
        lines: &'a mut [u8],
        rows: &'a mut [u16],
        sums: &'a mut [u32],
        sharper: &'a mut [bool],
        cells: &'a mut [FocusCell],
    ) -> Result<Self, FocusConfigError> {
        let view = Self { state, lines, rows, sums, sharper, cells };
        if view.state.config.height > 0 {
            view.check(&view.state.config)?;
        }
        Ok(view)
    }

    fn check(&self, config: &FocusConfig) -> Result<(), FocusConfigError> {
        let width = (self.lines.len() / LINES).min(self.rows.len() / ROWS);
        config.check(width, (self.sums.len() / SUMS).min(self.sharper.len()), self.cells.len())
    }

    /// Begins a stack of frames; what is left of another one is forgotten.
    pub fn start(&mut self, config: &FocusConfig) -> Result<(), FocusConfigError> {
        self.check(config)?;
        *self.state = FocusMapState {
            config: *config,
            floor: 2 * config.weight() as u32,
            taken: config.height,
            shift: BIAS,
            is_running: true,
            ..FocusMapState::new()
        };
        self.cells.fill(FocusCell::EMPTY);
        Ok(())
    }

    /// Frames begun since [`Self::start`].
    pub fn frames(&self) -> u32 {
        self.state.frames
    }

    /// Begins the next frame; all lines of the one before have come.
    pub fn begin_frame(&mut self, breathing: Breathing) -> Result<(), FocusLineError> {
        let state = &mut *self.state;
        if !state.is_running {
            return Err(FocusLineError::NotStarted);
        }
        state.check_complete()?;
        if state.frames >= u16::MAX.into() {
            return Err(FocusLineError::TooManyFrames);
        }
        state.measure_brightness();
        state.frames += 1;
        state.breathing = breathing;
        (state.taken, state.next_row, state.rows_out, state.brightness) = (0, 0, 0, 0);
        state.boxes = [0; 2];
        self.sums.fill(0);
        Ok(())
    }

    /// Takes the next line of grey pixels, and calls `row` with every row of cells that it completes.
    pub fn push(
        &mut self,
        line: &[u8],
        mut row: impl FnMut(AllInFocusRow<'_>),
    ) -> Result<(), FocusLineError> {
        let state = &mut *self.state;
        let FocusConfig { width, height, radius, .. } = state.config;
        if !state.is_running || state.frames == 0 || state.taken >= height {
            return Err(FocusLineError::NoLineDue);
        }
        let (width, newest) = (usize::from(width), usize::from(state.taken));
        if line.len() != width {
            return Err(FocusLineError::Length { needed: width });
        }
        let (mut lines, _) = RowRing::<_, LINES>::split(self.lines, width);
        // They are as long: a copy of slices would ask once more, and panic.
        lines.row_mut(newest).iter_mut().zip(line).for_each(|(place, &pixel)| *place = pixel);
        state.brightness += u64::from(line.iter().map(|&pixel| u32::from(pixel)).sum::<u32>());
        state.taken += 1;
        let is_last = state.taken == height;
        if let Some(centre) = newest.checked_sub(1) {
            self.smooth(centre, newest, &mut row);
        }
        if is_last {
            self.smooth(newest, newest, &mut row);
            self.measure(newest, newest, &mut row);
            (0..radius).for_each(|_| self.first_window(false, &mut row));
            (0..radius).for_each(|_| self.second_window(false, &mut row));
        }
        Ok(())
    }

    /// Smooths row `centre`, where lines have come down to `newest`; then the row above it can be measured.
    fn smooth(&mut self, centre: usize, newest: usize, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let width = usize::from(self.state.config.width);
        let (lines, _) = RowRing::<_, LINES>::split(self.lines, width);
        let (mut smooth, _) = RowRing::<_, SMOOTH>::split(self.rows, width);
        binomial(lines.around(centre, newest), smooth.row_mut(centre));
        if let Some(above) = centre.checked_sub(1) {
            self.measure(above, centre, row);
        }
    }

    /// Measures row `centre`, of which rows down to `newest` are smoothed, and adds it to the rows of the
    /// reference that show it.
    fn measure(&mut self, centre: usize, newest: usize, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let (width, height) = (usize::from(self.state.config.width), usize::from(self.state.config.height));
        let (smooth, rest) = RowRing::<_, SMOOTH>::split(self.rows, width);
        let (mut measured, _) = RowRing::<_, MEASURED>::split(rest, width);
        modified_laplacian(smooth.around(centre, newest), measured.row_mut(centre));
        while usize::from(self.state.next_row) < height {
            let (before, part) = self.state.breathing.between(self.state.next_row.into(), height);
            if before + usize::from(part > 0) > centre {
                break;
            }
            self.add_row(centre, part, row);
        }
    }

    /// Adds the next row of the reference to its cells: it lies by `part` of 256 between the row above
    /// `centre` and `centre`, the last two that were measured, if it is not the last one.
    fn add_row(&mut self, centre: usize, part: u32, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let FocusConfig { width, height, cell_px, .. } = self.state.config;
        let (width, side) = (usize::from(width), usize::from(cell_px).max(1));
        let (_, rest) = RowRing::<_, SMOOTH>::split(self.rows, width);
        let (measured, _) = RowRing::<_, MEASURED>::split(rest, width);
        let [before, newest, _] = measured.around(centre, centre);
        if self.state.breathing.is_none() {
            for (sum, pixels) in self.sums.iter_mut().zip(newest.chunks(side)) {
                *sum += pixels.iter().map(|&pixel| u32::from(pixel)).sum::<u32>();
            }
        } else {
            let above = if part > 0 { before } else { newest };
            let breathing = &self.state.breathing;
            let seen = |x| {
                let (left, right_part) = breathing.between(x, width);
                // 14 bits of the measure and 16 of the parts.
                let along = |line: &[u16]| {
                    let at = |x: usize| u32::from(line.get(x).copied().unwrap_or(0));
                    at(left) * (256 - right_part) + at(left + 1) * right_part
                };
                (along(above) * (256 - part) + along(newest) * part + (1 << 15)) >> 16
            };
            for (first, sum) in (0..width).step_by(side).zip(self.sums.iter_mut()) {
                *sum += (first..(first + side).min(width)).map(seen).sum::<u32>();
            }
        }
        self.state.next_row += 1;
        let is_last = self.state.next_row == height;
        if is_last || usize::from(self.state.next_row).is_multiple_of(side) {
            self.first_window(true, row);
            self.row_sums().fill(0);
        }
    }

    /// The sums of the row of cells in hand, which the windows replace by theirs.
    fn row_sums(&mut self) -> &mut [u32] {
        self.sums.get_mut(..self.state.config.columns()).unwrap_or_default()
    }

    /// Passes the row of sums, or what is below the picture, through window `index`: true when there is a row
    /// of that window's sums in their place.
    fn passes(&mut self, index: usize, is_inside: bool) -> bool {
        let (width, radius) = (self.state.config.columns(), self.state.config.radius.into());
        let (row, rest) = self.sums.split_at_mut_checked(width).unwrap_or_default();
        let memory = rest.chunks_exact_mut(width.max(1) * BoxFilter::ROWS).nth(index).unwrap_or_default();
        let Some(taken) = self.state.boxes.get_mut(index) else { return false };
        BoxFilter { memory, width, radius, taken }.push(is_inside, row)
    }

    /// Passes a row of cells, or what is below the picture, through the first window.
    fn first_window(&mut self, is_inside: bool, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        if self.state.config.radius == 0 {
            self.cells(row);
        } else if self.passes(0, is_inside) {
            self.second_window(true, row);
        }
    }

    /// Passes a row of the first window's sums, or what is below the picture, through the second one.
    fn second_window(&mut self, is_inside: bool, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        if self.passes(1, is_inside) {
            self.cells(row);
        }
    }

    /// Passes the sharpness of the next row of cells through them.
    fn cells(&mut self, row: &mut impl FnMut(AllInFocusRow<'_>)) {
        let FocusMapState { floor, frames, shift, .. } = *self.state;
        let (columns, index) = (self.state.config.columns(), self.state.rows_out);
        self.state.rows_out += 1;
        let cells = self.cells.chunks_exact_mut(columns.max(1)).nth(index).unwrap_or_default();
        let frame = frames.saturating_sub(1);
        for ((cell, &sum), sharper) in cells.iter_mut().zip(self.sums.iter()).zip(self.sharper.iter_mut()) {
            *sharper = cell.push(frame, sum + floor, shift);
        }
        row(AllInFocusRow { index, sharper: self.sharper.get(..columns).unwrap_or(&[]) });
    }

    /// Ends the stack: then all peaks are known.
    pub fn finish(&mut self) -> Result<(), FocusLineError> {
        let state = &mut *self.state;
        if !state.is_running {
            return Err(FocusLineError::NotStarted);
        }
        state.check_complete()?;
        state.measure_brightness();
        let cells = self.cells.iter_mut().take(state.config.cells());
        cells.for_each(|cell| cell.finish(state.frames, state.shift));
        state.is_running = false;
        Ok(())
    }

    /// The peak of a cell, once the stack has ended; [`NoFocus::TooFewFrames`] for one that is not in the
    /// picture.
    pub fn peak(&self, column: usize, row: usize) -> Result<FocusPeak, NoFocus> {
        self.state.peak(self.cells, column, row)
    }
}
