//! How cameras move, and what they see on the way.
//!
//! In: pictures of one camera or of a rectified pair, one moment after the other, with their features. Out: where the
//! camera stands.
//!
//! * [`odometry`]: from frame to frame, as they come.

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "`!(a > b)` refuses what is not a number together with what is too small"
)]

pub mod odometry;
