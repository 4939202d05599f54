//! Configuration of a focus map.

use super::box_filter::MOST_RADIUS;

/// Size and cells of a focus map.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FocusConfig {
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
    /// Side of a cell, px: 1 for an answer a pixel.
    pub cell_px: u16,
    /// A cell's sharpness is that of the window of `4 r + 1` by `4 r + 1` cells around it, nearer ones
    /// counting more: sums over `2 r + 1` by `2 r + 1`, twice.
    pub radius: u8,
    /// Whether each frame's sharpness is divided by its mean brightness, for frames of different exposures.
    pub exposure_varies: bool,
}

impl FocusConfig {
    /// The largest radius.
    pub const MOST_RADIUS: u8 = MOST_RADIUS as u8;
    /// The most pixels in a window, counted as often as they count: with it no sum overflows.
    pub const MOST_WEIGHT: u32 = 1 << 14;

    /// No frames.
    pub(super) const NONE: Self = Self { width: 0, height: 0, cell_px: 0, radius: 0, exposure_varies: false };

    /// An answer a pixel, from windows of radius 3.
    pub const fn pixels(width: u16, height: u16) -> Self {
        Self { width, height, cell_px: 1, radius: 3, exposure_varies: true }
    }

    /// An answer a tile of 8 by 8 pixels, from that tile alone.
    pub const fn tiles(width: u16, height: u16) -> Self {
        Self { width, height, cell_px: 8, radius: 0, exposure_varies: true }
    }

    /// An answer a pixel, or for each four, from windows of three sizes, the narrowest first, for
    /// [`narrowest_steady`](super::narrowest_steady): 5, 13 and 26 pixels wide, with nearer ones counting
    /// more.
    pub const fn windows(width: u16, height: u16) -> [Self; 3] {
        let pixels = Self::pixels(width, height);
        [Self { radius: 1, ..pixels }, pixels, Self { cell_px: 2, ..pixels }]
    }

    /// Windows of two sizes for frames that breathe ([`Breathing`](super::Breathing)), 18 and 26 pixels wide:
    /// what lies between two pixels is less sharp than on one, and a window has to be wide enough for that
    /// to average out.
    pub const fn breathing_windows(width: u16, height: u16) -> [Self; 2] {
        let [.., widest] = Self::windows(width, height);
        [Self { radius: 2, ..widest }, widest]
    }

    /// Cells in a row; those at the right end may be cut off.
    pub const fn columns(&self) -> usize {
        self.width.div_ceil(if self.cell_px == 0 { 1 } else { self.cell_px }) as usize
    }

    /// Rows of cells.
    pub const fn rows(&self) -> usize {
        self.height.div_ceil(if self.cell_px == 0 { 1 } else { self.cell_px }) as usize
    }

    /// All cells.
    pub const fn cells(&self) -> usize {
        self.columns() * self.rows()
    }

    /// How often the pixels of a whole window count together.
    pub(super) fn weight(&self) -> u64 {
        let side = u64::from(self.radius) * 2 + 1;
        u64::from(self.cell_px) * u64::from(self.cell_px) * side * side * side * side
    }

    /// Whether a map with room for lines of `width` pixels and `columns` cells can be of this kind.
    pub(super) fn check(&self, width: usize, columns: usize, cells: usize) -> Result<(), FocusConfigError> {
        if usize::from(self.width) > width {
            return Err(FocusConfigError::Width { most: width });
        }
        if self.width == 0 || self.height == 0 {
            return Err(FocusConfigError::Empty);
        }
        if self.cell_px == 0 || self.radius > Self::MOST_RADIUS || self.weight() > Self::MOST_WEIGHT.into() {
            return Err(FocusConfigError::Window);
        }
        if self.columns() > columns {
            return Err(FocusConfigError::Columns { needed: self.columns() });
        }
        if self.cells() > cells {
            return Err(FocusConfigError::Cells { needed: self.cells() });
        }
        Ok(())
    }
}

/// Why there is no such focus map.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FocusConfigError {
    /// A frame has no pixel.
    Empty,
    /// Lines are longer than the map's capacity.
    Width {
        /// Capacity, px.
        most: usize,
    },
    /// Cells have no side, the radius is over [`FocusConfig::MOST_RADIUS`], or a window counts more than
    /// [`FocusConfig::MOST_WEIGHT`] pixels.
    Window,
    /// A row has more cells than the map's capacity.
    Columns {
        /// Cells that would have been enough.
        needed: usize,
    },
    /// The memory for cells is too short.
    Cells {
        /// Cells that would have been enough.
        needed: usize,
    },
}

error_text!(FocusConfigError {
    Self::Empty => "a frame has no pixel",
    Self::Width { most } => "lines have more than {most} pixels",
    Self::Window =>
        "a cell has no side, the radius is over {MOST_RADIUS}, or a window counts over {} pixels"
            (FocusConfig::MOST_WEIGHT),
    Self::Columns { needed } => "room for {needed} cells in a row is needed",
    Self::Cells { needed } => "room for {needed} cells is needed",
});

/// Why a line or a frame was not taken.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FocusLineError {
    /// No frame was begun, or all lines of the frame have come.
    NoLineDue,
    /// The stack was not started, or it is finished.
    NotStarted,
    /// The line has another length than the configuration says.
    Length {
        /// What was due, px.
        needed: usize,
    },
    /// The last frame is not complete.
    FrameIncomplete {
        /// Lines that are missing.
        missing: u16,
    },
    /// A frame's scale is not 1/2 to 2.
    Scale,
    /// More than 65 535 frames.
    TooManyFrames,
}

error_text!(FocusLineError {
    Self::NoLineDue => "no line is due: begin a frame",
    Self::NotStarted => "no stack is under way: start one",
    Self::Length { needed } => "a line of {needed} pixels is due",
    Self::FrameIncomplete { missing } => "{missing} lines of the frame are missing",
    Self::Scale => "a frame's scale must be from 1/2 to 2",
    Self::TooManyFrames => "a stack has at most 65535 frames",
});
