//! The loops over the pixels of a row, for the usual numbers of candidates: in assembly, because the compiler
//! keeps too little of them in registers. They do what the loops of `super::columns` and `super::windows` do,
//! which are there for all other numbers.
//!
//! * `reverse`: the right codes from right to left.
//! * `tables`: costs into columns, by macros for a `column`.
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
#[macro_use]
mod column;
#[macro_use]
mod pixel;
mod reverse;
mod tables;
mod windows;

pub(super) use any::slide;
pub(super) use begin::{begin_block, begin_fast};
pub(super) use reverse::reverse;
pub(super) use tables::{
    add_low_16, add_low_16_of, add_low_32, add_low_32_of, add_low_48, add_low_48_of, add_low_64,
    add_low_64_of, take_high_16, take_high_16_of, take_high_32, take_high_32_of, take_high_48,
    take_high_48_of, take_high_64, take_high_64_of,
};
pub(super) use windows::{
    ACROSS, LANES, block_16, block_32, block_48, block_64, block_few, fast_16, fast_32, fast_48, fast_64,
    fast_few,
};
