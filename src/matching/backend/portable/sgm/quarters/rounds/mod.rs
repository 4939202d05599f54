//! What is done to each word of a pixel's columns, four words in a round: all the instructions that grow with
//! the number of disparities.
//!
//! A Cortex-M3, whose registers do not suffice for what the compiler makes of a round, has them in assembly.
//! An RV32 with products has whole rows of pixels in assembly (`rv32`), and takes only the winner of these.

#[allow(dead_code, reason = "a Cortex-M3 has all of it itself, an RV32 most")]
mod plain;
#[cfg(stereopsis_thumb2)]
mod thumb2;

#[cfg(not(stereopsis_thumb2))]
use plain as chosen;
#[cfg(stereopsis_thumb2)]
use thumb2 as chosen;

#[allow(unused_imports, reason = "an RV32 has the others itself")]
pub(super) use chosen::{along, average_two, down, enter, winner};
