//! Why a pipeline of winners gave no row.

use super::source::WinnerError;
use crate::matching::{ConfigError, MatchError};
use crate::pipeline::PushError;
use core::fmt;

/// Why a pipeline of winners gave no row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum WinnerPipelineError<E> {
    /// The device gave no winners; its own error is inside. The frame is over.
    Source(WinnerError<E>),
    /// The line or the call does not fit, and nothing has changed; but after
    /// [`MatchError::WinnerRefused`], a winner that no search gives, the frame is over.
    Push(PushError),
    /// The configuration is none that the matcher takes.
    Config(ConfigError),
}

impl<E: fmt::Display> fmt::Display for WinnerPipelineError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Source(e) => write!(f, "{e}"),
            Self::Push(e) => write!(f, "{e}"),
            Self::Config(e) => write!(f, "{e}"),
        }
    }
}

impl<E: fmt::Display + fmt::Debug> core::error::Error for WinnerPipelineError<E> {}

impl<E> From<WinnerError<E>> for WinnerPipelineError<E> {
    fn from(e: WinnerError<E>) -> Self {
        Self::Source(e)
    }
}

impl<E> From<PushError> for WinnerPipelineError<E> {
    fn from(e: PushError) -> Self {
        Self::Push(e)
    }
}

impl<E> From<MatchError> for WinnerPipelineError<E> {
    fn from(e: MatchError) -> Self {
        Self::Push(e.into())
    }
}
