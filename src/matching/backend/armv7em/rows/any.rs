//! The loops over sixteen candidates in a round, for any number of candidates.

use crate::matching::backend::parameters::WindowParameters;
use core::arch::asm;

/// Candidates in a round.
const ROUND: usize = 16;

/// Adds to the columns of `stride` candidates the bits in which the entering codes differ, and those in which
/// the leaving ones are equal, but for eight: 22 instructions for four candidates, two for a round, and 15
/// for a column. The first column has the last candidates of the reversed rows `new` and `old`.
#[inline(never)]
pub(in super::super) fn by_bits(
    [enters, leaves]: [&[u8]; 2],
    [new, old]: [&[u8]; 2],
    stride: usize,
    columns: &mut [u32],
) {
    let count = (4 * columns.len()).checked_div(stride).unwrap_or(0);
    if count == 0 || !stride.is_multiple_of(ROUND) {
        return;
    }
    let is_short = [enters, leaves].iter().any(|codes| codes.len() < count);
    if is_short || [new, old].iter().any(|row| row.len() < count - 1 + stride) {
        return;
    }
    // SAFETY: of `count` columns the loop reads a code of either row and changes the sums, and reads `stride`
    // codes of either reversed row from place `count - 1` on, for each column from one less. A column is a
    // whole number of rounds, and at least one.
    unsafe {
        asm!(
            "2:",
            // The left codes in every byte, the one that leaves turned over.
            "ldrb {enters}, [{new_left}], #1",
            "ldrb {leaves}, [{old_left}], #1",
            "orr {enters}, {enters}, {enters}, lsl #8",
            "orr {enters}, {enters}, {enters}, lsl #16",
            "orr {leaves}, {leaves}, {leaves}, lsl #8",
            "orr {leaves}, {leaves}, {leaves}, lsl #16",
            "mvn {leaves}, {leaves}",
            "mov {rest}, {stride}",
            "3:",
            ".rept 4",
            "ldr {a}, [{new}], #4",
            "ldr {b}, [{old}], #4",
            "eor {a}, {a}, {enters}",
            "eor {b}, {b}, {leaves}",
            // Bits of two in each two, of four in each four, of both words together; of eight in each byte.
            "bic {t}, {a}, #0x55555555",
            "sub {a}, {a}, {t}, lsr #1",
            "bic {t}, {b}, #0x55555555",
            "sub {b}, {b}, {t}, lsr #1",
            "bic {t}, {a}, #0x33333333",
            "and {a}, {a}, #0x33333333",
            "add {a}, {a}, {t}, lsr #2",
            "bic {t}, {b}, #0x33333333",
            "and {b}, {b}, #0x33333333",
            "add {a}, {a}, {t}, lsr #2",
            "add {a}, {a}, {b}",
            "bic {t}, {a}, #0x0f0f0f0f",
            "and {a}, {a}, #0x0f0f0f0f",
            "add {a}, {a}, {t}, lsr #4",
            "ldr {t}, [{sums}]",
            "add {t}, {t}, {a}",
            "sub {t}, {t}, #0x08080808",
            "str {t}, [{sums}], #4",
            ".endr",
            "subs {rest}, {rest}, #16",
            "bne 3b",
            "sub {new}, {new}, {stride}",
            "sub {old}, {old}, {stride}",
            "sub {new}, {new}, #1",
            "sub {old}, {old}, #1",
            "cmp {sums}, {end}",
            "bne 2b",
            new_left = inout(reg) enters.as_ptr() => _,
            old_left = inout(reg) leaves.as_ptr() => _,
            new = inout(reg) new.as_ptr().add(count - 1) => _,
            old = inout(reg) old.as_ptr().add(count - 1) => _,
            sums = inout(reg) columns.as_mut_ptr() => _,
            end = in(reg) columns.as_ptr().add(count * stride / 4),
            stride = in(reg) stride,
            enters = out(reg) _, leaves = out(reg) _,
            a = out(reg) _, b = out(reg) _, t = out(reg) _, rest = out(reg) _,
            options(nostack),
        );
    }
}

/// Moves the first `rounds` rounds of window sums one column on. Of every lane the least of them, and the
/// place of the first word that has it, in candidates: 11 instructions for four candidates, two more where
/// only some digits of the columns count, and two for a round.
#[inline(never)]
pub(in super::super) fn slide<S: WindowParameters>(
    sums: &mut [u32],
    enters: &[u32],
    leaves: &[u32],
    rounds: usize,
) -> (u32, u32) {
    let (mut least, mut places) = (u32::MAX, 0);
    let words = rounds * ROUND / 4;
    if rounds == 0 || sums.len() < words || enters.len() < words || leaves.len() < words {
        return (least, places);
    }
    // SAFETY: `words` words are read of each slice, and written of the sums; `rounds` is not 0.
    unsafe {
        asm!(
            "2:",
            ".rept 4",
            "ldr {e}, [{enters}], #4",
            "ldr {l}, [{leaves}], #4",
            "ldr {s}, [{sums}]",
            ".if {shift}",
            "and {e}, {digits}, {e}, lsr #{shift}",
            "and {l}, {digits}, {l}, lsr #{shift}",
            ".endif",
            "uadd8 {s}, {s}, {e}",
            "usub8 {s}, {s}, {l}",
            "usub8 {e}, {s}, {least}",
            "sel {least}, {least}, {s}",
            "sel {places}, {places}, {place}",
            "str {s}, [{sums}], #4",
            "add {place}, {place}, #0x04040404",
            ".endr",
            "subs {rounds}, {rounds}, #1",
            "bne 2b",
            enters = inout(reg) enters.as_ptr() => _,
            leaves = inout(reg) leaves.as_ptr() => _,
            sums = inout(reg) sums.as_mut_ptr() => _,
            least = inout(reg) least, places = inout(reg) places,
            place = inout(reg) 0 => _, rounds = inout(reg) rounds => _,
            digits = in(reg) (0xff >> S::COLUMN_SHIFT) * 0x0101_0101u32, shift = const S::COLUMN_SHIFT,
            e = out(reg) _, l = out(reg) _, s = out(reg) _,
            options(nostack),
        );
    }
    (least, places)
}
