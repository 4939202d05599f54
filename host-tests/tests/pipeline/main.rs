//! The live path.
//!
//! * `bands`: a frame in bands.
//! * `push`: lines that the caller pushes; `waited`: rows that a task awaits.
//! * `faults`: the pipeline before a source with every fault, held against the injector's record; `changing`:
//!   that source; `unsure`: faults where answers are refused as unsure.

mod bands;
mod changing;
mod faults;
mod push;
mod unsure;
mod waited;
mod winners;
