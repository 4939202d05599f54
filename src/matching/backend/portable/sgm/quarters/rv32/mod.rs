//! A row's paths and winners in the instructions of RV32IM, whole rows at a time: `rounds::plain` says what
//! is done to each word. The compiler makes the same of words, but puts away for them what is between their
//! loops. What is said of instructions is for four words.
//!
//! The mask of a comparison is the upper half of a product: see `below_tops`.
//!
//! * `instructions`: pieces of the assembly; `row`: what it takes of a row.
//! * `others`, `costs`: costs; `along`, `down`: the paths; `left`, `select`: the last one, with the winners.
//!   `paths`: all of them.
#![allow(unsafe_code)]

#[macro_use]
mod instructions;

mod along;
mod costs;
mod down;
mod left;
mod others;
mod paths;
mod row;
mod select;

pub(super) use costs::enter;
pub(super) use others::shift_in;
pub(super) use paths::{SELECTS_WORDS, select, select_words};
