//! The live path, row by row: camera, line windows, census, matching.
//!
//! In: lines of two cameras, pulled from a [`StereoSource`](crate::camera::StereoSource) or pushed by the caller. Out:
//! a [`Row`](crate::matching::Row) of disparities for every line, [`Pipeline::LATENCY`] lines later.
//!
//! * [`Pipeline`]: the memory and the order of the stages.
//! * [`Guarded`]: the same before cameras that fail, with [`FaultCounters`].
//! * [`PipelineError`], [`PushError`]: why there is no row, when lines are pulled and when they are pushed.
//!
//! Two cores share a frame as two pipelines, a band of rows each, and every row is bit-equal to that of one: a band sees
//! [`Pipeline::LATENCY`] lines more than it gives rows below, and above as many and one more for each answer that the
//! speckle filter asks for ([`Checks::speckle_pixels`](crate::matching::Checks::speckle_pixels)).

mod counters;
mod error;
mod guarded;
mod lines;
mod live;

pub use counters::FaultCounters;
pub use error::{PipelineError, PushError};
pub use guarded::Guarded;
pub use live::Pipeline;
