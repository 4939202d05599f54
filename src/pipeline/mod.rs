//! The live path, row by row: camera, line windows, matcher.
//!
//! In: lines of two cameras, pulled from a [`StereoSource`](crate::camera::StereoSource) or pushed by the
//! caller. Out: a [`Row`](crate::matching::Row) of disparities per line, [`Pipeline::LATENCY`] lines later.
//!
//! * [`Pipeline`]: line windows and matcher in one block of memory.
//! * [`Guarded`]: a pipeline that tolerates camera faults, with [`FaultCounters`].
//! * [`Band`]: a frame in bands of rows, for pipelines on several cores.
//! * [`winners`]: rows of winners that a device computes, in place of the matcher's own.
//! * [`PipelineError`], [`PushError`]: why there is no row, when lines are pulled and when they are pushed.
//!
//! ```text
//! for every row y of a frame, `next_row` (pulled) or `push` and `flush` (pushed):
//!   1. lines up to y + 2   camera -> both line windows; a lost line is replaced by the one above (Guarded)
//!   2. match row y         the five rows around y of both windows -> matcher
//!   3. row y - DELAY       matcher -> Row of disparities, flags and confidences
//!   4. mask                answers at pixels that a camera did not see are removed
//!   5. mark                rows that depend on a lost line are flagged (Guarded)
//! ```
//!
//! # Camera faults
//!
//! A [`Pipeline`] gives correct rows up to the first error, and goes on with the next frame. A [`Guarded`]
//! goes on within the frame. Whatever the source does, both guarantee:
//!
//! * no panic, and no wait but the source's own;
//! * a row is bit-exact for its lines; a row that depends on a lost line is flagged by [`Guarded`], and
//!   withheld by [`Pipeline`];
//! * the next whole frame is as good as the first;
//! * every detectable fault is counted once, by name ([`FaultCounters`]).
//!
//! | fault | detected by |
//! | --- | --- |
//! | dropped, torn or late line; bus error; time-out | the source's report |
//! | skipped or repeated line, lost sync | row number |
//! | stale line or frame | time stamp, sequence number ([`Guarded`], [`CameraPair`]) |
//! | short frame | no line is left |
//! | dead camera | time-outs, bounded by [`Guarded::set_most_lost`] |
//! | bad picture, swapped cameras, unequal gain | [`PairMonitor`], per frame; no row is flagged |
//! | unreported torn line, single stuck pixels | not detected |
//!
//! [`CameraPair`]: crate::camera::CameraPair
//! [`PairMonitor`]: crate::imaging::PairMonitor
//!
//! # In a task
//!
//! With a source that does not block ([`PolledLines`](crate::camera::PolledLines)) a task of any executor
//! awaits rows by [`Pipeline::next_row_async`] and [`Guarded::next_row_async`]. Without an executor, the
//! blocking calls give [`CameraError::WouldBlock`](crate::camera::CameraError::WouldBlock), after which the
//! frame goes on: the same call is repeated when a line is there.
//!
//! # In an application
//!
//! Optional stages stand before and after the pipeline: [`RectifiedPair`](crate::imaging::RectifiedPair) for
//! raw lines, [`PairMonitor`] and [`AutoExposure`](crate::imaging::AutoExposure) beside the lines;
//! [`TemporalFilter`](crate::depth::TemporalFilter) and [`Decimator`](crate::depth::Decimator) on the rows.
//!
//! ```
//! use stereopsis::camera::StereoSource;
//! use stereopsis::depth::{Decimator, Provenance, TemporalConfig, TemporalFilter};
//! use stereopsis::matching::Fast;
//! use stereopsis::pipeline::{Guarded, PipelineError};
//! use stereopsis::units::Disparity;
//!
//! /// Shows a frame of a camera that may fail, filtered over time and downsampled.
//! fn frame<C: StereoSource>(
//!     camera: &mut C,
//!     pipeline: &mut Guarded<Fast, 160, 32>,
//!     steady: &mut TemporalFilter<160, 120>,
//!     small: &mut Decimator<160, 2>,
//!     mut show: impl FnMut(usize, &[Disparity]),
//! ) -> Result<(), PipelineError<C::Error>> {
//!     pipeline.begin_frame(camera)?;
//!     small.begin();
//!     while let Some(row) = pipeline.next_row(camera)? {
//!         let (mut answers, mut provenance) = ([Disparity::NONE; 160], [Provenance::Nothing; 160]);
//!         steady.row(row.index().into(), row.disparities(), &mut answers, &mut provenance);
//!         let mut out = [Disparity::NONE; 80];
//!         if let Some(y) = small.push(&answers, &mut out) {
//!             show(y, &out);
//!         }
//!     }
//!     Ok(())
//! }
//! # let _ = TemporalFilter::<160, 120>::new(TemporalConfig::default());
//! ```
//!
//! Two cores can share a frame as two pipelines with a [`Band`] of rows each.

mod band;
mod counters;
mod error;
mod guarded;
mod lines;
mod reach;
mod live;
mod waited;
pub mod winners;

pub use band::{Band, Bands};
pub use counters::FaultCounters;
pub use error::{PipelineError, PushError};
pub use guarded::Guarded;
pub use live::Pipeline;
