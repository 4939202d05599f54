//! Winners become answers: what `portable::left_right` does.
#![allow(unsafe_code)]

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::MethodParameters;
use crate::matching::backend::work::Rules;
use crate::matching::memory::winners::Winner;
use crate::units::{Disparity, PixelFlags};
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

/// One winner of [`answer`], whose fraction `$fraction` finds: 20 instructions and those. `r7` is 0.
///
/// ```text
/// r4, r5    the column, and how many there are     r8 to r11   winners, right columns, answers, flags
/// r12, lr   `flags_and_ceiling`, `least_and_too_far`
/// ```
macro_rules! answer_one {
    ($fraction:expr) => {
        concat!(
            "ldr r0, [r8, r4, lsl #2]\n",
            "lsr r1, r0, #24\n",
            // How far from what the partner keeps.
            "sub r3, r4, r1\n",
            "usat r3, #16, r3\n",
            "ldrb r3, [r9, r3, lsl #1]\n",
            "ldrb r6, [r11, r4]\n",
            "usad8 r3, r3, r1\n",
            // Whether that is too far, and whether it is the last candidate: what is not less carries.
            "cmp r3, lr, lsr #16\n",
            "adc r2, r7, r7\n",
            "cmp r1, r12, lsr #24\n",
            "adc r2, r7, r2, lsl #3\n",
            "orr r6, r6, r2, lsl #1\n",
            $fraction,
            "add r3, r3, r1, lsl #5\n",
            "add r3, r3, lr\n",
            "tst r6, r12\n",
            "it ne\n",
            "movne r3, #-1\n",
            "strb r6, [r11, r4]\n",
            "strh r3, [r10, r4, lsl #1]\n",
            "add r4, r4, #1\n",
        )
    };
}

/// The costs in the lower three bytes of `r0`, below, at and above the disparity, of which that at it is the
/// least: the difference of those beside it in `r3`, the steeper rise in `r2`, and whether that is nothing as
/// a condition. 7 instructions.
macro_rules! rises {
    () => {
        "uxtb r2, r0
         uxtb r3, r0, ror #16
         uxtb r0, r0, ror #8
         subs r3, r2, r3
         it lo
         sublo r2, r2, r3
         subs r2, r2, r0
         "
    };
}

/// 16 times the difference in `r3`, and half of `r2` more, over `r2`: the fraction in `r3`. 5 instructions.
macro_rules! quotient {
    () => {
        "lsls r3, r3, #4
         ite mi
         submi r3, r3, r2, lsr #1
         addpl r3, r3, r2, lsr #1
         sdiv r3, r3, r2
         "
    };
}

/// The fraction in `r3` by the costs in `r0`, which rise for nothing but the disparity: the difference of
/// both rises over the steeper one. 15 instructions.
macro_rules! upright_fraction {
    () => {
        concat!(
            rises!(),
            "itt eq
             orreq r6, r6, r12, lsr #8
             moveq r2, #1
             ",
            quotient!(),
        )
    };
}

/// The fraction in `r3` as [`upright_fraction`] finds it, of costs that rise by up to `{slant}` on a slanted
/// surface: that much of the steeper rise is not counted, as far as it is more than the difference, and both
/// are at least 1, to divide by. 23 instructions.
macro_rules! slanted_fraction {
    () => {
        concat!(
            rises!(),
            "it eq
             orreq r6, r6, r12, lsr #8
             eor r0, r3, r3, asr #31
             sub r0, r0, r3, asr #31
             sub r2, r2, #{slant} + 1
             usat r2, #8, r2
             add r2, r2, #1
             cmp r2, r0
             it lo
             movlo r2, r0
             ",
            quotient!(),
        )
    };
}

/// The answers and flags of winners that were offered to the `right`. 36 instructions a pixel, 43 where a
/// part of the steeper rise is not counted.
#[inline(never)]
pub(super) fn answer<P: MethodParameters>(
    winners: &[Winner],
    right: &[u16],
    refused: &Rules,
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
    let count = winners.len().min(answers.len()).min(flags.len()).min(right.len());
    if count == 0 {
        return;
    }
    const { assert!(Disparity::ONE == 1 << 5) };
    const { assert!(PixelFlags::MISMATCH.bits() == 16 && PixelFlags::CEILING.bits() == 2) };
    // A flag is or-ed in with what stands above it: these bits are in no other flag's place.
    let flags_and_ceiling = u32::from(refused.refused.bits())
        | u32::from(refused.flat.bits()) << 8
        | u32::from(refused.ceiling) << 24;
    let least_and_too_far =
        u32::from(refused.min_disparity) << 5 & 0xffff | (u32::from(refused.tolerance) + 1) << 16;
    macro_rules! answers {
        ($fraction:expr $(, $slant:ident = const $value:expr)?) => {
            asm!(
                "push {{r6, r7}}",
                "mov r7, #0",
                "tst r5, #1",
                "bne 3f",
                "2:",
                answer_one!($fraction),
                "3:",
                answer_one!($fraction),
                "cmp r4, r5",
                "bne 2b",
                "pop {{r6, r7}}",
                inout("r4") 0 => _,
                in("r5") count,
                in("r8") winners.as_ptr(),
                in("r9") right.as_ptr(),
                in("r10") answers.as_mut_ptr(),
                in("r11") flags.as_mut_ptr(),
                in("r12") flags_and_ceiling,
                in("lr") least_and_too_far,
                $($slant = const $value,)?
                out("r0") _, out("r1") _, out("r2") _, out("r3") _,
            )
        };
    }
    // SAFETY: the loop counts `x` up to `count`, which all four slices have, as above: it reads winner `x`,
    // what the right column `x - disparity` keeps, or the first one if that is less than 0, and changes
    // flag and answer `x`. The divisor is not 0. The stack and the two registers that no operand may be
    // are left as they were.
    unsafe {
        if P::SLANT_COST == 0 {
            answers!(upright_fraction!());
        } else {
            answers!(slanted_fraction!(), slant = const P::SLANT_COST);
        }
    }
}
