//! Errors of the rectifying remap.

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

error_text!(RemapTableError {
    Self::Slots { needed } => "the remap table must have {needed} slots",
    Self::TooBent => "the warp bends too much between 8 pixels",
});

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

error_text!(RemapError {
    Self::Lines { needed } => "the remap must hold {needed} raw lines at once",
    Self::Width { needed } => "the remap must have room for lines of {needed} px",
    Self::BufferTooShort { needed } => "the line's and the mask's buffers must hold {needed} bytes",
    Self::Early { needed } => "the next rectified line needs {needed} raw lines",
    Self::Late { row } => "a raw line that rectified row {row} needs is no longer held",
    Self::Table(error) => "{error}",
    Self::NoLineLeft => "no rectified line is left in this frame",
});
