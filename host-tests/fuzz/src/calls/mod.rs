//! Sessions of a program in C: calls in any order, with pointers in any state that C allows.
#![allow(unsafe_code, reason = "functions with a C ABI are called as C calls them")]

mod arena;
mod driving;
mod lines;
mod motion;
mod rows;
mod values;
mod views;

use crate::case;
use arbitrary::{Result, Unstructured};
use arena::Arena;
use stereopsis::ffi::Status;

/// The longest line, the largest number of disparities and the highest image of the library.
const WIDTH: usize = 40;
const DISPARITIES: usize = 16;
const HEIGHT: usize = 24;

stereopsis::instantiate_c_api!(
    Sgm,
    width = WIDTH,
    disparities = DISPARITIES,
    height = HEIGHT,
    lines = 9,
    prefix = "fuzz_",
);

/// Calls of a family of functions.
type Family = fn(&mut Unstructured<'_>, &mut Arena) -> Result<Status>;

const FAMILIES: [Family; 11] = [
    rows::matcher,
    rows::winners,
    rows::rectifier,
    lines::queue,
    lines::detector,
    motion::focus,
    motion::odometry,
    driving::obstacles,
    driving::drive,
    values::plain,
    views::two_views,
];

/// No call reads or writes beyond what it was given, and one that refuses changes nothing.
pub fn keep_to_their_memory(u: &mut Unstructured<'_>) -> Result<()> {
    let arena = &mut Arena::new();
    let family = *u.choose(&FAMILIES)?;
    for _ in 0..u.int_in_range(1..=80)? {
        if u.is_empty() {
            break;
        }
        let family = if u.ratio(1, 16)? { *u.choose(&FAMILIES)? } else { family };
        arena.begin_call();
        let status = family(u, arena)?;
        arena.end_call(status);
    }
    Ok(())
}

/// The number of elements that a call says: most often the width of a line.
fn count(u: &mut Unstructured<'_>, most: usize) -> Result<usize> {
    match u.int_in_range(0..=15)? {
        0 => u.int_in_range(0..=most),
        1 => u.int_in_range(WIDTH - 1..=WIDTH + 1),
        _ => Ok(WIDTH),
    }
}

/// A number of a C program: any, most often sane.
fn float(u: &mut Unstructured<'_>) -> Result<f32> {
    Ok(case::number(u)? as f32)
}
