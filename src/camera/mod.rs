//! Where lines come from: the traits that a camera implements, and what joins two cameras into a stereo source.
//!
//! In: hardware, a file or a rendered scene. Out: lines of pixels in the caller's buffer, one by one.
//!
//! * [`LineFormat`], [`FrameStart`], [`LineStart`]: what is known about lines and frames.
//! * [`LineSource`]: one camera. [`StereoSource`]: a rectified pair.
//! * [`CameraPair`]: two line sources as a stereo source, checked row by row.
//! * [`Triggered`]: pulses the sensors' common trigger pin before every frame.

mod format;
mod pair;
mod source;
mod trigger;

pub use format::{FrameStart, LineFormat, LineStart, PixelFormat};
pub use pair::{CameraPair, PairError};
pub use source::{CameraError, ErrorType, LineSource, StereoSource};
pub use trigger::{TriggerError, Triggered};
