//! Where lines come from: the traits that a camera implements, what joins two cameras into a stereo source,
//! and the sensors' drivers.
//!
//! In: hardware, a file or a rendered scene. Out: lines of pixels in the caller's buffer, one by one.
//!
//! * [`LineFormat`], [`FrameStart`], [`LineStart`]: what is known about lines and frames.
//! * [`LineSource`]: one camera. [`StereoSource`]: a rectified pair.
//! * [`LineSlots`]: lines from an interrupt or DMA to the matcher, by value; [`HandedLines`] is the camera on
//!   the matcher's side. [`PingPong`]: the halves of a circular DMA buffer.
//! * [`CameraPair`]: two line sources as a stereo source, checked row by row, with its [`RowSkew`].
//! * [`SideBySide`], [`Interleaved`]: one stream that carries both cameras, in halves of a line or line by
//!   line. [`Mirrored`]: lines from right to left.
//! * [`Triggered`]: pulses the sensors' common trigger pin before every frame.
//! * [`Mt9v034`], [`Hm01b0`]: sensors over I2C. [`ExposureControl`]: what an automatic exposure asks of one.
//!
//! # Who writes a camera
//!
//! implements [`LineSource`], or [`StereoSource`] where one piece of hardware brings both lines. The contract
//! stands at the trait. What hardware does decides how:
//!
//! | hardware | way |
//! | --- | --- |
//! | parallel port with DMA, a line to a transfer | in the transfer's interrupt, [`LineProducer::begin`] gives the next slot to the DMA and [`LineProducer::finish`] hands the last one on; [`HandedLines`] is the source |
//! | circular DMA over two lines | [`PingPong::take`] in both interrupts, into a slot |
//! | PIO of an RP2040 or RP2350 | as the first, with the DMA of the state machine; of both sensors on one program, [`SideBySide`] |
//! | SPI sensor | `next_line` reads a line; nothing waits |
//! | an FPGA that writes lines into memory | `next_line` looks at its counter and copies; the counter is [`LineStart::row`] |
//!
//! Tell faults by their names ([`CameraError`], [`LineFault`]): a line that is known to be lost is
//! [`CameraError::LineLost`], and the frame goes on; a wait that is over is [`CameraError::TimedOut`], never
//! a wait without an end. Give rows the numbers that the sensor gave them, and frames theirs: whatever is not
//! said, `pipeline::Guarded` finds by these and by time stamps.
//!
//! # Who writes a driver of a sensor
//!
//! looks at [`Mt9v034`] and [`Hm01b0`]: the bus by value, delay and reset pin where they are needed, limits
//! looked at before the bus is touched, the identity asked first, errors with the bus's own inside
//! ([`SensorError`]). A driver says what the sensor does and when a setting counts; it has no part in where
//! pixels go. With [`ExposureControl`] it takes part in one exposure for both cameras.
//!
//! # Who writes the application
//!
//! joins a source to a pipeline: see there. Two sensors on one trigger pin are `Triggered<CameraPair<...>>`;
//! sensors that run freely are paired by time stamps ([`Pairing::TimeStamp`]) and their row skew is measured
//! ([`CameraPair::row_skew`]).

mod format;
mod handoff;
mod pair;
mod ping_pong;
mod sensors;
mod source;
mod streams;
mod trigger;

pub use format::{FrameStart, LineFormat, LineStart, PixelFormat};
pub use handoff::{EmptyLine, FilledLine, HandedLines, LineConsumer, LineProducer, LineSlots};
pub use pair::{CameraPair, PairError, Pairing, RowSkew};
pub use ping_pong::{Half, PingPong};
#[cfg(feature = "async")]
pub use sensors::{AsyncHm01b0, AsyncMt9v034};
pub use sensors::{
    ExposureControl, Hm01b0, Hm01b0Mode, Hm01b0Size, Mt9v034, Mt9v034Mode, Mt9v034Pattern, Mt9v034Window,
    SensorError,
};
pub use source::{CameraError, ErrorType, LineFault, LineSource, StereoSource};
pub use streams::{Interleaved, Mirrored, SideBySide, StreamError};
pub use trigger::{TriggerError, Triggered};
