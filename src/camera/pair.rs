//! Two line sources as one stereo source.

use super::{CameraError, ErrorType, FrameStart, LineFormat, LineSource, LineStart, StereoSource};
use core::fmt;

/// Two rectified cameras, taken row by row and checked: one row number, time stamps within the bound on row skew.
///
/// When one camera lost a frame, [`start_frame`](StereoSource::start_frame) starts frames of the camera that is behind
/// until the sequence numbers agree, at most [`CameraPair::MAX_CATCH_UP`] of them.
#[derive(Debug)]
pub struct CameraPair<L, R> {
    left: L,
    right: R,
    max_row_skew_us: u32,
}

/// Why two cameras did not give a pair.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PairError<L, R> {
    /// The left camera's hardware failed.
    Left(L),
    /// The right camera's hardware failed.
    Right(R),
    /// The two cameras' frames differ in size or pixel format.
    Formats {
        /// The left camera's.
        left: LineFormat,
        /// The right camera's.
        right: LineFormat,
    },
    /// The sequence numbers stayed apart.
    Sequence {
        /// The left camera's.
        left: u32,
        /// The right camera's.
        right: u32,
    },
    /// The two lines are of different rows.
    Rows {
        /// The left camera's.
        left: u16,
        /// The right camera's.
        right: u16,
    },
    /// The two lines were read out too far apart.
    RowSkew {
        /// Microseconds between them.
        skew_us: u64,
    },
}

impl<L: fmt::Display, R: fmt::Display> fmt::Display for PairError<L, R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Left(e) => write!(f, "left camera: {e}"),
            Self::Right(e) => write!(f, "right camera: {e}"),
            Self::Formats { left, right } => write!(
                f,
                "the left frame is {}x{} and the right {}x{}; both must be of one size and pixel format",
                left.width, left.height, right.width, right.height
            ),
            Self::Sequence { left, right } => {
                write!(f, "frame {left} of the left camera meets frame {right} of the right")
            }
            Self::Rows { left, right } => write!(f, "row {left} of the left camera meets row {right} of the right"),
            Self::RowSkew { skew_us } => write!(f, "the cameras' rows are {skew_us} us apart"),
        }
    }
}

type Paired<T, L, R> = Result<T, CameraError<PairError<<L as ErrorType>::Error, <R as ErrorType>::Error>>>;

impl<L: LineSource, R: LineSource> CameraPair<L, R> {
    /// Frames that one camera may be behind before the pair gives up.
    pub const MAX_CATCH_UP: u32 = 4;

    /// Joins two cameras that may be `max_row_skew_us` apart in reading out a row.
    pub fn new(left: L, right: R, max_row_skew_us: u32) -> Paired<Self, L, R> {
        let (l, r) = (left.format(), right.format());
        if l != r {
            return Err(CameraError::Hardware(PairError::Formats { left: l, right: r }));
        }
        Ok(Self { left, right, max_row_skew_us })
    }

    /// Gives the two cameras back.
    pub fn release(self) -> (L, R) {
        (self.left, self.right)
    }
}

impl<L: LineSource, R: LineSource> ErrorType for CameraPair<L, R> {
    type Error = PairError<L::Error, R::Error>;
}

impl<L: LineSource, R: LineSource> StereoSource for CameraPair<L, R> {
    fn format(&self) -> LineFormat {
        self.left.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.max_row_skew_us
    }

    fn start_frame(&mut self) -> Paired<FrameStart, L, R> {
        let mut left = self.left.start_frame().map_err(|e| e.map_hardware(PairError::Left))?;
        let mut right = self.right.start_frame().map_err(|e| e.map_hardware(PairError::Right))?;
        for _ in 0..Self::MAX_CATCH_UP {
            // The counters wrap: the one behind is the one that reaches the other in fewer steps.
            match left.sequence.wrapping_sub(right.sequence) as i32 {
                0 => break,
                1.. => right = self.right.start_frame().map_err(|e| e.map_hardware(PairError::Right))?,
                _ => left = self.left.start_frame().map_err(|e| e.map_hardware(PairError::Left))?,
            }
        }
        if left.sequence != right.sequence {
            let error = PairError::Sequence { left: left.sequence, right: right.sequence };
            return Err(CameraError::Hardware(error));
        }
        Ok(left)
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Paired<LineStart, L, R> {
        let l = self.left.next_line(left).map_err(|e| e.map_hardware(PairError::Left))?;
        let r = self.right.next_line(right).map_err(|e| e.map_hardware(PairError::Right))?;
        if l.row != r.row {
            return Err(CameraError::Hardware(PairError::Rows { left: l.row, right: r.row }));
        }
        let skew_us = l.timestamp_us.abs_diff(r.timestamp_us);
        if skew_us > u64::from(self.max_row_skew_us) {
            return Err(CameraError::Hardware(PairError::RowSkew { skew_us }));
        }
        Ok(l)
    }
}
