//! Shape from focus (Nayar & Nakagawa 1994): frames of a focus sweep to a map of peaks, line by line.

use super::map_state::FocusMapState;
use super::map_view::{FocusMapView, LINES, ROWS, SUMS};
use super::{
    AllInFocusRow, Breathing, FocusCell, FocusConfig, FocusConfigError, FocusLineError, FocusPeak, NoFocus,
};

/// Depth from focus: the frame in which each cell is sharpest, with a fraction, from frames that come one at
/// a time.
///
/// `W` is the longest line, px, `C` the most cells in a row and `CELLS` in a frame. It takes 48 bytes for
/// each cell, and beside them 13 for every pixel of a line and 69 for every cell of a row. The work for a
/// line is bounded by its length, and that for a stack grows with the number of frames.
///
/// In running order: lines are smoothed ([`binomial`](super::binomial)) and measured
/// ([`modified_laplacian`](super::modified_laplacian)); the measure is summed up in cells, then twice over
/// windows; their logarithms pass through the cells, which keep the last eleven frames and the
/// peak so far: a parabola through three logarithms, or through more, up to eleven, where noise would move
/// its top by a tenth of a frame. A peak is found the better, the more frames it spans; three are enough.
///
/// The measure is the default against noise and changes of brightness: smoothing keeps 3/8 of the noise,
/// absolute values grow in proportion to the contrast where squares would let the strongest edge of a window
/// decide, and a frame's mean brightness is divided out. On rendered stacks (fine, coarse and photographed
/// texture; slopes, steps, cones and waves; noise of 1 and 4 grey levels) a window of two sums of 7 by 7 has
/// the least error; narrower ones follow the depth more closely, wider ones average more noise.
#[derive(Debug)]
pub struct FocusMap<const W: usize, const C: usize, const CELLS: usize> {
    state: FocusMapState,
    lines: [[u8; LINES]; W],
    rows: [[u16; ROWS]; W],
    sums: [[u32; SUMS]; C],
    sharper: [bool; C],
    cells: [FocusCell; CELLS],
}

impl<const W: usize, const C: usize, const CELLS: usize> FocusMap<W, C, CELLS> {
    /// A map that waits for [`Self::start`]. All zeros: in a `static` it takes no flash.
    pub const fn new() -> Self {
        Self {
            state: FocusMapState::new(),
            lines: [[0; LINES]; W],
            rows: [[0; ROWS]; W],
            sums: [[0; SUMS]; C],
            sharper: [false; C],
            cells: [FocusCell::EMPTY; CELLS],
        }
    }

    /// The map without its capacities.
    pub fn as_mut_view(&mut self) -> FocusMapView<'_> {
        FocusMapView {
            state: &mut self.state,
            lines: self.lines.as_flattened_mut(),
            rows: self.rows.as_flattened_mut(),
            sums: self.sums.as_flattened_mut(),
            sharper: &mut self.sharper,
            cells: &mut self.cells,
        }
    }

    /// Begins a stack of frames, see [`FocusMapView::start`].
    pub fn start(&mut self, config: &FocusConfig) -> Result<(), FocusConfigError> {
        self.as_mut_view().start(config)
    }

    /// Begins the next frame, see [`FocusMapView::begin_frame`].
    pub fn begin_frame(&mut self, breathing: Breathing) -> Result<(), FocusLineError> {
        self.as_mut_view().begin_frame(breathing)
    }

    /// Takes the next line, see [`FocusMapView::push`].
    pub fn push(&mut self, line: &[u8], row: impl FnMut(AllInFocusRow<'_>)) -> Result<(), FocusLineError> {
        self.as_mut_view().push(line, row)
    }

    /// Ends the stack: then all peaks are known.
    pub fn finish(&mut self) -> Result<(), FocusLineError> {
        self.as_mut_view().finish()
    }

    /// Frames begun since [`Self::start`].
    pub fn frames(&self) -> u32 {
        self.state.frames
    }

    /// The peak of a cell, see [`FocusMapView::peak`].
    pub fn peak(&self, column: usize, row: usize) -> Result<FocusPeak, NoFocus> {
        self.state.peak(&self.cells, column, row)
    }
}

impl<const W: usize, const C: usize, const CELLS: usize> Default for FocusMap<W, C, CELLS> {
    fn default() -> Self {
        Self::new()
    }
}
