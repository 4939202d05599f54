//! How cameras move, and what they see on the way.
//!
//! * [`bundle`]: bundle adjustment: views and points until what was seen agrees with them best.
//! * [`structure`]: where cameras stand and where points are, from what they see alone.

pub mod bundle;
pub mod structure;
