//! Streams that carry two cameras, side by side or interleaved; mirrored lines.

use super::{CameraError, ErrorType, FrameStart, LineFault, LineFormat, LineSource, LineStart, StereoSource};

/// Why a stream cannot be split or mirrored.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum StreamError {
    /// A line has no two halves of whole groups of pixels.
    OddWidth {
        /// Pixels in a line.
        width: u16,
    },
    /// The number of lines is odd.
    OddHeight {
        /// Lines in a frame.
        height: u16,
    },
    /// The buffer for a line of the stream is too short.
    BufferTooShort {
        /// Bytes that would have been enough.
        needed: usize,
    },
    /// Pixels that share bytes cannot be mirrored.
    SharedBytes,
}

error_text!(StreamError {
    Self::OddWidth { width } => "a line of {width} pixels has no two halves",
    Self::OddHeight { height } => "a frame of {height} lines is no pairs of lines",
    Self::BufferTooShort { needed } => "the buffer must hold {needed} bytes",
    Self::SharedBytes => "pixels that share bytes cannot be mirrored",
});

/// Two cameras side by side in one stream: the first half of each line is the left camera's.
///
/// `RAW` is the capacity for one line of the stream, bytes.
#[derive(Debug)]
pub struct SideBySide<S, const RAW: usize> {
    source: S,
    raw: [u8; RAW],
}

impl<S: LineSource, const RAW: usize> SideBySide<S, RAW> {
    /// Splits a stream into two cameras.
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

    /// Returns the stream.
    pub fn source(&self) -> &S {
        &self.source
    }

    /// Releases the stream.
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

    /// The skew is 0: a row of both cameras is one line.
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

/// Two cameras interleaved in one stream: line 2 v is row v of the left one, line 2 v + 1 that of the right
/// one. The stream has to wait for its lines: a [`CameraError::WouldBlock`] between the two loses the row.
#[derive(Debug)]
pub struct Interleaved<S> {
    source: S,
    line_us: u32,
    before: Before,
}

/// What became of the line that was asked for last.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Before {
    /// It came, or the row that it ended is whole or reported.
    Came,
    /// It was a left one that is lost, and its row is reported: the right one of the row is next.
    LeftLost,
    /// It failed, and the row was reported: what is next may be the right one of the row.
    Failed,
}

impl<S: LineSource> Interleaved<S> {
    /// Splits a stream whose lines were exposed `line_us` microseconds apart: 0 for cameras that exposed
    /// together and are sent one after the other.
    pub fn new(source: S, line_us: u32) -> Result<Self, StreamError> {
        let height = source.format().height;
        if !height.is_multiple_of(2) {
            Err(StreamError::OddHeight { height })
        } else {
            Ok(Self { source, line_us, before: Before::Came })
        }
    }

    /// Releases the stream.
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
        self.before = Before::Came;
        self.source.start_frame()
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        let needed = self.format().line_bytes();
        if left.len().min(right.len()) < needed {
            return Err(CameraError::BufferTooShort { needed });
        }
        let before = self.before;
        let mut first = self.first(left);
        // The right line of a row that is reported is passed over, whether it comes or is lost, too.
        let is_of_reported = match (before, &first) {
            (Before::LeftLost | Before::Failed, Ok(line)) => line.row % 2 != 0,
            (Before::LeftLost, Err(CameraError::LineLost(_))) => true,
            _ => false,
        };
        if is_of_reported {
            self.before = Before::Came;
            first = self.first(left);
        }
        let first = first?;
        if first.row % 2 != 0 {
            return Err(CameraError::LineLost(LineFault::Dropped));
        }
        let second = self.source.next_line(right).inspect_err(|e| self.before = after(e, Before::Came))?;
        if second.row != first.row.saturating_add(1) {
            // It is of a row below. If that is a left line, its right one comes next, and is passed over
            // there.
            return Err(CameraError::LineLost(LineFault::Dropped));
        }
        Ok(LineStart { row: first.row / 2, ..first })
    }
}

impl<S: LineSource> Interleaved<S> {
    /// Reads a line where the left camera's is due.
    fn first(&mut self, left: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        let first = self.source.next_line(left);
        self.before = match &first {
            Ok(_) => Before::Came,
            Err(CameraError::WouldBlock) => self.before,
            Err(e) => after(e, Before::LeftLost),
        };
        first
    }
}

/// What an error leaves behind: `lost` where it is a line that is lost, and so counted; nothing where nothing
/// has changed.
fn after<E>(error: &CameraError<E>, lost: Before) -> Before {
    match error {
        CameraError::LineLost(_) => lost,
        CameraError::WouldBlock => Before::Came,
        _ => Before::Failed,
    }
}

/// A camera with mirrored lines, each reversed as it comes.
///
/// The order of rows cannot be reversed without a frame's memory: a sensor that is mounted upside down is set
/// to read out in reverse ([`Mt9v034::set_flips`](super::Mt9v034::set_flips)). Two cameras that are both
/// upside down need nothing: the disparities are right.
#[derive(Debug)]
pub struct Mirrored<S> {
    source: S,
}

impl<S: LineSource> Mirrored<S> {
    /// Mirrors a source; refused where pixels share bytes.
    pub fn new(source: S) -> Result<Self, StreamError> {
        match source.format().pixel.group() {
            (1, _) => Ok(Self { source }),
            _ => Err(StreamError::SharedBytes),
        }
    }

    /// Releases the source.
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
