//! The loops over the pixels of a row, for the usual numbers of candidates: in assembly, because the compiler
//! keeps too little of them in registers. They do what the loops of `super::columns` and `super::windows` do,
//! which are there for all other numbers.
//!
//! * `reverse`: the right codes from right to left.
//! * `tables`, `bits`: costs into columns.
//! * `begin`: the sums of the first windows; `windows`: columns into windows and winners, by macros for a
//!   `pixel`.
#![allow(unsafe_code)]

/// What is done for the first of two pixels in a round, and left out where a round has one.
macro_rules! if_twice {
    (1, $lines:expr) => {
        ""
    };
    (2, $lines:expr) => {
        $lines
    };
}

mod any;
mod begin;
mod bits;
#[macro_use]
mod pixel;
mod reverse;
mod tables;
mod windows;

pub(super) use any::{by_bits, slide};
pub(super) use begin::{begin_block, begin_fast};
pub(super) use bits::{by_bits_16, by_bits_32, by_bits_48, by_bits_64};
pub(super) use reverse::reverse;
pub(super) use tables::{by_tables_16, by_tables_32, by_tables_48, by_tables_64};
pub(super) use windows::{
    ACROSS, block_16, block_32, block_48, block_64, block_few_of_16, block_few_of_32, block_few_of_48,
    block_few_of_64, block_fewest_of_32, block_fewest_of_48, block_fewest_of_64, fast_16, fast_32, fast_48,
    fast_64, fast_few_of_16, fast_few_of_32, fast_few_of_48, fast_few_of_64, fast_fewest_of_32,
    fast_fewest_of_48, fast_fewest_of_64,
};
