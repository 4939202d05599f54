//! What a MT9V034 can be told: when it exposes, what it reads out, what it sends.

/// Who says when a frame is exposed.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mt9v034Mode {
    /// The sensor, one frame after the other.
    #[default]
    Master,
    /// A pulse on its pin EXPOSURE: both sensors of a pair on one pin
    /// ([`Triggered`](crate::camera::Triggered)) expose together, for as long as the register says.
    Snapshot,
    /// Pulses on EXPOSURE and STFRM_OUT, which say when the exposure begins and ends.
    Slave,
}

/// The part of the array that is read out, in its pixels, and how many of them become one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Mt9v034Window {
    /// The first column, from 0.
    pub left: u16,
    /// The first row, from 0.
    pub top: u16,
    /// Columns: at most 752.
    pub width: u16,
    /// Rows: at most 480.
    pub height: u16,
    /// Columns and rows that become one pixel: 1, 2 or 4.
    pub binning: u8,
}

impl Mt9v034Window {
    /// The whole array.
    pub const WHOLE: Self = Self { left: 0, top: 0, width: 752, height: 480, binning: 1 };
}

/// What the sensor sends instead of what it sees.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mt9v034Pattern {
    /// What it sees.
    Off,
    /// One grey, of 10 bits.
    Grey(u16),
    /// Brightness rises down the columns.
    Vertical,
    /// Along the rows.
    Horizontal,
    /// Both.
    Diagonal,
}
