//! The repository's own rules.
//!
//! * `house`: short files, no panics, a tidy root. `layering`: data moves down the list of modules.
//! * `readme`: its commands work and its figures are current. `firmware`: the example's parts without
//!   hardware.
//! * `lines`, `comments`, `names`: what a reader meets: line lengths, doc comments that stand alone, unique
//!   public names.
//! * `source`: the files, for the others.

mod comments;
mod firmware;
mod house;
mod layering;
mod lines;
mod names;
mod readme;
mod source;
