//! The live path.
//!
//! * `bands`: a frame in bands.
//! * `push`: lines that the caller pushes; `waited`: rows that a task awaits.
//! * `faults`: the pipeline before a source with every fault, held against the injector's record; `changing`:
//!   that source; `unsure`: faults where answers are refused as unsure.
//! * `numbers`: frame numbers, row numbers and time stamps by hand.
//! * `winners`: rows from a model of the block of gates; `due`: which of them comes next; `mapped`: the same
//!   behind registers in memory and a ring.

mod bands;
mod changing;
mod due;
mod faults;
mod mapped;
mod numbers;
mod push;
mod unsure;
mod waited;
mod winners;
