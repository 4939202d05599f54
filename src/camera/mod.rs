//! Where lines come from: the traits that a camera implements, and what joins two cameras into a stereo source.
//!
//! In: hardware, a file or a rendered scene. Out: lines of pixels in the caller's buffer, one by one.
//!
//! * [`LineFormat`], [`FrameStart`], [`LineStart`]: what is known about lines and frames.
//! * [`LineSource`]: one camera. [`StereoSource`]: a rectified pair.
//! * [`CameraPair`]: two line sources as a stereo source, checked row by row.
//! * [`SideBySide`], [`Interleaved`]: one stream that carries both cameras, in halves of a line or line by line. [`Mirrored`]:
//!   lines from right to left.
//! * [`LineSlots`]: lines from an interrupt or DMA to the matcher, by value; [`HandedLines`] is the camera on the matcher's side.
//!   [`PingPong`]: the halves of a circular DMA buffer.
//! * [`Mt9v034`], [`Hm01b0`]: sensors over I2C. [`ExposureControl`]: what an automatic exposure asks of one.
//! * [`Triggered`]: pulses the sensors' common trigger pin before every frame.

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
pub use sensors::{
    ExposureControl, Hm01b0, Hm01b0Mode, Hm01b0Size, Mt9v034, Mt9v034Mode, Mt9v034Pattern, Mt9v034Window, SensorError,
};
pub use source::{CameraError, ErrorType, LineFault, LineSource, StereoSource};
pub use streams::{Interleaved, Mirrored, SideBySide, StreamError};
pub use trigger::{TriggerError, Triggered};
