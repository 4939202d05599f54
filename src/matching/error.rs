//! Why a matcher took no line.

/// Why a matcher took no line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum MatchError {
    /// The matcher was not configured.
    NotStarted,
    /// No such row is due: a line after the frame's last one, a flush before that one, or one after the last
    /// result.
    FrameDone,
    /// A line is shorter than the width configured.
    LineTooShort {
        /// Pixels that would have been enough.
        needed: usize,
    },
    /// The winners of a row are missing, or fewer than the width configured: the method takes them from
    /// outside ([`External`](super::External)).
    Winners {
        /// Records that would have been enough.
        needed: usize,
    },
    /// No search can have this winner: its disparity is none of the candidates, or another cost is below its
    /// own.
    WinnerRefused {
        /// The winner's column.
        column: u16,
    },
}

error_text!(MatchError {
    Self::NotStarted => "the matcher was not started",
    Self::FrameDone => "the frame has no such line due",
    Self::LineTooShort { needed } => "a line must have {needed} pixels",
    Self::Winners { needed } => "a row must have {needed} winners",
    Self::WinnerRefused { column } => "the winner in column {column} is none that a search can have",
});
