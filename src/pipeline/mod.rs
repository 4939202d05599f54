//! The live path, row by row: camera, line windows, census, matching.
//!
//! In: lines of two cameras, pulled from a [`StereoSource`](crate::camera::StereoSource) or pushed by the
//! caller. Out: a [`Row`](crate::matching::Row) of disparities for every line, [`Pipeline::LATENCY`] lines
//! later.
//!
//! * [`Pipeline`]: the memory and the order of the stages.
//! * [`Guarded`]: the same before cameras that fail, with [`FaultCounters`].
//! * [`PipelineError`], [`PushError`]: why there is no row, when lines are pulled and when they are pushed.
//!
//! # With cameras that fail
//!
//! A [`Pipeline`] gives right rows up to the first error, and after an error the next frame. A [`Guarded`]
//! goes on within the frame. What both promise, whatever the source does:
//!
//! * no panic, and no wait but the source's own;
//! * a row that comes out is, to the bit, what its lines give; a row that rests on a line that did not come
//!   has a flag (from [`Guarded`]), or does not come out (from [`Pipeline`]);
//! * the next whole frame is as good as the first;
//! * every fault that can be seen is counted once, by its name ([`FaultCounters`]).
//!
//! | fault | how it is seen |
//! | --- | --- |
//! | dropped, torn, late line; bus error; time-out | the source says so |
//! | line passed over, line once more, lost sync | the row's number |
//! | line or frame of before | time stamp, sequence number (from [`Guarded`] and [`CameraPair`](crate::camera::CameraPair)) |
//! | short frame | no line is left |
//! | dead camera | time-outs; [`Guarded::set_most_lost`] bounds them |
//! | black, saturated, flat or hanging picture, swapped cameras, unequal gain | [`PairMonitor`](crate::imaging::PairMonitor), of a frame; no row is flagged |
//! | torn line that nobody tells, single stuck pixels | not at all: the first looks like a line, the second like a dot |
//!
//! # In an application
//!
//! Optional stages stand before and after, row by row: [`RectifiedPair`](crate::imaging::RectifiedPair) for
//! raw lines, [`PairMonitor`](crate::imaging::PairMonitor) and [`AutoExposure`](crate::imaging::AutoExposure)
//! beside the lines; [`TemporalFilter`](crate::depth::TemporalFilter) and
//! [`Decimator`](crate::depth::Decimator) on the rows.
//!
//! ```
//! use stereopsis::camera::StereoSource;
//! use stereopsis::depth::{Decimator, Provenance, TemporalConfig, TemporalFilter};
//! use stereopsis::matching::Fast;
//! use stereopsis::pipeline::{Guarded, PipelineError};
//! use stereopsis::units::Disparity;
//!
//! /// A frame of a camera that may fail: held over a frame or two, a fourth as large.
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
//! Two cores share a frame as two pipelines, a band of rows each, and every row is bit-equal to that of one:
//! a band sees [`Pipeline::LATENCY`] lines more than it gives rows below, and above as many and one more for
//! each answer that the speckle filter asks for
//! ([`Checks::speckle_pixels`](crate::matching::Checks::speckle_pixels)).

mod counters;
mod error;
mod guarded;
mod lines;
mod live;

pub use counters::FaultCounters;
pub use error::{PipelineError, PushError};
pub use guarded::Guarded;
pub use live::Pipeline;
