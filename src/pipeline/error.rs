//! Errors of the pipeline.

use crate::camera::{CameraError, ErrorType, LineFormat};
use crate::matching::MatchError;
use core::fmt;

/// Why a pipeline that pulls lines from a camera gave no row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PipelineError<E> {
    /// The camera failed; its own error is inside. The frame is over, the next one may begin; but after
    /// [`CameraError::WouldBlock`] the frame goes on, and the call is to be repeated.
    Camera(CameraError<E>),
    /// The camera's frames have another size than the pipeline was started for, or are not
    /// [`PixelFormat::Grey8`](crate::camera::PixelFormat::Grey8).
    Format {
        /// Format of the camera.
        camera: LineFormat,
        /// Format that the pipeline takes.
        needed: LineFormat,
    },
    /// The camera delivered a row out of order.
    RowOrder {
        /// The row that was due.
        expected: u16,
        /// The row that came.
        given: u16,
    },
    /// The camera delivered the previous frame again, detected by [`Guarded`](super::Guarded).
    StaleFrame {
        /// Sequence number of the frame.
        sequence: u32,
    },
    /// The camera delivered a line older than this frame or than the line above, detected by
    /// [`Guarded`](super::Guarded).
    StaleLine {
        /// Row number that the camera reported.
        row: u16,
    },
    /// The matcher refused a line; its own error is inside.
    Matcher(MatchError),
}

/// A `T` of a pipeline that pulls lines from a camera `C`, or why there is none.
pub(super) type CameraResult<T, C> = Result<T, PipelineError<<C as ErrorType>::Error>>;

impl<E: fmt::Display> fmt::Display for PipelineError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera(e) => write!(f, "{e}"),
            Self::Format { camera, needed } => write!(
                f,
                "the camera gives {}x{} in {:?}; needed is {}x{} in {:?}",
                camera.width, camera.height, camera.pixel, needed.width, needed.height, needed.pixel
            ),
            Self::RowOrder { expected, given } => {
                write!(f, "row {given} came from the camera where {expected} was due")
            }
            Self::StaleFrame { sequence } => write!(f, "the camera gave frame {sequence} once more"),
            Self::StaleLine { row } => write!(f, "the camera gave an old line as row {row}"),
            Self::Matcher(e) => write!(f, "{e}"),
        }
    }
}

impl<E: fmt::Display + fmt::Debug> core::error::Error for PipelineError<E> {}

impl<E> PipelineError<E> {
    /// Whether the frame goes on, because the camera has nothing yet.
    pub(super) const fn is_pause(&self) -> bool {
        matches!(self, Self::Camera(CameraError::WouldBlock))
    }
}

impl<E> From<CameraError<E>> for PipelineError<E> {
    fn from(e: CameraError<E>) -> Self {
        Self::Camera(e)
    }
}

impl<E> From<MatchError> for PipelineError<E> {
    fn from(e: MatchError) -> Self {
        Self::Matcher(e)
    }
}

/// Why a pipeline whose lines are pushed gave no row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PushError {
    /// No frame was begun since the start, or the last one was ended by an error.
    NotBegun,
    /// A line has another width than the pipeline was started for.
    LineLength {
        /// Bytes of a line.
        needed: usize,
    },
    /// All lines of the frame are in: flush, or begin the next frame.
    NoLineLeft,
    /// Lines must be pushed before the frame can be flushed.
    LinesMissing {
        /// Number of missing lines.
        missing: usize,
    },
    /// The matcher refused a line; its own error is inside.
    Matcher(MatchError),
}

error_text!(PushError {
    Self::NotBegun => "no frame was begun",
    Self::LineLength { needed } => "a line must have {needed} bytes",
    Self::NoLineLeft => "all lines of this frame are in",
    Self::LinesMissing { missing } => "{missing} lines of this frame are missing",
    Self::Matcher(e) => "{e}",
});

impl From<MatchError> for PushError {
    fn from(e: MatchError) -> Self {
        Self::Matcher(e)
    }
}

/// Checks that a frame of `height` rows is under way, of which the matcher took `taken`: `usize::MAX` between
/// frames.
pub(super) fn begun(height: usize, taken: usize) -> Result<(), PushError> {
    if height == 0 {
        Err(MatchError::NotStarted.into())
    } else if taken == usize::MAX {
        Err(PushError::NotBegun)
    } else {
        Ok(())
    }
}
