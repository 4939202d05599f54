//! Census rows, four pixels at a time.
#![allow(unsafe_code)]

use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::portable::census::{census_of_bytes, codes};
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{part, part_mut};
use core::arch::asm;

/// The fewest pixels of a row that has whole words at both ends.
const FEWEST: usize = 8;

/// The census row of five lines; or of the right ones, whose codes have four bits, into the high halves of
/// bytes whose low halves are the left ones.
#[inline(never)]
pub(super) fn census<S: WindowParameters>(rows: &Rows5<'_>, of_right: bool, out: &mut [u8]) {
    let width = out.len();
    let [above, _, here, _, below] = *rows;
    let lines = [above, here, below].map(|line| part(line, ..width));
    if width < FEWEST || lines.iter().any(|line| line.len() < width) {
        let mut codes = [0; FEWEST];
        let codes = part_mut(&mut codes, ..width);
        census_of_bytes::<S>(lines, codes, 0);
        return out.iter_mut().zip(codes).for_each(|(out, code)| put(*code, of_right, out));
    }
    if let Some(inner) = out.get_mut(2..width - 2) {
        // The last group is moved back to end with the inner pixels.
        let last = inner.len() - 4;
        for (from, to) in [(0, inner.len() & !3), (last, inner.len())] {
            let lines = lines.map(|line| part(line, from..));
            let out = part_mut(inner, from..to);
            if of_right {
                plus4_of_right(lines, out);
            } else if S::BITS <= 4 {
                plus4(lines, out);
            } else {
                ring8(lines, out);
            }
        }
    }
    // Columns outside the line are the nearest inside it.
    let words = |at: usize| lines.map(|line| line.get(at..).and_then(|line| line.first_chunk().copied()));
    let words = |at: usize| words(at).map(|bytes| bytes.map_or(0, u32::from_le_bytes));
    let edge = |places: [[u32; 3]; 3]| codes::<S>(&places).to_le_bytes();
    let begin = |first: u32, second: u32| [first << 16 | (first & 0xff) * 0x0101, first, second];
    let ([a, b, c], [d, e, f]) = (words(0), words(2));
    let [first, second, ..] = edge([begin(a, d), begin(b, e), begin(c, f)]);
    let end = |before: u32, last: u32| [before, last, last >> 16 | (last >> 24) * 0x0101_0000];
    let ([a, b, c], [d, e, f]) = (words(width - 6), words(width - 4));
    let [.., before_last, last] = edge([end(a, d), end(b, e), end(c, f)]);
    let codes = [(0, first), (1, second), (width - 2, before_last), (width - 1, last)];
    for (x, code) in codes {
        if let Some(out) = out.get_mut(x) {
            put(code, of_right, out);
        }
    }
}

/// A code where it belongs.
#[inline(always)]
fn put(code: u8, of_right: bool, out: &mut u8) {
    *out = if of_right { *out | code << 4 } else { code };
}

/// The bit of a neighbour where it is darker: 4 instructions.
macro_rules! compare {
    ($line:literal, $place:literal, $bit:literal) => {
        concat!(
            "ldr {n}, [{",
            $line,
            "}",
            $place,
            "\n",
            "usub8 {n}, {n}, {c}\n",
            "orr {n}, {code}, #",
            $bit,
            "\n",
            "sel {code}, {code}, {n}\n",
        )
    };
}

macro_rules! census_of {
    ($(#[$doc:meta])* $name:ident from $before:literal: $($neighbours:expr),*) => {
        $(#[$doc])*
        #[inline(never)]
        fn $name([above, here, below]: [&[u8]; 3], out: &mut [u8]) {
            let count = out.len() & !3;
            if count == 0 || [above, here, below].iter().any(|line| line.len() < count + 4) {
                return;
            }
            let out = out.as_mut_ptr();
            // SAFETY: `count` codes are written, four in every round, and of every line `count` pixels read
            // and two beside them on both sides, which the lines have.
            unsafe {
                asm!(
                    "2:",
                    "ldr {c}, [{here}], #4",
                    $before,
                    $($neighbours,)*
                    "str {code}, [{out}], #4",
                    "cmp {out}, {end}",
                    "bne 2b",
                    above = inout(reg) above.as_ptr().add(2) => _,
                    here = inout(reg) here.as_ptr().add(2) => _,
                    below = inout(reg) below.as_ptr().add(2) => _,
                    out = inout(reg) out => _, end = in(reg) out.add(count),
                    c = out(reg) _, n = out(reg) _, code = out(reg) _,
                    options(nostack),
                );
            }
        }
    };
}

// The first read of a line moves on by four pixels.
census_of! {
    /// [`crate::imaging::census_plus4`] of the pixels from the third one of each line on: 21 instructions for
    /// four.
    plus4 from "mov {code}, #0":
    compare!("above", "], #4", "0x01010101"), compare!("here", ", #-6]", "0x02020202"),
    compare!("here", ", #-2]", "0x04040404"), compare!("below", "], #4", "0x08080808")
}

census_of! {
    /// Census codes of right lines, into the high halves of bytes.
    plus4_of_right from "ldr {code}, [{out}]":
    compare!("above", "], #4", "0x10101010"), compare!("here", ", #-6]", "0x20202020"),
    compare!("here", ", #-2]", "0x40404040"), compare!("below", "], #4", "0x80808080")
}

census_of! {
    /// [`crate::imaging::census_ring8`], likewise: 37 instructions for four.
    ring8 from "mov {code}, #0":
    compare!("above", "], #4", "0x02020202"), compare!("above", ", #-6]", "0x01010101"),
    compare!("above", ", #-2]", "0x04040404"), compare!("here", ", #-6]", "0x08080808"),
    compare!("here", ", #-2]", "0x10101010"), compare!("below", "], #4", "0x40404040"),
    compare!("below", ", #-6]", "0x20202020"), compare!("below", ", #-2]", "0x80808080")
}
