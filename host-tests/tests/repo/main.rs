//! The repository's own rules.
//!
//! * `house`: short files, no panics, a tidy root. `layering`: data moves down the list of modules.
//! * `readme`: its commands work and its figures are current. `firmware`: the example's parts without hardware.
//! * `source`: the files, for the others.

mod firmware;
mod house;
mod layering;
mod readme;
mod source;
