//! The live path, row by row: camera, line windows, census, matching.
//!
//! In: lines of two cameras, pulled from a [`StereoSource`](crate::camera::StereoSource) or pushed by the caller. Out:
//! a [`Row`](crate::matching::Row) of disparities for every line, [`Pipeline::LATENCY`] lines later.
//!
//! * [`Pipeline`]: the memory and the order of the stages.
//! * [`PipelineError`], [`PushError`]: why there is no row, when lines are pulled and when they are pushed.

mod error;
mod live;

pub use error::{PipelineError, PushError};
pub use live::Pipeline;
