//! The surfaces along a row, and answers averaged within them: what `surface/runs.rs` does.
#![allow(unsafe_code)]

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::smooth::{RECIPROCALS, of_one};
use crate::units::Disparity;
use core::arch::asm;

/// How far averages reach at most, to each side.
const MOST: usize = RECIPROCALS.len() - 1;

/// For each reach of an average: the reciprocal of its number of answers by 2^16, and above it how many
/// less than none they are. The reciprocal of one, which nothing is multiplied by, is left out.
static COUNTS: [u32; MOST + 1] = {
    let mut counts = [0; MOST + 1];
    let mut reach = 0;
    while reach <= MOST {
        counts[reach] = (2 * reach as u32 + 1).wrapping_neg() << 16 | (RECIPROCALS[reach] as u32 & 0xffff);
        reach += 1;
    }
    counts
};

/// [`Isa::smooth`](crate::matching::backend::Isa::smooth); a length is a byte, that of the answer `x` the
/// byte `x`: one less than it is, and 255 for all above.
#[inline(never)]
pub(super) fn smooth(
    answers: &mut [Disparity],
    lengths: &mut [u8],
    sums: &mut [u16],
    step: Disparity,
    radius: u8,
) {
    if answers.is_empty() || lengths.len() < answers.len() || sums.len() < answers.len() + 1 {
        return;
    }
    count(answers, lengths, sums, step);
    average_back(answers, lengths, sums, radius);
}

/// The pass to the right: for every answer how many of its surface there are before it, and the sum of all
/// raw disparities up to it, modulo 2^16, after one for none. 19 instructions for two answers.
#[inline(never)]
fn count(answers: &[Disparity], lengths: &mut [u8], sums: &mut [u16], step: Disparity) {
    let (mut sum, mut length, mut before) = (0u16, 0u8, None);
    let Some((none, sums)) = sums.split_first_mut() else { return };
    *none = sum;
    let count = answers.len().min(lengths.len()).min(sums.len());
    // What is left after the first one or two are whole pairs.
    let first = if count % 2 == 1 { 1 } else { 2 };
    for ((answer, out), sum_up_to) in answers.iter().zip(lengths.iter_mut()).zip(sums.iter_mut()).take(first)
    {
        keep_loop();
        let is_near = before.is_some_and(|before| of_one(answer.raw(), before, step));
        length = if is_near { length + 1 } else { 0 };
        sum = sum.wrapping_add(answer.raw());
        before = Some(answer.raw());
        (*out, *sum_up_to) = (length, sum);
    }
    if count <= first {
        return;
    }
    // SAFETY: from the answer before the first pair to the last one they are read, two and two, and for each
    // of the pairs two lengths and sums are written: `count` there are of all three.
    unsafe {
        asm!(
            "2:",
            // Two answers, and those before them.
            "ldr {t}, [{answers}, #-2]",
            "ldr {two}, [{answers}], #4",
            "uxtah {u}, {sum}, {two}",
            "uxtah {sum}, {u}, {two}, ror #16",
            "pkhbt {u}, {u}, {sum}, lsl #16",
            "str {u}, [{sums}], #4",
            // Which ones are near.
            "uqsub16 {u}, {two}, {t}",
            "uqsub16 {t}, {t}, {two}",
            "orr {t}, {t}, {u}",
            "usub16 {t}, {step}, {t}",
            "sel {t}, {one}, {zero}",
            // Others begin anew.
            "uqadd8 {u}, {length}, {one}",
            "smulbb {u}, {u}, {t}",
            "uqadd8 {length}, {u}, {one}",
            "smulbt {length}, {length}, {t}",
            "orr {u}, {u}, {length}, lsl #8",
            "strh {u}, [{lengths}], #2",
            "cmp {answers}, {end}",
            "bne 2b",
            answers = inout(reg) answers.as_ptr().add(first) => _, end = in(reg) answers.as_ptr().add(count),
            lengths = inout(reg) lengths.as_mut_ptr().add(first) => _,
            sums = inout(reg) sums.as_mut_ptr().add(first) => _,
            sum = inout(reg) u32::from(sum) => _,
            length = inout(reg) u32::from(length) => _,
            step = in(reg) u32::from(step.raw()) * 0x1_0001, one = in(reg) 0x1_0001, zero = in(reg) 0,
            two = out(reg) _, t = out(reg) _, u = out(reg) _,
            options(nostack),
        );
    }
}

/// The pass back: makes every answer the average, and every length that of the whole surface. 44
/// instructions for two answers.
///
/// ```text
/// r0, r1      of both answers how many of their surface there are before and after, then their reaches
/// r5, r6      the first ones, of the answer behind both
/// r8 to r11   lengths, sums, answers, counts      r12   the reach at most, twice
/// ```
#[inline(never)]
fn average_back(answers: &mut [Disparity], lengths: &mut [u8], sums: &[u16], radius: u8) {
    let count = answers.len();
    if count == 0 || lengths.len() < count || sums.len() < count + 1 {
        return;
    }
    let first = lengths.as_mut_ptr();
    let most = usize::from(radius).min(MOST) as u32;
    // Of the answer behind these: how many of its surface there are before it, and after.
    let (mut to, mut from) = (0u32, 0u32);
    if count > 1 {
        // SAFETY: from the last of `count` answers and lengths back to the first two, or the second and the
        // third, they are read and written, two in a round. A reach is no more than how many of the surface
        // there are before an answer, no more than how many there are after it, and no more than COUNTS has.
        // So sums are read between the first and the one that stands `count` after it. The stack and the two
        // registers that no operand may be are left as they were.
        unsafe {
            asm!(
                "push {{r4, r6, r7}}",
                "mov r4, #1",
                "mov r6, #0",
                "2:",
                // How many there are after it: the first of the next surface has none before it.
                "cmp r5, #0",
                "ldrb r0, [r8, #-1]",
                "ite ne",
                "uqadd8ne r1, r6, r4",
                "moveq r1, #0",
                "cmp r0, #0",
                "ldrb r5, [r8, #-2]!",
                "ite ne",
                "uqadd8ne r6, r1, r4",
                "moveq r6, #0",
                "pkhbt r0, r5, r0, lsl #16",
                "pkhbt r1, r6, r1, lsl #16",
                "uqadd8 r2, r0, r1",
                "orr r2, r2, r2, lsr #8",
                "strh r2, [r8]",
                // As many to both sides.
                "usub16 r2, r0, r1",
                "sel r0, r1, r0",
                "usub16 r2, r0, r12",
                "sel r0, r12, r0",
                "lsr r1, r0, #16",
                "uxth r0, r0",
                "ldrh r2, [r9, r1, lsl #1]",
                "sub r3, r9, r1, lsl #1",
                "ldrh r3, [r3, #-2]",
                "sub r9, r9, #2",
                "sub r2, r2, r3",
                "ldr r1, [r11, r1, lsl #2]",
                "ldrh r3, [r9, r0, lsl #1]",
                "sub r7, r9, r0, lsl #1",
                "ldrh r7, [r7, #-2]",
                "sub r9, r9, #2",
                "sub r3, r3, r7",
                "ldr r0, [r11, r0, lsl #2]",
                // What the others differ by, over how many they are, rounded: there is no tie.
                "ldr r7, [r10, #-4]!",
                "smlatt r2, r1, r7, r2",
                "smlatb r3, r0, r7, r3",
                "smlabb r2, r2, r1, lr",
                "smlabb r3, r3, r0, lr",
                "pkhtb r2, r2, r3, asr #16",
                "uadd16 r7, r7, r2",
                "str r7, [r10]",
                "ldr r2, [sp]",
                "cmp r8, r2",
                "bne 2b",
                "mov r3, r6",
                "pop {{r4, r6, r7}}",
                in("r4") first.add(count % 2),
                inout("r5") to,
                inout("r8") first.add(count) => _,
                // The sum up to the last.
                inout("r9") sums.as_ptr().add(count) => _,
                inout("r10") answers.as_mut_ptr().add(count) => _,
                in("r11") COUNTS.as_ptr(),
                in("r12") most * 0x1_0001,
                in("lr") 1 << 15,
                out("r0") _, out("r1") _, out("r2") _, out("r3") from,
            );
        }
    }
    if count % 2 == 1
        && let Some(first) = lengths.first_mut()
    {
        // None is before the first answer, which so is its own average.
        *first = if to > 0 { (from + 1).min(u8::MAX.into()) as u8 } else { 0 };
    }
}
