//! What a focus map knows of its stack beside rows and cells.

use super::logarithm::log2;
use super::peak::BIAS;
use super::{Breathing, FocusCell, FocusConfig, FocusLineError, FocusPeak, NoFocus};

/// How far a [`FocusMap`](super::FocusMap) is with a stack of frames.
#[derive(Debug)]
pub struct FocusMapState {
    pub(super) config: FocusConfig,
    /// What every window's sharpness is raised by: two sixteenths of a grey level a pixel, so that rounding
    /// is no texture.
    pub(super) floor: u32,
    pub(super) breathing: Breathing,
    /// Frames begun, and lines of the last one that came.
    pub(super) frames: u32,
    pub(super) taken: u16,
    /// The next row of the reference, of rows of cells, and rows that each of the two windows took.
    pub(super) next_row: u16,
    pub(super) rows_out: usize,
    pub(super) boxes: [usize; 2],
    pub(super) brightness: u64,
    /// The first frame's logarithm of its mean brightness, and what the last complete frame's adds to
    /// sharpness.
    pub(super) reference: u16,
    pub(super) shift: u16,
    pub(super) is_running: bool,
}

impl FocusMapState {
    /// The state of a map that waits for a start. All zeros.
    pub const fn new() -> Self {
        Self {
            config: FocusConfig::NONE,
            floor: 0,
            breathing: Breathing::UNSET,
            frames: 0,
            taken: 0,
            next_row: 0,
            rows_out: 0,
            boxes: [0; 2],
            brightness: 0,
            reference: 0,
            shift: 0,
            is_running: false,
        }
    }

    pub(super) fn check_complete(&self) -> Result<(), FocusLineError> {
        let missing = self.config.height - self.taken;
        if missing == 0 { Ok(()) } else { Err(FocusLineError::FrameIncomplete { missing }) }
    }

    /// What the last frame's brightness adds to the logarithms of its sharpness: those of a frame half as
    /// bright are raised by 1.
    pub(super) fn measure_brightness(&mut self) {
        if self.frames == 0 || !self.config.exposure_varies {
            return;
        }
        let pixels = u64::from(self.config.width) * u64::from(self.config.height);
        // In 1/256 of a grey level: at most 16 bits.
        let mean = log2((self.brightness * 256).checked_div(pixels).unwrap_or(0) as u32);
        if self.frames == 1 {
            self.reference = mean;
        }
        self.shift = (BIAS + self.reference).saturating_sub(mean).min(2 * BIAS);
    }

    pub(super) fn peak(&self, cells: &[FocusCell], column: usize, row: usize) -> Result<FocusPeak, NoFocus> {
        let columns = self.config.columns();
        let place = (column < columns && row < self.config.rows() && !self.is_running)
            .then(|| row * columns + column);
        let cell = place.and_then(|place| cells.get(place));
        cell.ok_or(NoFocus::TooFewFrames { needed: FocusCell::FEWEST_FRAMES })?.peak(self.frames)
    }
}

impl Default for FocusMapState {
    fn default() -> Self {
        Self::new()
    }
}
