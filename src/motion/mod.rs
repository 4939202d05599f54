//! How cameras move, and what they see on the way.
//!
//! * [`bundle`]: bundle adjustment: views and points until what was seen agrees with them best.
//! * [`structure`]: where cameras stand and where points are, from what they see alone.

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "`!(a > b)` refuses what is not a number together with what is too small"
)]

pub mod bundle;
pub mod structure;
