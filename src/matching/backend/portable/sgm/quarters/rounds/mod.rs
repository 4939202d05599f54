//! What is done to each word of a pixel's columns, four words in a round: all the instructions that grow with
//! the number of disparities.
//!
//! Arm's Thumb-2 without instructions on bytes (Cortex-M3) has its rounds in assembly, which is less than half
//! of the code: the compiler puts a third of what a round holds on the stack, if it does not unroll it.

#[cfg(any(not(stereopsis_thumb2), test))]
mod plain;
#[cfg(stereopsis_thumb2)]
mod thumb2;

#[cfg(not(stereopsis_thumb2))]
pub(super) use plain::{along, average_two, down, enter, winner};
#[cfg(stereopsis_thumb2)]
pub(super) use thumb2::{along, average_two, down, enter, winner};
