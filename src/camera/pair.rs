//! A stereo source of two line sources: frames paired by sequence number or time stamp, rows checked.

use super::{
    CameraError, ErrorType, FrameStart, LineFault, LineFormat, LineSource, LineStart, RowSkew, StereoSource,
};
use core::fmt;

/// Two rectified cameras read row by row: both lines have one row number, and time stamps within the row-skew
/// bound.
///
/// When one camera lost a frame, [`start_frame`](StereoSource::start_frame) skips frames of the camera that
/// is behind until their [`Pairing`] agrees, at most [`CameraPair::MAX_CATCH_UP`] of them. When one lost a
/// line, the pair fails once and goes on with the row below, for which the camera that is behind skips lines.
/// A stale line or frame of either, shown by its time stamp or number, is refused. The caller sees the left
/// camera's time stamps.
///
/// Both cameras have to wait for their lines: where the right one gives [`CameraError::WouldBlock`], the left
/// one's line is lost already.
#[derive(Debug)]
pub struct CameraPair<L, R> {
    left: L,
    right: R,
    pairing: Pairing,
    max_row_skew_us: u32,
    skew: RowSkew,
    /// Lines that a camera gives up before the next one.
    left_behind: u16,
    right_behind: u16,
    /// The sequence numbers of the frames that the cameras started last.
    before: [u32; 2],
    /// The newest time stamps of their frames, microseconds.
    newest_us: [u64; 2],
}

/// How frames of two cameras are paired.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Pairing {
    /// Equal sequence numbers: cameras that count the pulses of one trigger. Numbers that count frames do not
    /// do: once a camera has missed a pulse, equal numbers are of different pulses.
    #[default]
    Sequence,
    /// Time stamps within the bound on row skew: cameras that run freely, stamped by one clock. The pair's
    /// sequence number is the left camera's.
    TimeStamp,
}

/// Why two cameras delivered no pair of lines.
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
        /// Format of the left camera.
        left: LineFormat,
        /// Format of the right camera.
        right: LineFormat,
    },
    /// The sequence numbers stayed different.
    Sequence {
        /// Sequence number of the left camera.
        left: u32,
        /// Sequence number of the right camera.
        right: u32,
    },
    /// The two lines are of different rows.
    Rows {
        /// Row of the left camera.
        left: u16,
        /// Row of the right camera.
        right: u16,
    },
    /// The frames' time stamps stayed apart.
    FrameSkew {
        /// Microseconds between them.
        skew_us: u64,
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
            Self::Rows { left, right } => {
                write!(f, "row {left} of the left camera meets row {right} of the right")
            }
            Self::FrameSkew { skew_us } => write!(f, "the cameras' frames stay {skew_us} us apart"),
            Self::RowSkew { skew_us } => write!(f, "the cameras' rows are {skew_us} us apart"),
        }
    }
}

type Paired<T, L, R> = Result<T, CameraError<PairError<<L as ErrorType>::Error, <R as ErrorType>::Error>>>;

impl<L: LineSource, R: LineSource> CameraPair<L, R> {
    /// Frames that one camera may be behind before the pair gives up.
    pub const MAX_CATCH_UP: u32 = 4;

    /// Joins two cameras that may be `max_row_skew_us` apart in reading out a row, by the time stamps of
    /// their lines: both cameras have a clock, or neither has and all time stamps are 0.
    pub fn new(left: L, right: R, max_row_skew_us: u32) -> Paired<Self, L, R> {
        let (l, r) = (left.format(), right.format());
        if l != r {
            return Err(CameraError::Hardware(PairError::Formats { left: l, right: r }));
        }
        let (pairing, skew) = (Pairing::Sequence, RowSkew::default());
        Ok(Self {
            left,
            right,
            pairing,
            max_row_skew_us,
            skew,
            left_behind: 0,
            right_behind: 0,
            before: [0; 2],
            newest_us: [0; 2],
        })
    }

    /// Sets how frames are paired.
    pub fn paired_by(self, pairing: Pairing) -> Self {
        Self { pairing, ..self }
    }

    /// Row skew of this frame's rows so far, including rows that were refused for it.
    pub fn row_skew(&self) -> RowSkew {
        self.skew
    }

    fn start_left(&mut self) -> Paired<Started, L, R> {
        let start = self.left.start_frame().map_err(|e| e.map_hardware(PairError::Left))?;
        let [before, _] = &mut self.before;
        Ok(Started::after(before, start))
    }

    fn start_right(&mut self) -> Paired<Started, L, R> {
        let start = self.right.start_frame().map_err(|e| e.map_hardware(PairError::Right))?;
        let [_, before] = &mut self.before;
        Ok(Started::after(before, start))
    }

    /// How far the left camera's frame is before (negative) or behind the right one's; 0 is a pair.
    fn apart(&self, left: &Started, right: &Started) -> i64 {
        // A camera that gives its frame once more is behind, whatever its number says.
        if left.is_stale || right.is_stale {
            return if left.is_stale { -1 } else { 1 };
        }
        let (left, right) = (&left.start, &right.start);
        match self.pairing {
            // The counters wrap: the one behind is the one that reaches the other in fewer steps.
            Pairing::Sequence => i64::from(left.sequence.wrapping_sub(right.sequence) as i32),
            Pairing::TimeStamp => {
                let apart = left.timestamp_us.wrapping_sub(right.timestamp_us) as i64;
                if apart.unsigned_abs() <= u64::from(self.max_row_skew_us) { 0 } else { apart }
            }
        }
    }

    /// Gives the two cameras back.
    pub fn release(self) -> (L, R) {
        (self.left, self.right)
    }
}

/// Skips the lines that a camera is behind. Those left after an error are skipped the next time.
fn skip<S: LineSource>(
    source: &mut S,
    behind: &mut u16,
    line: &mut [u8],
) -> Result<(), CameraError<S::Error>> {
    while *behind > 0 {
        match source.next_line(line) {
            // A line that is lost need not be skipped.
            Ok(_) | Err(CameraError::LineLost(_)) => *behind -= 1,
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// A camera's frame, and whether it is the one before once more.
struct Started {
    start: FrameStart,
    is_stale: bool,
}

impl Started {
    fn after(before: &mut u32, start: FrameStart) -> Self {
        // A source that does not count says 0.
        let is_stale = start.sequence != 0 && start.sequence == *before;
        *before = start.sequence;
        Self { start, is_stale }
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
        (self.skew, self.left_behind, self.right_behind) = (RowSkew::default(), 0, 0);
        let (mut left, mut right) = (self.start_left()?, self.start_right()?);
        for _ in 0..Self::MAX_CATCH_UP {
            match self.apart(&left, &right) {
                0 => break,
                1.. => right = self.start_right()?,
                _ => left = self.start_left()?,
            }
        }
        let apart = self.apart(&left, &right);
        let (left, right) = (left.start, right.start);
        if apart != 0 {
            return Err(CameraError::Hardware(match self.pairing {
                Pairing::Sequence => PairError::Sequence { left: left.sequence, right: right.sequence },
                Pairing::TimeStamp => {
                    PairError::FrameSkew { skew_us: left.timestamp_us.abs_diff(right.timestamp_us) }
                }
            }));
        }
        self.newest_us = [left.timestamp_us, right.timestamp_us];
        Ok(left)
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Paired<LineStart, L, R> {
        let needed = self.format().line_bytes();
        if left.len().min(right.len()) < needed {
            return Err(CameraError::BufferTooShort { needed });
        }
        skip(&mut self.left, &mut self.left_behind, left).map_err(|e| e.map_hardware(PairError::Left))?;
        skip(&mut self.right, &mut self.right_behind, right).map_err(|e| e.map_hardware(PairError::Right))?;
        // Both are asked, whatever the first one says: they stay in step.
        let (l, r) = (self.left.next_line(left), self.right.next_line(right));
        let l = l.map_err(|e| e.map_hardware(PairError::Left))?;
        let r = r.map_err(|e| e.map_hardware(PairError::Right))?;
        if l.row != r.row {
            self.left_behind = r.row.saturating_sub(l.row);
            self.right_behind = l.row.saturating_sub(r.row);
            return Err(CameraError::Hardware(PairError::Rows { left: l.row, right: r.row }));
        }
        // The caller sees the left camera's time stamps alone.
        for (newest_us, line) in self.newest_us.iter_mut().zip([&l, &r]) {
            if line.timestamp_us != 0 && line.timestamp_us < *newest_us {
                return Err(CameraError::LineLost(LineFault::Stale));
            }
            *newest_us = (*newest_us).max(line.timestamp_us);
        }
        self.skew.add(l.timestamp_us, r.timestamp_us);
        let skew_us = l.timestamp_us.abs_diff(r.timestamp_us);
        if skew_us > u64::from(self.max_row_skew_us) {
            return Err(CameraError::Hardware(PairError::RowSkew { skew_us }));
        }
        Ok(l)
    }
}
