//! Winners are offered to their partners: the first half of what `portable::left_right` does.
#![allow(unsafe_code)]

use crate::matching::backend::loops::keep_loop;
use crate::matching::memory::winners::Winner;
use core::arch::asm;

/// One winner of [`offer`]: 10 instructions.
macro_rules! offer_one {
    () => {
        concat!(
            "ldr {w}, [{winners}], #4\n",
            "lsr {d}, {w}, #24\n",
            "sub {c}, {x}, {d}\n",
            "usat {c}, #16, {c}\n",
            // The cost above the disparity, in the low half.
            "bfi {w}, {d}, #0, #8\n",
            // Of one partner, those who come later are farther away: their disparity is larger.
            "ldrh {d}, [{right}, {c}, lsl #1]\n",
            "usub16 {t}, {w}, {d}\n",
            "sel {w}, {d}, {w}\n",
            "strh {w}, [{right}, {c}, lsl #1]\n",
            "add {x}, {x}, #1\n",
        )
    };
}

/// One winner of [`offer_compared`]: 16 instructions.
macro_rules! offer_one_compared {
    () => {
        concat!(
            "ldr {w}, [{winners}], #4\n",
            "ldrb {l}, [{left}], #1\n",
            "lsr {d}, {w}, #24\n",
            "sub {c}, {x}, {d}\n",
            "usat {c}, #16, {c}\n",
            "ldrb {t}, [{of_right}, {c}]\n",
            "ubfx {w}, {w}, #8, #8\n",
            "usad8 {l}, {l}, {t}\n",
            "add {w}, {w}, {l}, lsl #2\n",
            "usat {w}, #8, {w}\n",
            "orr {w}, {d}, {w}, lsl #8\n",
            "ldrh {d}, [{right}, {c}, lsl #1]\n",
            "usub16 {t}, {w}, {d}\n",
            "sel {w}, {d}, {w}\n",
            "strh {w}, [{right}, {c}, lsl #1]\n",
            "add {x}, {x}, #1\n",
        )
    };
}

/// Offers every winner to its partner: see `portable/consistency.rs`.
#[inline(always)]
pub(super) fn offer(winners: &[Winner], pixels: Option<[&[u8]; 2]>, right: &mut [u16]) {
    empty(right);
    let count = winners.len().min(right.len());
    match pixels {
        _ if count == 0 => {}
        Some([left, of_right]) if left.len().min(of_right.len()) >= count => {
            offer_compared(winners, [left, of_right], right, count);
        }
        _ => offer_winners(winners, right, count),
    }
}

/// Nobody has offered anything yet.
#[inline(never)]
fn empty(right: &mut [u16]) {
    let (eights, rest) = right.as_chunks_mut::<8>();
    for one in rest {
        // Not the compiler's routine, which takes more flash than so few need.
        keep_loop();
        *one = u16::MAX;
    }
    let eights = eights.as_mut_ptr_range();
    // SAFETY: eight at a time from the first to the last.
    unsafe {
        asm!(
            "cmp {t}, {end}",
            "beq 5f",
            "4:",
            "str {none}, [{t}], #4",
            "str {none}, [{t}], #4",
            "str {none}, [{t}], #4",
            "str {none}, [{t}], #4",
            "cmp {t}, {end}",
            "bne 4b",
            "5:",
            none = in(reg) u32::MAX, t = inout(reg) eights.start => _, end = in(reg) eights.end,
            options(nostack),
        );
    }
}

/// Offers so many winners, at least one: 11 instructions a pixel.
#[inline(never)]
fn offer_winners(winners: &[Winner], right: &mut [u16], count: usize) {
    // SAFETY: the loop counts `x` up to `count`, by two but for one in the first round if `count` is odd. It
    // reads winner `x`, of which there are so many, and reads and writes the right column `x - disparity`, or
    // the first one if that is less than 0: one before `count`.
    unsafe {
        asm!(
            "tst {count}, #1",
            "bne 3f",
            "2:",
            offer_one!(),
            "3:",
            offer_one!(),
            "cmp {x}, {count}",
            "bne 2b",
            x = inout(reg) 0 => _,
            count = in(reg) count,
            winners = inout(reg) winners.as_ptr() => _,
            right = in(reg) right.as_mut_ptr(),
            t = out(reg) _, w = out(reg) _, d = out(reg) _, c = out(reg) _,
            options(nostack),
        );
    }
}

/// [`offer_winners`] with what the two pixels differ by: 17 instructions a pixel.
#[inline(never)]
fn offer_compared(winners: &[Winner], [left, of_right]: [&[u8]; 2], right: &mut [u16], count: usize) {
    // SAFETY: as for `offer_winners`; both rows of pixels have `count` of them.
    unsafe {
        asm!(
            "tst {count}, #1",
            "bne 3f",
            "2:",
            offer_one_compared!(),
            "3:",
            offer_one_compared!(),
            "cmp {x}, {count}",
            "bne 2b",
            x = inout(reg) 0 => _,
            count = in(reg) count,
            winners = inout(reg) winners.as_ptr() => _,
            left = inout(reg) left.as_ptr() => _, of_right = in(reg) of_right.as_ptr(),
            right = in(reg) right.as_mut_ptr(),
            t = out(reg) _, w = out(reg) _, d = out(reg) _, c = out(reg) _, l = out(reg) _,
            options(nostack),
        );
    }
}
