//! Disparity to depth, with its uncertainty.
//!
//! In: disparities and a rectified rig. Out: millimetres without a floating-point unit, metres, points in the
//! left camera's frame.
//!
//! * [`DepthScale`]: `Z = f b / (d + doffs)` and `sigma_Z = Z^2 / (f b) sigma_d`.
//! * [`DepthRange`]: the nearest and the farthest depth that a search range can tell, and the error there.
//! * [`DepthTable`]: depths looked up, for cores that cannot divide.
//! * [`TemporalFilter`]: answers averaged over frames, and held where they fail, each with its
//!   [`Provenance`].
//! * [`Decimator`]: rows made smaller by medians of blocks.
//! * `DisparityColours`, with the feature `embedded-graphics`: rows on a display.
//! * [`Depth`]: a depth with its deviation, also by focus; [`fuse`]: two maps as one.
//!
//! How sure a depth is has two parts. [`DepthScale::sigma`] is how exact it is if the answer is right, of
//! [`Row::sigma_px`](crate::matching::Row::sigma_px). Whether it is right is what
//! [`Row::confidences`](crate::matching::Row::confidences) tell: leave out the least sure, and believe the
//! deviations of the others.

mod decimate;
#[cfg(feature = "embedded-graphics")]
mod draw;
mod estimate;
mod range;
mod scale;
mod table;
mod temporal;

pub use decimate::Decimator;
#[cfg(feature = "embedded-graphics")]
pub use draw::DisparityColours;
pub use estimate::{Depth, fuse};
pub use range::DepthRange;
pub use scale::{DepthError, DepthScale};
pub use table::{DepthTable, TableError};
pub use temporal::{Provenance, TemporalConfig, TemporalFilter};
