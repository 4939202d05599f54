//! Line sources: the traits that one camera and a stereo camera implement.

use super::{FrameStart, LineFormat, LineStart};
use core::fmt;

/// Hardware error type shared by the traits of a source.
pub trait ErrorType {
    /// Error of the bus, the DMA or the file.
    type Error: fmt::Debug;
}

impl<T: ErrorType + ?Sized> ErrorType for &mut T {
    type Error = T::Error;
}

/// Why a source delivered no line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CameraError<E> {
    /// The hardware failed; its own error is inside.
    Hardware(E),
    /// The caller's buffer is shorter than a line.
    BufferTooShort {
        /// Bytes that would have been enough.
        needed: usize,
    },
    /// No frame was started, or its last line is out; before the frame's height is reached, the frame was
    /// short.
    NoLineLeft,
    /// The next line is lost. The frame goes on: the next call gives the line below it.
    LineLost(LineFault),
    /// Nothing came within the source's time-out.
    TimedOut,
    /// There is nothing yet, and the source does not wait ([`PolledLines`](super::PolledLines)). Nothing has
    /// changed: ask again.
    WouldBlock,
    /// The position in the frame is unknown, or the sensor began another frame: this frame is over.
    LostSync,
}

/// What happened to a line that its source reports as lost.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LineFault {
    /// The line did not arrive, or found no free buffer.
    Dropped,
    /// The line was overwritten while it was read, or has too few or too many pixels.
    Torn,
    /// The line arrived too late to be used.
    Late,
    /// The buffer still holds an earlier line.
    Stale,
}

impl fmt::Display for LineFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Dropped => "a line was dropped",
            Self::Torn => "a line was torn",
            Self::Late => "a line came too late",
            Self::Stale => "a line was an old one",
        })
    }
}

impl<E> CameraError<E> {
    /// Converts the hardware error, for sources that wrap other sources.
    pub fn map_hardware<F>(self, convert: impl FnOnce(E) -> F) -> CameraError<F> {
        match self {
            Self::Hardware(e) => CameraError::Hardware(convert(e)),
            Self::BufferTooShort { needed } => CameraError::BufferTooShort { needed },
            Self::NoLineLeft => CameraError::NoLineLeft,
            Self::LineLost(fault) => CameraError::LineLost(fault),
            Self::TimedOut => CameraError::TimedOut,
            Self::WouldBlock => CameraError::WouldBlock,
            Self::LostSync => CameraError::LostSync,
        }
    }
}

impl<E: fmt::Display> fmt::Display for CameraError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hardware(e) => write!(f, "{e}"),
            Self::BufferTooShort { needed } => write!(f, "the line buffer must hold {needed} bytes"),
            Self::NoLineLeft => f.write_str("no line is left in this frame"),
            Self::LineLost(fault) => write!(f, "{fault}"),
            Self::TimedOut => f.write_str("the camera gave nothing in time"),
            Self::WouldBlock => f.write_str("the camera has nothing yet"),
            Self::LostSync => f.write_str("the sensor's frame broke off"),
        }
    }
}

impl<E: fmt::Display + fmt::Debug> core::error::Error for CameraError<E> {}

/// One camera, line by line.
///
/// The caller starts a frame and takes its lines in order, top to bottom, each into its own buffer. Between
/// two calls the hardware goes on: an implementation over DMA fills the next line while the caller works on
/// this one.
///
/// ```text
///              start_frame    next_line    next_line          next_line    start_frame
/// caller     ──┐          ┌┐            ┌┐            ┌─ ... ┐            ┌┐
///              └──────────┘└────────────┘└────────────┘      └────────────┘└──────────
///               waits for    copies row 0  copies row 1        row h - 1     waits for
///               frame sync                                                   frame sync
/// sensor     ──┬──────────┬─────────────┬─────────────┬─ ... ┬─────────────┬──────────
///   blanking   │ exposure │ row 0       │ row 1       │      │ row h - 1   │ blanking
///              └──────────┴─────────────┴─────────────┴─ ... ┴─────────────┴──────────
///                         ^ timestamp_us of the frame
///                         ^ row 0's     ^ row 1's timestamp_us
/// ```
///
/// Contract:
/// * [`format`](Self::format) does not change between two frames unless the caller asks the driver for it.
/// * [`start_frame`](Self::start_frame) may be called at any time; lines left of the frame before are
///   dropped.
/// * [`next_line`](Self::next_line) blocks until the line is whole, for a bounded time. It fills the first
///   [`LineFormat::line_bytes`] bytes of the buffer and leaves the rest. After an error the buffer's content
///   is meaningless.
/// * [`LineStart::row`] is the row that the sensor read out: after a lost line the number jumps. It grows
///   within a frame.
/// * A line belongs to the frame that was started. When the sensor begins another one before the last row,
///   `next_line` is [`CameraError::LostSync`], or [`CameraError::NoLineLeft`] where the frame was short.
/// * [`FrameStart::sequence`] grows with every frame, and time stamps do not run backwards: that exposes a
///   buffer which is delivered twice.
/// * After the last line, `next_line` is [`CameraError::NoLineLeft`] until a frame is started.
/// * A source that does not block gives [`CameraError::WouldBlock`] from both calls until the frame, or the
///   line, is there.
/// * After an error the caller may start the next frame, or ask for the next line. A source that can go on
///   within the frame reports the row; one that cannot fails again.
///
/// A fault that a source does not report may stay unseen: a torn line looks like any other. What shows from
/// outside, `pipeline::Guarded` counts by name.
pub trait LineSource: ErrorType {
    /// Size and pixel layout of the frames.
    fn format(&self) -> LineFormat;

    /// Waits for the start of the next frame.
    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>>;

    /// Takes the next line.
    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<Self::Error>>;
}

impl<T: LineSource + ?Sized> LineSource for &mut T {
    fn format(&self) -> LineFormat {
        (**self).format()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        (**self).start_frame()
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<Self::Error>> {
        (**self).next_line(line)
    }
}

/// Two cameras with aligned rows: a point in row v of the left image is in row v of the right one, at or left
/// of its column.
///
/// ```text
///            start_frame      next_lines       next_lines
/// left    ──┬──────────┬────────────────┬────────────────┬─ ...
///           │ exposure │ row 0          │ row 1          │
/// right   ──┴┬─────────┴┬───────────────┴┬───────────────┴┬─ ...
///            │ exposure │ row 0          │ row 1          │
///            └──────────┴────────────────┴────────────────┴─ ...
///           |<->| row skew: at most max_row_skew_us
/// ```
///
/// The contract of [`LineSource`] holds for the pair; both lines are of one row.
pub trait StereoSource: ErrorType {
    /// Size and pixel layout of both frames.
    fn format(&self) -> LineFormat;

    /// Upper bound on the time between the two cameras' read-outs of one row, microseconds.
    ///
    /// A point that moves at s px/s is displaced by at most s times this bound between the images, which is
    /// an error of its disparity. The bound is 0 for global-shutter cameras on one trigger, and for files.
    fn max_row_skew_us(&self) -> u32;

    /// Waits for the start of the next pair of frames.
    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>>;

    /// Takes the next row of both cameras.
    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>>;

    /// Writes the valid-pixel masks of a row, left and right, 1 or 0 per pixel, and returns whether it did;
    /// without masks, as by default, all pixels are valid. Rectified lines have invalid borders
    /// ([`RectifiedPair`](crate::imaging::RectifiedPair)).
    fn mask(&self, row: u16, masks: [&mut [u8]; 2]) -> bool {
        let _ = (row, masks);
        false
    }
}

impl<T: StereoSource + ?Sized> StereoSource for &mut T {
    fn format(&self) -> LineFormat {
        (**self).format()
    }

    fn max_row_skew_us(&self) -> u32 {
        (**self).max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        (**self).start_frame()
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        (**self).next_lines(left, right)
    }

    fn mask(&self, row: u16, masks: [&mut [u8]; 2]) -> bool {
        (**self).mask(row, masks)
    }
}
