//! Depth from disparity, with its standard deviation.
//!
//! In: disparities and a rectified rig. Out: millimetres without a floating-point unit, metres, points in the
//! left camera's frame.
//!
//! * [`DepthScale`]: `Z = f b / (d + doffs)` and `sigma_Z = Z^2 / (f b) sigma_d`.
//! * [`DepthRange`]: the nearest and the farthest depth of a search range, with their standard deviations.
//! * [`DepthTable`]: a look-up table of depths, for cores that cannot divide.
//! * [`TemporalFilter`]: answers averaged over frames, and held where they are missing, each with its
//!   [`Provenance`].
//! * [`Decimator`]: rows downsampled by the median of blocks.
//! * `DisparityColours`, with the feature `embedded-graphics`: rows on a display.
//! * [`Depth`]: a depth with its standard deviation, from stereo or focus; [`fuse`]: two depth maps as one.
//!
//! Uncertainty has two parts. [`DepthScale::sigma`] is the precision of a right answer, from
//! [`Row::sigma_px`](crate::matching::Row::sigma_px); [`Row::confidences`](crate::matching::Row::confidences)
//! rank answers by how likely they are right. Leave out the least confident, and trust the deviations of the
//! others.

mod decimate;
#[cfg(feature = "embedded-graphics")]
mod draw;
mod estimate;
mod range;
mod scale;
mod table;
mod temporal;

#[cfg(feature = "ffi")]
pub(crate) use decimate::shrink;
pub use decimate::{Decimator, DecimatorView};
#[cfg(feature = "embedded-graphics")]
pub use draw::DisparityColours;
pub use estimate::{Depth, fuse};
pub use range::DepthRange;
pub use scale::{DepthError, DepthScale};
pub use table::{DepthTable, TableError};
pub use temporal::{Provenance, TemporalConfig, TemporalFilter, TemporalFilterView, TemporalMemoryError};
