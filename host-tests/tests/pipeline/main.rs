//! The live path.
//!
//! * `bands`: a frame in bands.
//! * `push`: lines that the caller pushes; `waited`: rows that a task awaits.
//! * `faults`: the pipeline before a source with every fault, held against the injector's record; `changing`:
//!   that source.

mod bands;
mod changing;
mod faults;
mod push;
mod waited;
mod winners;
