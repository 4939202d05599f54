//! Vectors that a focus map works in, as long as one stack takes.

use stereopsis::focus::{FocusCell, FocusConfig, FocusConfigError, FocusMapState, FocusMapView};

/// The memory of a map.
#[derive(Debug)]
pub struct MapMemory {
    state: FocusMapState,
    lines: Vec<u8>,
    rows: Vec<u16>,
    sums: Vec<u32>,
    sharper: Vec<bool>,
    cells: Vec<FocusCell>,
}

impl MapMemory {
    /// For a stack of this kind.
    pub fn new(config: &FocusConfig) -> Self {
        let (width, columns) = (usize::from(config.width), config.columns());
        Self {
            state: FocusMapState::new(),
            lines: vec![0; FocusMapView::LINES * width],
            rows: vec![0; FocusMapView::ROWS * width],
            sums: vec![0; FocusMapView::SUMS * columns],
            sharper: vec![false; columns],
            cells: vec![FocusCell::EMPTY; config.cells()],
        }
    }

    /// The map in it.
    pub fn view(&mut self) -> Result<FocusMapView<'_>, FocusConfigError> {
        let Self { state, lines, rows, sums, sharper, cells } = self;
        FocusMapView::new(state, lines, rows, sums, sharper, cells)
    }
}
