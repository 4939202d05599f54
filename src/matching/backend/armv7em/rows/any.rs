//! The loops over sixteen candidates in a round, for any number of candidates.

use crate::matching::backend::parameters::WindowParameters;
use core::arch::asm;

/// Candidates in a round.
const ROUND: usize = 16;

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
