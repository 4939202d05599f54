//! The surfaces along a row, and answers averaged within them: what `surface/runs.rs` does.
#![allow(unsafe_code)]

use crate::matching::backend::portable::smooth::RECIPROCALS;
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

/// One answer of [`count`]: 10 instructions.
macro_rules! count_one {
    ($here:literal, $before:literal) => {
        concat!(
            "ldrh {",
            $here,
            "}, [{answers}], #2\n",
            "sub {t}, {",
            $here,
            "}, {",
            $before,
            "}\n",
            "add {t}, {t}, {step}\n",
            "cmp {t}, {step}, lsl #1\n",
            "ite ls\n",
            "uqadd8ls {length}, {length}, {one}\n",
            "movhi {length}, #0\n",
            "strb {length}, [{lengths}], #1\n",
            "add {sum}, {sum}, {",
            $here,
            "}\n",
            "strh {sum}, [{sums}, #2]!\n",
        )
    };
}

/// The pass to the right: for every answer how many of its surface there are before it, and the sum of all
/// raw disparities up to it, modulo 2^16, after one for none. 11 instructions an answer.
#[inline(never)]
fn count(answers: &[Disparity], lengths: &mut [u8], sums: &mut [u16], step: Disparity) {
    let count = answers.len();
    if count == 0 || lengths.len() < count || sums.len() < count + 1 {
        return;
    }
    // No answer is near what stands before the row.
    let before = u32::MAX / 2;
    // SAFETY: `count` answers are read, two in a round but for one in the first if `count` is odd; as many
    // lengths are written, and a sum more.
    unsafe {
        asm!(
            "strh {sum}, [{sums}]",
            "tst {t}, #1",
            "bne 3f",
            "2:",
            count_one!("a", "b"),
            "3:",
            count_one!("b", "a"),
            "cmp {answers}, {end}",
            "bne 2b",
            answers = inout(reg) answers.as_ptr() => _, end = in(reg) answers.as_ptr().add(count),
            lengths = inout(reg) lengths.as_mut_ptr() => _,
            sums = inout(reg) sums.as_mut_ptr() => _,
            sum = inout(reg) 0 => _,
            length = inout(reg) 0 => _,
            a = inout(reg) before => _, b = inout(reg) before => _,
            step = in(reg) u32::from(step.raw()), one = in(reg) 1, t = inout(reg) count => _,
            options(nostack),
        );
    }
}

/// One answer of [`average_back`]: 23 instructions.
macro_rules! average_one {
    () => {
        concat!(
            // How many there are after it: the first of the next surface has none before it.
            "cmp {to}, #0\n",
            "ldrb {to}, [{lengths}, #-1]!\n",
            "ite ne\n",
            "addne {from}, {from}, #1\n",
            "moveq {from}, #0\n",
            "add {t}, {to}, {from}\n",
            "usat {t}, #8, {t}\n",
            "strb {t}, [{lengths}]\n",
            // As many to both sides.
            "usub16 {t}, {to}, {from}\n",
            "sel {reach}, {from}, {to}\n",
            "usub16 {t}, {reach}, {most}\n",
            "sel {reach}, {most}, {reach}\n",
            "ldrh {t}, [{sums}, {reach}, lsl #1]\n",
            "sub {u}, {sums}, {reach}, lsl #1\n",
            "ldrh {u}, [{u}, #-2]\n",
            "sub {sums}, {sums}, #2\n",
            "sub {t}, {t}, {u}\n",
            // What the others differ by, over how many they are, rounded: there is no tie.
            "ldr {reach}, [{counts}, {reach}, lsl #2]\n",
            "ldrh {u}, [{answers}, #-2]!\n",
            "smlatb {t}, {reach}, {u}, {t}\n",
            "smlabb {t}, {t}, {reach}, {half}\n",
            "add {u}, {u}, {t}, asr #16\n",
            "strh {u}, [{answers}]\n",
        )
    };
}

/// The pass back: makes every answer the average, and every length that of the whole surface. 24 instructions
/// an answer.
#[inline(never)]
fn average_back(answers: &mut [Disparity], lengths: &mut [u8], sums: &[u16], radius: u8) {
    let count = answers.len();
    if count == 0 || lengths.len() < count || sums.len() < count + 1 {
        return;
    }
    let first = lengths.as_mut_ptr();
    // SAFETY: from the last of `count` answers and lengths back to the first, they are read and written, two
    // in a round but for one in the first if `count` is odd. The number `reach` is no more than how many
    // of the surface there are before an answer, no more than how many there are after it, and no more
    // than COUNTS has. So sums are read between the first and the one that stands `count` after it.
    unsafe {
        asm!(
            "tst {t}, #1",
            "bne 3f",
            "2:",
            average_one!(),
            "3:",
            average_one!(),
            "cmp {lengths}, {first}",
            "bne 2b",
            answers = inout(reg) answers.as_mut_ptr().add(count) => _,
            lengths = inout(reg) first.add(count) => _, first = in(reg) first,
            // The sum up to the last.
            sums = inout(reg) sums.as_ptr().add(count) => _,
            counts = in(reg) COUNTS.as_ptr(),
            most = in(reg) usize::from(radius).min(MOST),
            half = in(reg) 1 << 15,
            to = inout(reg) 0 => _, from = inout(reg) 0 => _,
            reach = out(reg) _, t = inout(reg) count => _, u = out(reg) _,
            options(nostack),
        );
    }
}
