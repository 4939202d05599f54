//! The winner of a pixel's sums.
#![allow(unsafe_code)]

use crate::matching::backend::portable::sgm::quarters::columns::FOUR;
use crate::matching::backend::portable::sgm::quarters::lanes::NO_SUM;
use crate::matching::memory::winners::Found;
use core::arch::asm;

/// See `plain`.
#[inline(always)]
pub fn winner([path, sums]: [&[u32]; 2], candidates: usize, more: u32) -> Found {
    let count = path.len();
    if count == 0 || !count.is_multiple_of(FOUR) || sums.len() < count {
        return Found { disparity: 0, cost: 0, beside: (0, 0) };
    }
    // SAFETY: there are as many words of both, whole rounds and one at least.
    let found = unsafe { least_sum(path.as_ptr(), sums.as_ptr(), count as u32, candidates as u32, more) };
    let [below, cost, above, disparity] = found.to_le_bytes();
    Found { disparity, cost, beside: (below, above) }
}

/// [`winner`], from the lowest byte up the cost below it, its own, the cost above it, and the disparity: 78
/// instructions, and 93.
///
/// # Safety
/// `count` words of path and sums can be read, whole rounds and one at least.
#[inline(never)]
unsafe fn least_sum(path: *const u32, sums: *const u32, count: u32, candidates: u32, more: u32) -> u32 {
    /// Makes the least of half the lanes in `$marked`, which is one word older, that of it and those in `r6`.
    /// 6 instructions.
    macro_rules! lesser_sum {
        ($marked:literal) => {
            concat!(
                op!("add", $marked, $marked, "#0x00010001"),
                op!("sub", "r6", $marked, "r6", "lsl #6"),
                op!("and", "r7", "r6", "#0x80008000"),
                op!("sub", "r7", "r7", "r7", "lsr #15"),
                op!("and", "r6", "r6", "r7"),
                op!("sub", $marked, $marked, "r6"),
            )
        };
    }
    /// A word of the path and one of sums. 18 instructions.
    macro_rules! word {
        ($path:literal, $sums:literal) => {
            concat!(
                op!("and", "r6", $path, "#0x00ff00ff"),
                op!("and", "r7", $sums, "#0x00ff00ff"),
                op!("add", "r6", "r6", "r7"),
                lesser_sum!("r10"),
                op!("and", "r6", "lr", $path, "lsr #8"),
                op!("and", "r7", "lr", $sums, "lsr #8"),
                op!("add", "r6", "r6", "r7"),
                lesser_sum!("r11"),
            )
        };
    }
    /// The key of a lane in `r3`, of its sum and place, above the lane and the place: the least so far is in
    /// `r12`. 7 instructions.
    macro_rules! lane {
        ($half:literal, $sum:literal, $place:literal, $lane:literal) => {
            concat!(
                op!("ubfx", "r3", $half, $sum, "#9"),
                op!("ubfx", "r4", $half, $place, "#6"),
                op!("orr", "r4", "r4", $lane),
                op!("orr", "r3", "r4", "r3", "lsl #8"),
                "cmp r3, r12\n it lo\n movlo r12, r3\n",
            )
        };
    }
    /// The cost of the candidate so many bytes behind `r8` in both columns, up to 255. 7 instructions.
    macro_rules! cost {
        ($cost:literal, $place:literal) => {
            concat!(
                concat!("ldrb ", $cost, ", [r0, ", $place, "]\n"),
                concat!("ldrb r7, [r1, ", $place, "]\n"),
                op!("add", $cost, $cost, "r7"),
                op!("sub", $cost, $cost, "lr"),
                op!("cmp", $cost, "#255"),
                "it hi\n",
                op!("movhi", $cost, "#255"),
            )
        };
    }
    let found;
    // SAFETY: as the caller says; what is kept on the stack is taken back.
    unsafe {
        asm!(
            "push {{r6, r7}}",
            "push {{r0, r1, r2, r4, r5}}",
            "1:",
            "ldrd r4, r5, [r0], #8",
            "ldrd r8, r9, [r1], #8",
            word!("r4", "r8"),
            word!("r5", "r9"),
            "ldrd r4, r5, [r0], #8",
            "ldrd r8, r9, [r1], #8",
            word!("r4", "r8"),
            word!("r5", "r9"),
            "subs r2, r2, #4",
            "bne 1b",
            "mvn r12, #0",
            lane!("r10", "#6", "#0", "#0xc0"),
            lane!("r11", "#6", "#0", "#0x80"),
            lane!("r10", "#22", "#16", "#0x40"),
            lane!("r11", "#22", "#16", "#0"),
            // Path, sums, words; candidates; what sums are more.
            "pop {{r0, r1, r2, r5, lr}}",
            // The cost, the place in the lane, and the lane, counted from the last ones.
            "lsr r3, r12, #8",
            "sub r3, r3, lr",
            "cmp r3, #255",
            "it hi",
            "movhi r3, #255",
            "and r9, r12, #63",
            "ubfx r10, r12, #6, #2",
            "mla r12, r10, r2, r9",
            // The candidate's byte in a column, and how far the next lane's first one is from a lane's last.
            "sub r2, r2, #1",
            "sub r8, r2, r9",
            "rsb r10, r10, #3",
            "add r8, r10, r8, lsl #2",
            "lsl r11, r2, #2",
            "sub r11, r11, #1",
            // The places above and below it.
            "cmp r9, r2",
            "ite eq",
            "addeq r10, r8, r11",
            "subne r10, r8, #4",
            "cmp r9, #0",
            "ite eq",
            "subeq r11, r8, r11",
            "addne r11, r8, #4",
            cost!("r8", "r10"),
            cost!("r9", "r11"),
            // Where there is none the other one, and where that is none either the winner's.
            "cmp r12, #0",
            "it eq",
            "moveq r9, r3",
            "add r10, r12, #1",
            "cmp r10, r5",
            "it hs",
            "movhs r8, r9",
            "cmp r12, #0",
            "it eq",
            "moveq r9, r8",
            "orr r0, r9, r3, lsl #8",
            "orr r0, r0, r8, lsl #16",
            "orr r0, r0, r12, lsl #24",
            "pop {{r6, r7}}",
            inout("r0") path => found, inout("r1") sums => _, inout("r2") count => _,
            inout("r4") candidates => _, inout("r5") more => _, out("r3") _, out("r8") _, out("r9") _,
            inout("r10") NO_SUM => _, inout("r11") NO_SUM => _, out("r12") _,
            inout("lr") 0x00ff_00ff => _,
        );
    }
    found
}
