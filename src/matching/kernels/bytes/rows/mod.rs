//! The loops over the pixels of a row, for the usual numbers of candidates: in assembly, because the compiler keeps too little
//! of them in registers. They do what the loops of `super::columns` and `super::windows` do, which are there for all other
//! numbers.
//!
//! * `columns`: costs into columns.
//! * `windows`: columns into windows and winners.
#![allow(unsafe_code)]

mod columns;
mod windows;

pub(super) use columns::{
    by_bits_16, by_bits_32, by_bits_48, by_bits_64, by_tables_16, by_tables_32, by_tables_48, by_tables_64,
};
pub(super) use windows::{
    ACROSS, block_16, block_32, block_48, block_64, block_few_of_16, block_few_of_32, block_few_of_48, block_few_of_64,
    fast_16, fast_32, fast_48, fast_64, fast_few_of_16, fast_few_of_32, fast_few_of_48, fast_few_of_64,
};
