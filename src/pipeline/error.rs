//! Why there is no row.

use crate::camera::{CameraError, LineFormat};
use crate::matching::MatchError;
use core::fmt;

/// Why a camera's lines gave no row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PipelineError<E> {
    /// The camera failed; its own error is inside. The frame is lost, the next one may be begun.
    Camera(CameraError<E>),
    /// The camera's frames are not of the size that the pipeline was started for, or not
    /// [`PixelFormat::Grey8`](crate::camera::PixelFormat::Grey8).
    Format {
        /// What the camera gives.
        camera: LineFormat,
        /// What the pipeline takes.
        needed: LineFormat,
    },
    /// The camera gave another row than the next one.
    RowOrder {
        /// The row that was due.
        expected: u16,
        /// The row that came.
        given: u16,
    },
    /// The camera handed out the frame before once more: [`Guarded`](super::Guarded) tells.
    StaleFrame {
        /// Its sequence number.
        sequence: u32,
    },
    /// The camera handed out a line of before this frame, or of before the line above:
    /// [`Guarded`](super::Guarded) tells.
    StaleLine {
        /// The row that it said.
        row: u16,
    },
    /// No frame was begun.
    Matcher(MatchError),
}

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

/// Why lines that the caller brings give no row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PushError {
    /// No frame was begun since the start, or the last one broke off.
    NotBegun,
    /// A line has not the width that the pipeline was started for.
    LineLength {
        /// Bytes that a line has.
        needed: usize,
    },
    /// All lines of the frame are in: flush, or begin the next one.
    NoLineLeft,
    /// Lines have to be pushed before the frame can be flushed.
    LinesMissing {
        /// How many.
        missing: usize,
    },
    /// The pipeline was not started.
    Matcher(MatchError),
}

impl fmt::Display for PushError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotBegun => f.write_str("no frame was begun"),
            Self::LineLength { needed } => write!(f, "a line must have {needed} bytes"),
            Self::NoLineLeft => f.write_str("all lines of this frame are in"),
            Self::LinesMissing { missing } => write!(f, "{missing} lines of this frame are missing"),
            Self::Matcher(e) => write!(f, "{e}"),
        }
    }
}

impl core::error::Error for PushError {}

impl From<MatchError> for PushError {
    fn from(e: MatchError) -> Self {
        Self::Matcher(e)
    }
}
