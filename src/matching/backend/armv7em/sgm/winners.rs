//! The least sums of three paths.
#![allow(unsafe_code)]

use super::blocks;
use crate::matching::backend::loops::fill_bytes;
use crate::matching::backend::work::PathWork;
use crate::matching::memory::slices::part_mut;
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::BESIDE;
use crate::matching::memory::winners::{Found, Unique, Winner};
use core::arch::asm;

/// The least of each byte of two words at a time, which `$load` puts in `r5` and `r6`, in `r2`, with the
/// words that are left after it in `r3`, of equal ones the fewest. `$sub` counts them in `r4`.
macro_rules! winners {
    ($load:literal $sub:literal) => {
        concat!(
            $load,
            "
         usub8 r7, r2, r5
         sel r2, r5, r2
         sel r3, r4, r3
         sub r4, r4, #0x01010101
         usub8 r7, r2, r6
         sel r2, r6, r2
         sel r3, r4, r3
         ",
            $sub,
            " r4, r4, #0x01010101"
        )
    };
}

/// Selects the winner of every pixel that has a candidate. A column has `stride` bytes, a multiple of 16 and
/// 256 at the most.
#[inline(always)]
pub(super) fn select(
    work: &mut PathWork<'_>,
    stride: usize,
    mut unique: Unique<'_>,
    mut put: impl FnMut(usize, Found),
) {
    let (begin, fours) = (work.min_disparity.min(work.width), stride / 16);
    let mut columns = part_mut(work.sums, begin * stride..);
    for x in begin..work.width {
        let Some((sums, rest)) = columns.split_at_mut_checked(stride) else { return };
        columns = rest;
        // The first pixels have fewer candidates than there are lanes.
        let candidates = work.disparities.min(x + 1 - begin);
        if candidates < stride {
            fill_bytes(part_mut(sums, ..stride - candidates), u8::MAX);
        }
        // SAFETY: that many words are the sums, and they stand where words may.
        let least = |sums: &[u8]| unsafe { blocks::least(sums.as_ptr().cast(), fours) };
        let (cost, lane) = least(sums);
        let at = |lane: usize| sums.get(lane.min(stride - 1)).copied().unwrap_or(0);
        let (below, above) = (at(lane + 1), at(lane.saturating_sub(1)));
        let disparity = (stride - 1).wrapping_sub(lane);
        let (is_below, is_above) = (disparity > 0, disparity + 1 < candidates);
        // At an end the one beside it that there is; beside an only candidate, itself (which `below` is
        // then).
        let beside =
            (if is_below || !is_above { below } else { above }, if is_above { above } else { below });
        put(x, Found { disparity: disparity as u8, cost, beside });
        unique.check(
            x,
            cost,
            #[inline(always)]
            || {
                let beside = lane.saturating_sub(BESIDE)..(lane + BESIDE + 1).min(stride);
                fill_bytes(part_mut(sums, beside), u8::MAX);
                least(sums).0
            },
        );
    }
}

/// [`select`] where nothing is asked of the second best: the loop over pixels is in assembly.
#[inline(always)]
pub(super) fn select_words(work: &mut PathWork<'_>, stride: usize, winners: &mut [Winner]) {
    let begin = work.min_disparity.min(work.width);
    let winners = part_mut(winners, begin..work.width);
    let (count, most) = (winners.len(), work.disparities.min(stride));
    let sums = view_mut::<u8, u32>(part_mut(work.sums, begin * stride..));
    if count == 0 || most == 0 || sums.len() < count * stride / 4 {
        return;
    }
    // SAFETY: so many columns of `stride` bytes, a multiple of 16, are the sums.
    unsafe { close(sums.as_mut_ptr(), count, stride, stride - most) };
    // SAFETY: as above.
    unsafe { least_sums(sums.as_ptr(), winners, stride as u32 / 4, most as u32 - 1) };
}

/// Makes the sums 255 that are of no candidate: the first pixels have fewer than there are lanes, one in
/// the first column and one more in the next, and all have none in the first `beyond` lanes. 18
/// instructions for a column that has such lanes, and 3 for four of them.
///
/// # Safety
/// `count` columns of `stride` bytes, whole words and more than `beyond`, can be read from `sums` on and
/// written; neither is 0.
#[inline(never)]
unsafe fn close(sums: *mut u32, count: usize, stride: usize, beyond: usize) {
    // SAFETY: of a column fewer than `stride` bytes are put, and the word behind them written back.
    unsafe {
        asm!(
            "1:",
            "cmp r0, {beyond}",
            "it lt",
            "movlt r0, {beyond}",
            "cbz r0, 4f",
            "mov {at}, {column}",
            "subs {rest}, r0, #4",
            "blo 3f",
            "2:",
            "str {ones}, [{at}], #4",
            "subs {rest}, {rest}, #4",
            "bhs 2b",
            "3:",
            "and {rest}, r0, #3",
            "lsl {rest}, {rest}, #3",
            "lsl {rest}, {ones}, {rest}",
            "ldr {word}, [{at}]",
            "orn {word}, {word}, {rest}",
            "str {word}, [{at}]",
            "add {column}, {column}, {stride}",
            "sub r0, r0, #1",
            "subs {count}, {count}, #1",
            "bne 1b",
            "4:",
            column = inout(reg) sums => _, count = inout(reg) count => _, stride = in(reg) stride,
            beyond = in(reg) beyond, inout("r0") stride - 1 => _, ones = in(reg) u32::MAX,
            at = out(reg) _, rest = out(reg) _, word = out(reg) _,
            options(nostack),
        );
    }
}

/// The winners of columns of sums. 40 instructions for a pixel and 9 for eight candidates. The first
/// column has one candidate, the next one more, up to `last` and one.
///
/// The least byte of each of a word's four is found with the word where it is; then of two and two that of
/// the least half-word, a sum over its disparity.
///
/// # Safety
/// For each winner a column of `words` words, a multiple of four, can be read from `sums` on; neither
/// number is 0.
#[inline(never)]
unsafe fn least_sums(sums: *const u32, winners: &mut [Winner], words: u32, last: u32) {
    let ends = winners.as_mut_ptr_range();
    // SAFETY: the columns are read, and a winner written for each. The bytes beside the least sum are read
    // where they are candidates of its column. `r6` and `r7`, which are the compiler's, are put back.
    unsafe {
        asm!(
            // r0 sums, r10 winners, r9 their end; r11 the last candidate, r12 that of a whole column
            "push {{r6, r7}}",
            "1:",
            "mvn r2, #0",
            "mov r4, r8",
            "2:",
            winners!("ldrd r5, r6, [r0], #8" "sub"),
            winners!("ldrd r5, r6, [r0], #8" "subs"),
            "bhs 2b",
            // Disparities of the four.
            "add r3, lr, r3, lsl #2",
            "uxtb16 r5, r2",
            "uxtb16 r6, r3",
            "orr r5, r6, r5, lsl #8",
            "uxtb16 r2, r2, ror #8",
            "uxtb16 r3, r3, ror #8",
            "orr r3, r3, r2, lsl #8",
            "usub16 r7, r5, r3",
            "sel r5, r3, r5",
            "ror r3, r5, #16",
            "usub16 r7, r5, r3",
            "sel r5, r3, r5",
            "uxtb r6, r5",
            "ubfx r2, r5, #8, #8",
            // Beside the winner, on both sides what there is on one; beside an only candidate, itself.
            "sub r7, r0, r6",
            "cmp r6, r11",
            "ite lo",
            "ldrblo r3, [r7, #-2]",
            "movhs r3, r2",
            "cmp r6, #0",
            "ite ne",
            "ldrbne r1, [r7]",
            "moveq r1, r3",
            "cmp r6, r11",
            "it hs",
            "movhs r3, r1",
            "orr r1, r1, r2, lsl #8",
            "orr r1, r1, r3, lsl #16",
            "orr r1, r1, r6, lsl #24",
            "str r1, [r10], #4",
            "add r11, r11, #1",
            "cmp r11, r12",
            "it hi",
            "movhi r11, r12",
            "cmp r10, r9",
            "bne 1b",
            "pop {{r6, r7}}",
            inout("r0") sums => _,
            in("r8") (words - 1) * 0x0101_0101,
            in("r9") ends.end,
            inout("r10") ends.start => _,
            inout("r11") 0 => _,
            in("r12") last,
            in("lr") 0x0001_0203,
            out("r1") _, out("r2") _, out("r3") _, out("r4") _, out("r5") _,
        );
    }
}
