//! The repository's own rules.
//!
//! * `house`: short files, no panics, a tidy root.
//! * `layering`: data moves down the list of modules. `circles`: no circle and no upward arrow inside a
//!   module.
//! * `readme`: its commands work and its figures are current. `firmware`: the example's parts without
//!   hardware. `pio`: a board's program for its pins. `components`: what others' build systems read.
//! * `derives`: what firmware expects of every public type. `features`: how conditions name them.
//! * `lines`, `comments`, `names`: what a reader meets: line lengths, doc comments that stand alone, unique
//!   public names.
//! * `stages`: the matcher's list of them beside what is called.
//! * `source`: the files, for the others. `paths`: what a file names.

mod circles;
mod comments;
mod components;
mod derives;
mod features;
mod firmware;
mod house;
mod layering;
mod lines;
mod names;
mod paths;
mod pio;
mod readme;
mod source;
mod stages;
