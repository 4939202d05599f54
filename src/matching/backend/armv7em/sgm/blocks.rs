//! The loops over a pixel's words. Each works on four words at a time, for a column has whole
//! [`STEP`](super::super::STEP)s of bytes. The instructions of a word are counted with each; the loop adds
//! half of one.
#![allow(unsafe_code)]

use crate::matching::backend::parameters::SgmParameters;
use core::arch::asm;

/// Four times the lines of a word, and around again until `n` is 0.
macro_rules! four_words {
    ($($line:literal)*) => {
        concat!("2:\n", $($line, "\n",)* $($line, "\n",)* $($line, "\n",)* $($line, "\n",)*
            "subs {n}, {n}, #1\n", "bne 2b")
    };
}

/// The least of a word's four bytes, in all of them: half a word off, then a byte.
macro_rules! least_of_four {
    () => {
        "ror {a}, {least}, #16
         usub8 {b}, {least}, {a}
         sel {least}, {a}, {least}
         ror {a}, {least}, #8
         usub8 {b}, {least}, {a}
         sel {least}, {a}, {least}"
    };
}

/// The least of a column's sums and the last byte that has it. 5 instructions.
///
/// The loop finds the least of each byte of a word and the word where it is, of equal ones the last. Then the
/// least of the four goes to all bytes, and the greatest place of those that have it.
///
/// # Safety
/// `fours` times four words, 64 at the most and one at least, can be read from `sums`.
#[inline(always)]
pub(super) unsafe fn least(sums: *const u32, fours: usize) -> (u8, usize) {
    let (least, place): (u32, u32);
    // SAFETY: as the function's.
    unsafe {
        asm!(
            "mvn {least}, #0",
            "mov {place}, #0",
            four_words!(
                "ldr {a}, [{sums}], #4"
                "usub8 {b}, {least}, {a}"
                "sel {least}, {a}, {least}"
                "sel {places}, {place}, {places}"
                "add {place}, {place}, #0x01010101"
            ),
            "mov {place}, {least}",
            least_of_four!(),
            "add {places}, {lanes}, {places}, lsl #2",
            "usub8 {a}, {least}, {place}",
            "mov {b}, #0",
            "sel {places}, {places}, {b}",
            "ror {a}, {places}, #16",
            "usub8 {b}, {places}, {a}",
            "sel {places}, {places}, {a}",
            "ror {a}, {places}, #8",
            "usub8 {b}, {places}, {a}",
            "sel {places}, {places}, {a}",
            sums = inout(reg) sums => _,
            n = inout(reg) fours => _,
            lanes = in(reg) 0x0302_0100,
            least = out(reg) least,
            places = out(reg) place,
            place = out(reg) _,
            a = out(reg) _, b = out(reg) _,
            options(nostack, readonly),
        );
    }
    (least as u8, (place & 0xff) as usize)
}

/// A pixel of the left image, but for its gradient along the line, four times in a word each; and the most
/// that its cost may be.
pub(super) struct Rest {
    pub across: u32,
    pub census: u32,
    pub brightness: u32,
    pub most: u32,
}

/// A cost's loop, in which the lines at the beginning put the share of the gradient along the line in `a`.
///
/// The rest are 22 instructions, and two that average: how far apart two numbers are is the greater of their
/// two differences, the other of which is 0; the bits of a byte are counted by twos, fours and eights; masks
/// are such as an instruction holds.
macro_rules! cost {
    ($costs:ident, $rows:ident, $count:ident, $along:ident, $rest:ident, [$($line:literal)*],
    [$($average:literal)*]) => {
        asm!(
            four_words!(
                $($line)*
                "ldr {b}, [{rows}, {count}, lsl #1]"
                "uqsub8 {t}, {b}, {brightness}"
                "uqsub8 {b}, {brightness}, {b}"
                "orr {b}, {b}, {t}"
                "and {b}, {b}, #0xfcfcfcfc"
                "add {a}, {a}, {b}, lsr #2"
                "ldr {b}, [{rows}, {count}]"
                "eor {b}, {b}, {census}"
                "and {t}, {b}, #0xaaaaaaaa"
                "sub {b}, {b}, {t}, lsr #1"
                "and {t}, {b}, #0xcccccccc"
                "and {b}, {b}, #0x33333333"
                "add {b}, {b}, {t}, lsr #2"
                "add {b}, {b}, {b}, lsr #4"
                "and {b}, {b}, #0x0f0f0f0f"
                "add {a}, {a}, {b}"
                "ldr {b}, [{rows}], #4"
                "uqsub8 {t}, {b}, {across}"
                "uqsub8 {b}, {across}, {b}"
                "add {a}, {a}, {t}"
                "add {a}, {a}, {b}"
                "uqsub8 {a}, {most}, {a}"
                $($average)*
                "str {a}, [{costs}], #4"
            ),
            costs = inout(reg) $costs.as_mut_ptr() => _,
            rows = inout(reg) $rows.as_ptr().wrapping_add($count) => _,
            n = inout(reg) $costs.len() / 4 => _,
            count = in(reg) $count,
            along = in(reg) $along,
            across = in(reg) $rest.across,
            census = in(reg) $rest.census,
            brightness = in(reg) $rest.brightness,
            most = in(reg) $rest.most,
            a = out(reg) _, b = out(reg) _, t = out(reg) _,
            options(nostack),
        )
    };
}

/// Averages a pixel's agreements into `costs`, or puts them there within edges. Its gradient `along` the line
/// is compared with all between the right ones and halfway to their neighbours: how far it is from `least` to
/// `greatest`. `rows` begins with the first candidate in the features' rows, so many bytes to a row. Those
/// numbers are doubled.
#[inline(always)]
pub(super) fn between_pixels<S: SgmParameters>(
    costs: &mut [u32],
    rows: &[u8],
    count: usize,
    along: u32,
    rest: &Rest,
) {
    if costs.len() < 4 || rows.len() < 5 * count + 4 * costs.len() {
        return;
    }
    macro_rules! between_pixels {
        ($average:tt) => {
            cost!(costs, rows, count, along, rest, [
                "add {t}, {rows}, {count}"
                "ldr {a}, [{t}, {count}, lsl #1]"
                "ldr {b}, [{rows}, {count}, lsl #2]"
                "uqsub8 {a}, {a}, {along}"
                "uqsub8 {b}, {along}, {b}"
                "orr {a}, {a}, {b}"
            ], $average)
        };
    }
    // SAFETY: `costs.len() / 4` times four words are read from six rows, the last of which begins after five
    // of them, and read from `costs` and written to it.
    unsafe {
        if S::WITHIN_EDGES {
            between_pixels!([])
        } else {
            between_pixels!(["ldr {b}, [{costs}]" "uhadd8 {a}, {a}, {b}"])
        }
    }
}

/// Costs at pixels against the right ones themselves, which are not doubled; always averaged.
#[inline(always)]
pub(super) fn at_pixels(costs: &mut [u32], rows: &[u8], count: usize, along: u32, rest: &Rest) {
    if costs.len() < 4 || rows.len() < 5 * count + 4 * costs.len() {
        return;
    }
    // SAFETY: as for `between_pixels`.
    unsafe {
        cost!(costs, rows, count, along, rest, [
            "sub {t}, {rows}, {count}"
            "ldr {b}, [{t}]"
            "uqsub8 {a}, {b}, {along}"
            "uqsub8 {b}, {along}, {b}"
            "orr {a}, {a}, {b}"
            "lsl {a}, {a}, #1"
        ], ["ldr {b}, [{costs}]" "uhadd8 {a}, {a}, {b}"]);
    }
}
