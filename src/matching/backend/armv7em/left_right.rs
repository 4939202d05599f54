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

/// Offers every winner to its partner: see `answers::consistency`. 12 instructions a pixel.
#[inline(never)]
pub(super) fn offer(winners: &[Winner], right: &mut [u16]) {
    let (eights, rest) = right.as_chunks_mut::<8>();
    for one in rest {
        // Not the compiler's routine, which takes more flash than so few need.
        keep_loop();
        *one = u16::MAX;
    }
    let eights = eights.as_mut_ptr_range();
    let count = winners.len().min(right.len());
    if count == 0 {
        return;
    }
    // SAFETY: nobody has offered anything yet: eight at a time from the first to the last. Then the loop
    // counts `x` up to `count`, by two but for one in the first round if `count` is odd. It reads winner
    // `x`, of which there are so many, and reads and writes the right column `x - disparity`, or the
    // first one if that is less than 0: one before `count`.
    unsafe {
        asm!(
            "cmp {t}, {w}",
            "beq 5f",
            "4:",
            "str {none}, [{t}], #4",
            "str {none}, [{t}], #4",
            "str {none}, [{t}], #4",
            "str {none}, [{t}], #4",
            "cmp {t}, {w}",
            "bne 4b",
            "5:",
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
            none = in(reg) u32::MAX,
            t = inout(reg) eights.start => _, w = inout(reg) eights.end => _, d = out(reg) _, c = out(reg) _,
            options(nostack),
        );
    }
}
