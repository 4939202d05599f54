//! The live path.
//!
//! * `push`: lines that the caller pushes; `waited`: rows that a task awaits.
//! * `faults`: the pipeline before a source with every fault, held against the injector's record; `changing`:
//!   that source.

mod changing;
mod faults;
mod push;
mod waited;
