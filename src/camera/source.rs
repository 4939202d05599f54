//! The two traits that a camera implements.

use super::{FrameStart, LineFormat, LineStart};
use core::fmt;

/// The error of the hardware below, stated once for all traits of a source.
pub trait ErrorType {
    /// What the bus, the DMA or the file says when it fails.
    type Error: fmt::Debug;
}

impl<T: ErrorType + ?Sized> ErrorType for &mut T {
    type Error = T::Error;
}

/// Why a source gave no line.
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
    /// A line was asked for before a frame was started, or after its last line: before the frame's height is
    /// reached, the sensor gave a short frame.
    NoLineLeft,
    /// The next line is lost. The frame goes on: the next call gives the line below it.
    LineLost(LineFault),
    /// Nothing came within the time that the source waits.
    TimedOut,
    /// Where the sensor is in its frame is not known, or it began another frame: this one is over.
    LostSync,
}

/// What happened to a line that its source knows to be lost.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LineFault {
    /// It did not come: sync was seen and no pixels, or it came to no free buffer.
    Dropped,
    /// It was overwritten while it was read, or has fewer or more pixels than a line.
    Torn,
    /// It came after the time at which it was of use.
    Late,
    /// The buffer holds a line of before: nobody has filled it since.
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
    /// The same error with what the hardware said put into another type: for sources that stand on other
    /// sources.
    pub fn map_hardware<F>(self, inside: impl FnOnce(E) -> F) -> CameraError<F> {
        match self {
            Self::Hardware(e) => CameraError::Hardware(inside(e)),
            Self::BufferTooShort { needed } => CameraError::BufferTooShort { needed },
            Self::NoLineLeft => CameraError::NoLineLeft,
            Self::LineLost(fault) => CameraError::LineLost(fault),
            Self::TimedOut => CameraError::TimedOut,
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
/// * [`start_frame`](Self::start_frame) may be called at any time; lines not taken from the frame before are
///   dropped.
/// * [`next_line`](Self::next_line) blocks until the line is whole, for a bounded time. It fills the first
///   [`LineFormat::line_bytes`] bytes of the buffer and leaves the rest. On an error the buffer's content
///   means nothing.
/// * [`LineStart::row`] is the row that the sensor read out, not how many lines were asked for: after a lost
///   line the number jumps, and who takes the lines sees that. It grows within a frame, until the next
///   `start_frame`.
/// * A line is of the frame that was started. When the sensor begins another one before the last row,
///   `next_line` is [`CameraError::LostSync`], or [`CameraError::NoLineLeft`] where the frame was short:
///   never a line of the other frame.
/// * [`FrameStart::sequence`] grows with every frame, and time stamps do not run backwards. A buffer that
///   nobody filled since is told by that, when it is handed out again.
/// * After the last line, `next_line` is [`CameraError::NoLineLeft`] until a frame is started.
/// * After an error the caller may start the next frame, or ask for the next line. A source that can go on
///   within the frame says where by the row's number; one that cannot fails again.
///
/// What a source knows and does not say, nobody behind it can tell: a torn line looks like a line. What can
/// be told from outside, `pipeline::Guarded` counts by name.
pub trait LineSource: ErrorType {
    /// The shape of the frames.
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

/// Two cameras whose rows are aligned: a point seen in row v of the left image is seen in row v of the right
/// one, at or left of its column.
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
/// The contract of [`LineSource`] holds for the pair: both lines are of one row, or there is an error.
pub trait StereoSource: ErrorType {
    /// The shape of both frames.
    fn format(&self) -> LineFormat;

    /// The bound on the row skew: how many microseconds may lie between the read-outs of one row by the two
    /// cameras.
    ///
    /// A point that moves across the image at s px/s can be displaced by this time times s between the two
    /// images, which is an error of its disparity; 0 for global-shutter cameras on one trigger, and for
    /// files.
    fn max_row_skew_us(&self) -> u32;

    /// Waits for the start of the next pair of frames.
    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>>;

    /// Takes the next row of both cameras.
    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>>;

    /// Writes which pixels of a row the left and the right camera saw, 1 or 0 for each, and says that it did;
    /// or says that they saw all, as cameras do by themselves. Rectified lines have borders that nothing
    /// was seen of ([`RectifiedPair`](crate::imaging::RectifiedPair)).
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
