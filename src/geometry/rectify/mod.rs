//! Rectification: from two cameras as they are mounted to two whose rows are aligned.
//!
//! In: a [`StereoRig`](super::camera::StereoRig). Out: a [`Rectification`] of it.
//!
//! 1. `align`: the rotations of both cameras into one frame.
//! 2. `crop`: the camera that both rectified images are of.
//! 3. [`Warp`]: where each rectified pixel comes from.
//! 4. [`RectificationReport`]: what is left and what it costs.
//! 5. [`RowMeter`]: while the cameras run, whether the rows still agree, and [`Rectification::corrected`]
//!    where they do not.
//!
//! [`UncalibratedRectification`]: the same from matches alone, without metric depth.

mod warp;
mod config;
mod align;
mod crop;
mod rectification;
mod report;
mod alignment;
mod uncalibrated;

pub use alignment::{RowAlignment, RowHealth, RowMeter, RowMeterError};
pub use config::{Axis, Crop, RectifyError};
pub use rectification::Rectification;
pub use report::RectificationReport;
pub use uncalibrated::{UncalibratedError, UncalibratedRectification};
pub use warp::{Warp, WarpSource};
