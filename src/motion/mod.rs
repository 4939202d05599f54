//! How cameras move, and what they see on the way.
//!
//! In: pictures of one camera or of a rectified pair, one moment after the other, with their features; or
//! observations of points that somebody matched. Out: where the cameras stand, and where the points are.
//!
//! * [`bundle`]: bundle adjustment: views and points until what was seen agrees with them best.
//! * [`odometry`]: from frame to frame, as they come.
//! * [`structure`]: where cameras stand and where points are, from what they see alone.

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "`!(a > b)` refuses what is not a number together with what is too small"
)]

pub mod bundle;
pub mod odometry;
pub mod structure;
