//! Four pixels of a rectified line at a time, in Arm's instructions on two half-words of a word (Cortex-M4,
//! M7, M55, and M33 that have them).
#![allow(unsafe_code)]

use super::segment::{BITS, Run};
use crate::dsp::ONE;
use core::arch::asm;
use core::cell::Cell;
use core::ops::Range;

/// Steps of a position per pixel, beside the pixel's own column, of which four stay within half of a
/// half-word.
const GENTLE: i32 = 1 << (BITS - 2);

/// The most fours at once: `r6` counts them in its highest byte.
const MOST_FOURS: usize = 128;
/// The longest lines: the offset of a load is less than 4096.
const LONGEST: usize = 4000;

/// An instruction and its operands.
macro_rules! op {
    ($name:literal, $first:literal $(, $other:literal)*) => {
        concat!($name, " ", $first, $(", ", $other,)* "\n")
    };
}

/// The pixel between two columns, each with its upper pixel in the low half-word and its lower one in the
/// high one: in the high half-word of `$left`. The fractions of its place, of which only the upper 8 bits
/// count, are `$along` and `$down` as `ubfx` takes them. What is in the highest byte of `r6` does not count.
/// 8 instructions.
macro_rules! pixel {
    ($left:literal, $right:literal, $weights:literal, $fraction:literal, $along:literal, $down:literal) => {
        concat!(
            // 256 less the fraction above, the fraction below.
            op!("ubfx", $weights, $down, "#8"),
            op!("mla", $weights, $weights, "r4", "r5"),
            op!("smlad", $left, $left, $weights, "r6"),
            op!("smlad", $weights, $right, $weights, "r6"),
            op!("sub", $weights, $weights, $left),
            op!("ubfx", $fraction, $along, "#8"),
            op!("lsl", $left, $left, "#8"),
            op!("mla", $left, $weights, $fraction, $left),
        )
    };
}

/// [`pixel`] with the fractions in `r2`.
macro_rules! in_step {
    ($left:literal, $right:literal, $weights:literal, $fraction:literal) => {
        pixel!($left, $right, $weights, $fraction, "r2, #7", "r2, #23")
    };
}

/// [`pixel`] `$k` of four, between its column and the next from `r12` on: 13 instructions.
macro_rules! between {
    ($k:literal, $left:literal, $weights:literal, $along:literal, $down:literal) => {
        concat!(
            concat!("ldrh lr, [r12, #{width} + ", $k, "]\n"),
            concat!("ldrh r12, [r12, #", $k, "]\n"),
            "orr r12, r12, lr, lsl #16\n",
            op!("uxtb16", $left, "r12"),
            "uxtb16 r12, r12, ror #8\n",
            pixel!($left, "r12", $weights, "r12", $along, $down),
        )
    };
}

/// [`pixel`] `$k` of four between the first one's two rows, one column further if its fraction along
/// overflows: 16 instructions.
macro_rules! apart {
    ($k:literal, $left:literal) => {
        concat!(
            "ubfx r12, r2, #15, #1\n",
            "add r12, r0, r12\n",
            between!($k, $left, "lr", "r2, #7", "r2, #23"),
            "add r2, r2, r3\n",
        )
    };
}

/// [`pixel`] `$k` of four at the place in `r8` and `r9`, which goes on by `r10` and `r11`, between the first
/// one's two rows or a row further down: 19 instructions.
macro_rules! anywhere {
    ($k:literal, $left:literal, $weights:literal) => {
        concat!(
            "add r12, r0, r8, asr #15\n",
            "tst r9, #0x8000\n",
            "it ne\n",
            "addne r12, r12, #{width}\n",
            between!($k, $left, $weights, "r8, #7", "r9, #7"),
            "add r8, r8, r10\n",
            "add r9, r9, r11\n",
        )
    };
}

/// Two pixels from `$k` and `$next` on, written: 41 instructions.
macro_rules! two_anywhere {
    ($k:literal, $next:literal) => {
        concat!(
            anywhere!($k, "r2", "r3"),
            anywhere!($next, "r3", "lr"),
            "pkhtb r2, r3, r2, asr #16\n",
            "orr r2, r2, r2, lsr #8\n",
            "strh r2, [r1], #2\n",
        )
    };
}

/// On to the next four, if there is one: written where each way to four pixels ends, a branch fewer.
macro_rules! next_four {
    () => {
        concat!("add r3, r3, r7\n", "subs r6, r6, #0x1000000\n", "bhs 2b\n")
    };
}

/// Interpolates pixels in fours, the first at index `at` of lines of `W` pixels, at places in these runs;
/// returns how many fours it did. It stops before one that reaches into rows beyond the lines, and does none
/// where steps are not gentle or places may leave the lines.
///
/// 57 instructions for four pixels that are a raw column apart between the same two rows, 83 where they are
/// not a column apart, about 113 where they lie within three rows.
///
/// ```text
/// r0, r1       the first pixel's upper left neighbour, where the pixel goes
/// r2, r3       fractions along and down in half-words of 15 bits and one that overflows, and their steps
/// r4, r5, r7   65535, 256, what the steps grow by
/// r6           128, and in the highest byte how many fours are left after this
/// ```
#[inline(always)]
pub(super) fn fours<const W: usize>(
    lines: &[u8],
    at: usize,
    [column, row]: [&Run; 2],
    out: &[[Cell<u8>; 4]],
) -> usize {
    let count = out.len().min(MOST_FOURS);
    let [last_column, last_row] = [column, row].map(|run| run.after(count as i32));
    let one = 1 << BITS;
    // Nothing above the lower bits but the sign in each step beside the pixel's own column.
    let steps = [column.step.wrapping_sub(one), last_column.step.wrapping_sub(one), row.step, last_row.step];
    let is_gentle = steps.map(|step| step ^ (step >> 31)).iter().fold(0, |bits, step| bits | step) < GENTLE;
    // Columns from the first to the one to the right of the last.
    let columns = (last_column.start >> BITS).wrapping_sub(column.start >> BITS).wrapping_add(2);
    let most = lines.len().wrapping_sub(W).wrapping_sub(columns as usize);
    if W > LONGEST || count == 0 || !is_gentle || most > lines.len() || at > most {
        return 0;
    }
    // All are even.
    let halves = |along: i32, down: i32| (along >> 1).wrapping_add(down << 15);
    let fraction = |place: i32| place & (one - 1);
    let others: usize;
    // SAFETY: the loop counts the highest byte of `r6` down from one less than the number of fours. It writes
    // four pixels at a time to `out`, which has so many. It reads two rows from the first pixel on, up to the
    // column to the right of the last one: the places of all fours, whose steps are not negative, lie within
    // `columns`. So they do in the row above, which is only gone to where it is not before the first line,
    // and in the one below, where the first pixel lies a row before `most`. The stack and the two registers
    // that no operand may be are left as they were.
    unsafe {
        asm!(
            "push {{r6, r7, r9, r10}}",
            "mov r6, #128",
            "add r6, r6, r8, lsl #24",
            "mov r7, r11",
            "movw r4, #65535",
            "mov r5, #256",
            "2:",
            // Whether a fraction overflows before the next four.
            "add lr, r2, r3, lsl #2",
            "tst lr, #0x80008000",
            "bne 4f",
            "ldr r8, [r0]",
            "ldr r9, [r0, #{width}]",
            "pkhbt r10, r8, r9, lsl #16",
            "pkhtb r9, r9, r8, asr #16",
            "uxtb16 r8, r10",
            "uxtb16 r10, r10, ror #8",
            in_step!("r8", "r10", "r11", "r12"),
            "add r2, r2, r3",
            "uxtb16 r11, r9",
            in_step!("r10", "r11", "r12", "lr"),
            "add r2, r2, r3",
            "uxtb16 r9, r9, ror #8",
            in_step!("r11", "r9", "r12", "lr"),
            "pkhtb r8, r11, r8, asr #16",
            "add r2, r2, r3",
            "ldrb r11, [r0, #4]!",
            "ldrb lr, [r0, #{width}]",
            "orr r11, r11, lr, lsl #16",
            in_step!("r9", "r11", "r12", "lr"),
            "pkhtb r9, r9, r10, asr #16",
            "orr r8, r8, r9, lsl #8",
            "str r8, [r1], #4",
            "add r2, r2, r3",
            next_four!(),
            "b 8f",
            // Where columns come closer, from the column before on, with a fraction that overflows.
            "4:",
            "ubfx lr, r3, #15, #1",
            "add r2, r2, lr, lsl #15",
            "sub r0, r0, lr",
            "adds lr, r2, r3, lsl #2",
            "bmi 5f",
            apart!("0", "r8"),
            apart!("1", "r9"),
            apart!("2", "r10"),
            "pkhtb r8, r10, r8, asr #16",
            apart!("3", "r10"),
            "pkhtb r9, r10, r9, asr #16",
            "orr r8, r8, r9, lsl #8",
            "str r8, [r1], #4",
            "add r0, r0, #4",
            "ubfx lr, r2, #15, #1",
            "add r0, r0, lr",
            "bic r2, r2, #0x8000",
            next_four!(),
            "b 8f",
            // The four ends a row below or above: fractions and steps in a register each, and whether that
            // row is among the lines.
            "5:",
            "uxth r8, r2",
            "lsr r9, r2, #16",
            "sxth r10, r3",
            "sub r11, r3, r10",
            "asrs r11, r11, #16",
            "bmi 6f",
            "ldr lr, [sp, #12]",
            "cmp r0, lr",
            "bhi 8f",
            "b 7f",
            "6:",
            "sub r0, r0, #{width}",
            "ldr lr, [sp, #8]",
            "cmp r0, lr",
            "blo 8f",
            "add r9, r9, #0x8000",
            "7:",
            two_anywhere!("0", "1"),
            two_anywhere!("2", "3"),
            "tst r9, #0x8000",
            "it ne",
            "addne r0, r0, #{width}",
            "add r0, r0, r8, asr #15",
            "add r0, r0, #4",
            "ubfx r2, r8, #0, #15",
            "bfi r2, r9, #16, #15",
            "add r3, r10, r11, lsl #16",
            next_four!(),
            // How many are left, none where the count went below 0.
            "8:",
            "add r0, r6, #0x1000000",
            "lsr r0, r0, #24",
            "pop {{r6, r7, r9, r10}}",
            width = const if W > LONGEST { LONGEST } else { W },
            inout("r0") lines.as_ptr().wrapping_add(at) => others,
            inout("r1") out.as_ptr() => _,
            inout("r2") halves(fraction(column.start), fraction(row.start)) => _,
            inout("r3") halves(column.step.wrapping_sub(one), row.step) => _,
            inout("r8") count.wrapping_sub(1) => _,
            in("r9") lines.as_ptr(),
            in("r10") lines.as_ptr().wrapping_add(most).wrapping_sub(W + 1),
            inout("r11") halves(column.bend, row.bend) => _,
            out("r4") _, out("r5") _, out("r12") _, out("lr") _,
        );
    }
    count.wrapping_sub(others)
}

/// Fills a mask with ones, 32 bytes in four instructions: where there is no library for it, the compiler's
/// own takes an instruction for each byte.
#[inline(always)]
pub(super) fn fill_with_ones(mask: &mut [u8]) {
    // SAFETY: any bytes are words, and words are bytes.
    let (before, words, after) = unsafe { mask.align_to_mut::<[u32; 8]>() };
    for one in before.iter_mut().chain(after) {
        *one = 1;
    }
    if words.is_empty() {
        return;
    }
    let Range { start, end } = words.as_mut_ptr_range();
    // SAFETY: 32 bytes at a time from the first to the last, which is not before it.
    unsafe {
        asm!(
            "2:",
            "stm {at}!, {{r2, r3, r4, r5}}",
            "stm {at}!, {{r2, r3, r4, r5}}",
            "cmp {at}, {end}",
            "bne 2b",
            at = inout(reg) start => _, end = in(reg) end,
            in("r2") ONE, in("r3") ONE, in("r4") ONE, in("r5") ONE,
            options(nostack),
        );
    }
}
