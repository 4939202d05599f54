//! Cameras: the traits that a line source implements, adapters that make one stereo source of two cameras,
//! and sensor drivers.
//!
//! In: hardware, a file or a rendered scene. Out: lines of pixels in the caller's buffer, one by one.
//!
//! * [`LineFormat`], [`FrameStart`], [`LineStart`]: the description of frames and lines.
//! * [`LineSource`]: one camera. [`StereoSource`]: a rectified pair.
//! * [`LineSlots`]: a queue of lines from an interrupt or DMA to the matcher; [`HandedLines`] is the line
//!   source at its end. [`PingPong`]: the halves of a circular DMA buffer.
//! * [`LineSignal`]: wakes the task that awaits those lines; [`PolledLines`] is its line source.
//! * [`CameraPair`]: two line sources as a stereo source, checked row by row, with its [`RowSkew`].
//! * [`SideBySide`], [`Interleaved`]: one stream that carries both cameras. [`Mirrored`]: lines reversed.
//! * [`Triggered`]: pulses the sensors' common trigger pin before every frame.
//! * [`Mt9v034`], [`Hm01b0`]: sensors over I2C. [`ExposureControl`]: a sensor's exposure and gain.
//!
//! # Writing a camera
//!
//! Implement [`LineSource`], or [`StereoSource`] where one piece of hardware delivers both lines. The
//! contract stands at the trait; the hardware decides how:
//!
//! | hardware | implementation |
//! | --- | --- |
//! | parallel port, DMA per line | [`LineProducer::begin`] and `finish` in the interrupt; [`HandedLines`] |
//! | circular DMA over two lines | [`PingPong::take`] in both interrupts, into a slot |
//! | PIO of an RP2040 or RP2350 | DMA as above; two sensors on one program are [`SideBySide`] |
//! | SPI sensor | `next_line` reads a line; nothing waits |
//! | FPGA that writes lines into memory | `next_line` copies; the FPGA's counter is [`LineStart::row`] |
//!
//! Report faults by name ([`CameraError`], [`LineFault`]): a line known to be lost is
//! [`CameraError::LineLost`], and the frame goes on; a wait ends with [`CameraError::TimedOut`]. Number rows
//! and frames as the sensor does: `pipeline::Guarded` finds unreported faults by these numbers and by time
//! stamps.
//!
//! A source that never blocks gives [`CameraError::WouldBlock`] where a line is still to come, so that a task
//! can await rows (`Pipeline::next_row_async`). [`SideBySide`], [`Mirrored`], `BalancedPair` and
//! `RectifiedPair` may stand above such a source. [`CameraPair`], [`Interleaved`] and [`Triggered`] do two
//! things in one call and need sources that wait.
//!
//! # Writing a sensor driver
//!
//! Follow [`Mt9v034`] and [`Hm01b0`]: the bus by value, delay and reset pin where they are needed, limits
//! checked before the bus is touched, the identity read first, the bus's own error inside [`SensorError`]. A
//! driver configures the sensor and has no part in where pixels go. [`ExposureControl`] lets both cameras
//! share one exposure.
//!
//! # Writing the application
//!
//! Connect a source to a [`pipeline`](crate::pipeline). Two sensors on one trigger pin are
//! `Triggered<CameraPair<...>>` where they take a pulse and their numbers count pulses; free-running sensors
//! are paired by time stamps ([`Pairing::TimeStamp`]) and their row skew is measured
//! ([`CameraPair::row_skew`]).

mod format;
mod handed;
mod handoff;
mod pair;
mod ping_pong;
mod polled;
mod queue;
mod sensors;
mod signal;
mod skew;
mod source;
mod streams;
mod sync;
mod trigger;

pub use format::{FrameStart, LineFormat, LineStart, PixelFormat};
pub use handed::HandedLines;
pub use handoff::{EmptyLine, FilledLine, LineConsumer, LineProducer, LineSlots};
pub use pair::{CameraPair, PairError, Pairing};
pub use ping_pong::{Half, PingPong};
pub use polled::PolledLines;
#[cfg(feature = "ffi")]
pub(crate) use queue::Positions;
#[cfg(feature = "async")]
pub use sensors::{AsyncHm01b0, AsyncMt9v034};
pub use sensors::{
    ExposureControl, GainSteps, Hm01b0, Hm01b0Mode, Hm01b0Size, Mt9v034, Mt9v034Binning, Mt9v034Mode,
    Mt9v034Pattern, Mt9v034Window, SensorError,
};
pub use signal::{LineListener, LineNotifier, LineSignal};
pub use skew::RowSkew;
pub use source::{CameraError, ErrorType, LineFault, LineSource, StereoSource};
pub use streams::{Interleaved, Mirrored, SideBySide, StreamError};
pub use trigger::{TriggerError, Triggered};
