//! Errors of the rectifying remap.

use core::fmt;

/// Why a warp cannot be tabulated.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RemapTableError {
    /// The table has too few slots.
    Slots {
        /// Number of slots that would have been enough.
        needed: usize,
    },
    /// The warp is too curved for the finest lattice, or most of the rectified image is behind the camera.
    TooBent,
}

impl fmt::Display for RemapTableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Slots { needed } => write!(f, "the remap table must have {needed} slots"),
            Self::TooBent => f.write_str("the warp bends too much between 8 pixels"),
        }
    }
}

impl core::error::Error for RemapTableError {}

/// Why lines are not rectified.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RemapError {
    /// The warp needs more raw lines at once than the band holds.
    Lines {
        /// Number of lines `N` that would have been enough.
        needed: usize,
    },
    /// The raw or the rectified lines exceed the capacity.
    Width {
        /// Capacity `W` that would have been enough.
        needed: usize,
    },
    /// The buffers for a rectified line and its mask are too short.
    BufferTooShort {
        /// Bytes that would have been enough.
        needed: usize,
    },
    /// The next rectified line needs a raw line that was not accepted yet.
    Early {
        /// Number of raw lines that are needed.
        needed: u16,
    },
    /// A raw line that the next rectified line needs was overwritten, as too many raw lines were accepted.
    Late {
        /// Row of the rectified line.
        row: u16,
    },
    /// The frame's last rectified line was taken.
    NoLineLeft,
    /// The warp has no table.
    Table(RemapTableError),
}

impl fmt::Display for RemapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lines { needed } => write!(f, "the remap must hold {needed} raw lines at once"),
            Self::Width { needed } => write!(f, "the remap must have room for lines of {needed} px"),
            Self::BufferTooShort { needed } => {
                write!(f, "the line's and the mask's buffers must hold {needed} bytes")
            }
            Self::Early { needed } => write!(f, "the next rectified line needs {needed} raw lines"),
            Self::Late { row } => write!(f, "a raw line that rectified row {row} needs is no longer held"),
            Self::Table(error) => error.fmt(f),
            Self::NoLineLeft => f.write_str("no rectified line is left in this frame"),
        }
    }
}

impl core::error::Error for RemapError {}
