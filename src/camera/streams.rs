//! One stream that carries two cameras, and lines the other way round.

use super::{CameraError, ErrorType, FrameStart, LineFault, LineFormat, LineSource, LineStart, StereoSource};
use core::fmt;

/// Why a stream does not carry two cameras.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum StreamError {
    /// A line must have two halves of whole groups of pixels.
    OddWidth {
        /// Pixels in a line.
        width: u16,
    },
    /// The lines must be pairs.
    OddHeight {
        /// Lines in a frame.
        height: u16,
    },
    /// The buffer for a line of the stream is too short.
    BufferTooShort {
        /// Bytes that would have been enough.
        needed: usize,
    },
    /// Pixels that share bytes cannot be turned round.
    SharedBytes,
}

impl fmt::Display for StreamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OddWidth { width } => write!(f, "a line of {width} pixels has no two halves"),
            Self::OddHeight { height } => write!(f, "a frame of {height} lines is no pairs of lines"),
            Self::BufferTooShort { needed } => write!(f, "the buffer must hold {needed} bytes"),
            Self::SharedBytes => f.write_str("pixels that share bytes cannot be turned round"),
        }
    }
}

impl core::error::Error for StreamError {}

/// Two cameras side by side in one stream: the first half of each line is the left one's.
///
/// `RAW` is the size of the buffer for one line of the stream, bytes.
#[derive(Debug)]
pub struct SideBySide<S, const RAW: usize> {
    source: S,
    raw: [u8; RAW],
}

impl<S: LineSource, const RAW: usize> SideBySide<S, RAW> {
    /// Takes the two cameras from a stream.
    pub fn new(source: S) -> Result<Self, StreamError> {
        let LineFormat { width, pixel, .. } = source.format();
        if !usize::from(width).is_multiple_of(2 * pixel.group().0) {
            return Err(StreamError::OddWidth { width });
        }
        let needed = source.format().line_bytes();
        if needed > RAW {
            Err(StreamError::BufferTooShort { needed })
        } else {
            Ok(Self { source, raw: [0; RAW] })
        }
    }

    /// The stream.
    pub fn source(&self) -> &S {
        &self.source
    }

    /// Gives the stream back.
    pub fn release(self) -> S {
        self.source
    }
}

impl<S: LineSource, const RAW: usize> ErrorType for SideBySide<S, RAW> {
    type Error = S::Error;
}

impl<S: LineSource, const RAW: usize> StereoSource for SideBySide<S, RAW> {
    fn format(&self) -> LineFormat {
        let both = self.source.format();
        LineFormat { width: both.width / 2, ..both }
    }

    /// A row of both is one line.
    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<S::Error>> {
        self.source.start_frame()
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        let needed = self.format().line_bytes();
        let (Some(left), Some(right)) = (left.get_mut(..needed), right.get_mut(..needed)) else {
            return Err(CameraError::BufferTooShort { needed });
        };
        let start = self.source.next_line(&mut self.raw)?;
        left.iter_mut().chain(right).zip(&self.raw).for_each(|(to, &from)| *to = from);
        Ok(start)
    }
}

/// Two cameras in one stream, line by line: line 2 v is the left one's row v, line 2 v + 1 the right one's.
#[derive(Debug)]
pub struct Interleaved<S> {
    source: S,
    line_us: u32,
    /// The stream is a line ahead: this one of the left camera was taken while its partner before was lost.
    lost: bool,
}

impl<S: LineSource> Interleaved<S> {
    /// Takes the two cameras from a stream whose lines come `line_us` microseconds apart: so far are the rows
    /// of the two. For cameras that exposed together and are only sent one after the other, that is 0.
    pub fn new(source: S, line_us: u32) -> Result<Self, StreamError> {
        let height = source.format().height;
        if !height.is_multiple_of(2) {
            Err(StreamError::OddHeight { height })
        } else {
            Ok(Self { source, line_us, lost: false })
        }
    }

    /// Gives the stream back.
    pub fn release(self) -> S {
        self.source
    }
}

impl<S: ErrorType> ErrorType for Interleaved<S> {
    type Error = S::Error;
}

impl<S: LineSource> StereoSource for Interleaved<S> {
    fn format(&self) -> LineFormat {
        let both = self.source.format();
        LineFormat { height: both.height / 2, ..both }
    }

    fn max_row_skew_us(&self) -> u32 {
        self.line_us
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<S::Error>> {
        self.lost = false;
        self.source.start_frame()
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        let needed = self.format().line_bytes();
        if left.len().min(right.len()) < needed {
            return Err(CameraError::BufferTooShort { needed });
        }
        // After a fault the stream may stand on a right line: one more is taken, and the row is lost once.
        let first = self.source.next_line(left).inspect_err(|_| self.lost = true)?;
        if first.row % 2 != 0 {
            let was_told = core::mem::take(&mut self.lost);
            if !was_told {
                return Err(CameraError::LineLost(LineFault::Dropped));
            }
            return self.next_lines_of_row(left, right);
        }
        self.second(first, right)
    }
}

impl<S: LineSource> Interleaved<S> {
    fn next_lines_of_row(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<S::Error>> {
        let first = self.source.next_line(left)?;
        if first.row % 2 != 0 {
            return Err(CameraError::LineLost(LineFault::Dropped));
        }
        self.second(first, right)
    }

    /// The right camera's line to the left one's.
    fn second(&mut self, first: LineStart, right: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        self.lost = false;
        let second = self.source.next_line(right)?;
        if second.row != first.row.saturating_add(1) {
            // It is of a row below. If that is a left line, its right one comes next, and is passed over
            // there.
            return Err(CameraError::LineLost(LineFault::Dropped));
        }
        Ok(LineStart { row: first.row / 2, ..first })
    }
}

/// A camera whose lines run from right to left, as behind a mirror: turned round.
///
/// Rows cannot be turned round without a frame's memory: a sensor that stands on its head is told to read out
/// so ([`Mt9v034::set_flips`](super::Mt9v034::set_flips)). Two cameras that stand on their heads together
/// need nothing: the picture is upside down, and the disparities are right.
#[derive(Debug)]
pub struct Mirrored<S> {
    source: S,
}

impl<S: LineSource> Mirrored<S> {
    /// Turns the lines of a source round, whose pixels have whole bytes of their own.
    pub fn new(source: S) -> Result<Self, StreamError> {
        match source.format().pixel.group() {
            (1, _) => Ok(Self { source }),
            _ => Err(StreamError::SharedBytes),
        }
    }

    /// Gives the source back.
    pub fn release(self) -> S {
        self.source
    }
}

impl<S: ErrorType> ErrorType for Mirrored<S> {
    type Error = S::Error;
}

impl<S: LineSource> LineSource for Mirrored<S> {
    fn format(&self) -> LineFormat {
        self.source.format()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<S::Error>> {
        self.source.start_frame()
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        let format = self.source.format();
        let start = self.source.next_line(line)?;
        let line = line.get_mut(..format.line_bytes()).unwrap_or_default();
        // All bytes turned round, then each pixel's back.
        line.reverse();
        for pixel in line.chunks_exact_mut(format.pixel.bytes_per_pixel()) {
            pixel.reverse();
        }
        Ok(start)
    }
}
