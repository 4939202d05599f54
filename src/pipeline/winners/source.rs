//! A device that computes winners.

use crate::imaging::Noise;
use crate::matching::{Penalties, WinnerRecord};
use core::fmt;

/// What a device is asked for, before its first frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WinnerSearch {
    /// The method, as [`Method::NAME`](crate::matching::Method::NAME) spells it.
    pub method: &'static str,
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
    /// How many whole disparities are searched.
    pub disparities: u16,
    /// The smallest one, px.
    pub min_disparity: u16,
    /// How lines are smoothed before they are compared.
    pub noise: Noise,
    /// What a change of the disparity costs along a path; the methods over windows do not look at it.
    pub penalties: Penalties,
    /// Whether a check looks at the [second best](WinnerRecord::second).
    pub second_best: bool,
}

/// A device that computes the winners of a stereo pair, row by row.
///
/// ```text
/// start(search)      once, and after an error
/// begin_frame()      before a frame
///   push_lines()     for every line, where lines come by this core
///   next_row(0)      once line 2 + RADIUS_Y is in, and a line more where lines come by this core
///   next_row(1)      a line later, and so on; the last rows after the last line
/// ```
pub trait WinnerSource {
    /// The hardware's own error.
    type Error;

    /// Gets ready for frames of a search, and forgets what is under way. A device that cannot do it says
    /// [`WinnerError::Search`].
    fn start(&mut self, search: &WinnerSearch) -> Result<(), WinnerError<Self::Error>>;

    /// Gets ready for a frame.
    fn begin_frame(&mut self) -> Result<(), WinnerError<Self::Error>>;

    /// Hands the next line of both cameras to the device. One that has the cameras' lines already does
    /// nothing.
    fn push_lines(&mut self, left: &[u8], right: &[u8]) -> Result<(), WinnerError<Self::Error>>;

    /// Gives the winners of row `row`, the next one, of all pixels of a line; waits for them no longer than
    /// the device's own limit.
    ///
    /// After [`WinnerError::Late`], [`WinnerError::Count`] and [`WinnerError::Damaged`] the frame goes on
    /// with the next row; any other error ends it.
    fn next_row(&mut self, row: u16, winners: &mut [WinnerRecord]) -> Result<(), WinnerError<Self::Error>>;
}

impl<T: WinnerSource + ?Sized> WinnerSource for &mut T {
    type Error = T::Error;

    fn start(&mut self, search: &WinnerSearch) -> Result<(), WinnerError<Self::Error>> {
        T::start(self, search)
    }

    fn begin_frame(&mut self) -> Result<(), WinnerError<Self::Error>> {
        T::begin_frame(self)
    }

    fn push_lines(&mut self, left: &[u8], right: &[u8]) -> Result<(), WinnerError<Self::Error>> {
        T::push_lines(self, left, right)
    }

    fn next_row(&mut self, row: u16, winners: &mut [WinnerRecord]) -> Result<(), WinnerError<Self::Error>> {
        T::next_row(self, row, winners)
    }
}

/// Why a device gave no winners.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WinnerError<E> {
    /// The hardware failed; its own error is inside.
    Device(E),
    /// The device cannot do this search: its method, its room, or a check that it gives nothing for.
    Search,
    /// Nothing of the row came within the device's limit.
    Late {
        /// The row.
        row: u16,
    },
    /// The row has another number of records than a line has pixels.
    Count {
        /// The row.
        row: u16,
        /// Records that came.
        given: usize,
    },
    /// A record's check byte does not fit, or it is of another row.
    Damaged {
        /// The row.
        row: u16,
        /// The first column with such a record.
        column: u16,
    },
    /// A line that went into the device was too short or too long, and the frame is over.
    LineLength,
    /// The next frame began before this one's last line.
    FrameCutOff,
}

impl<E> WinnerError<E> {
    /// Whether the frame goes on with the next row.
    pub const fn is_of_one_row(&self) -> bool {
        matches!(self, Self::Late { .. } | Self::Count { .. } | Self::Damaged { .. })
    }
}

impl<E: fmt::Display> fmt::Display for WinnerError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Device(e) => write!(f, "{e}"),
            Self::Search => write!(f, "the device cannot do this search"),
            Self::Late { row } => write!(f, "the winners of row {row} are late"),
            Self::Count { row, given } => write!(f, "row {row} has {given} winners"),
            Self::Damaged { row, column } => {
                write!(f, "the winner in column {column} of row {row} is damaged")
            }
            Self::LineLength => write!(f, "a line of the device had a wrong length"),
            Self::FrameCutOff => write!(f, "the device's frame was cut off by the next one"),
        }
    }
}

impl<E: fmt::Display + fmt::Debug> core::error::Error for WinnerError<E> {}
