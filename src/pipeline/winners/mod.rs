//! Rows from a device that computes winners: a block of gates, or another core.
//!
//! In: a [`WinnerSource`], and the left camera's lines where a check looks at them. Out: the rows that a
//! [`Pipeline`](super::Pipeline) of the same method gives, to the bit.
//!
//! * [`WinnerSource`]: the trait of such a device, with [`WinnerSearch`], what it is asked for, and
//!   [`WinnerError`].
//! * [`WinnerRegisters`]: the device of `examples/fpga` behind its registers and a ring of records, on any
//!   [`RegisterBus`]; [`MappedBlock`] is that bus where both stand in the address space, with the
//!   [`BlockDma`] channels that fill the ring.
//! * [`WinnerPipeline`]: rows of winners into rows of disparities, or a [`WinnerPipelineError`].

mod source;
mod error;
mod registers;
mod mapped;
mod pipeline;

pub use error::WinnerPipelineError;
pub use mapped::{BlockDma, MappedBlock};
pub use pipeline::WinnerPipeline;
pub use registers::{Register, RegisterBus, WinnerRegisters, status};
pub use source::{WinnerError, WinnerSearch, WinnerSource};
