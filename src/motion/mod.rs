//! Motion.

pub mod bundle;
