//! Settings of the MT9V034: trigger mode, window and test pattern.

/// Trigger of the exposure.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Mt9v034Mode {
    /// Free-running: the sensor exposes one frame after the other.
    #[default]
    Master,
    /// Snapshot on a pulse of the pin EXPOSURE, for as long as the register says. Both sensors of a pair on
    /// one pin expose together ([`Triggered`](crate::camera::Triggered)).
    Snapshot,
}

/// Window of the pixel array that is read out, in its pixels, and its binning.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mt9v034Window {
    /// First column, from 0.
    pub left: u16,
    /// First row, from 0.
    pub top: u16,
    /// Number of columns, at most 752.
    pub width: u16,
    /// Number of rows, at most 480.
    pub height: u16,
    /// Columns and rows that make one pixel.
    pub binning: Mt9v034Binning,
}

/// Binning of a [`Mt9v034Window`], along its rows and its columns alike.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Mt9v034Binning {
    /// Every pixel of the array is one of the picture.
    One = 0,
    /// Two by two pixels are one.
    Two = 1,
    /// Four by four pixels are one.
    Four = 2,
}

impl Mt9v034Window {
    /// Whole array without binning.
    pub const WHOLE: Self = Self { left: 0, top: 0, width: 752, height: 480, binning: Mt9v034Binning::One };
}

/// Test pattern that the sensor sends instead of the picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Mt9v034Pattern {
    /// The picture, without a test pattern.
    Off,
    /// Uniform grey, 10 bits.
    Grey(u16),
    /// Brightness that rises down the columns.
    Vertical,
    /// Brightness that rises along the rows.
    Horizontal,
    /// Brightness that rises along both.
    Diagonal,
}
