//! Rounds in the instructions of a Cortex-M3, which know no bytes side by side: `plain` says what each makes.
//! Each is a function that stands alone, for its registers are all that there are. What is said of
//! instructions is for four words.
//!
//! `0x80808080` is the top bit of each lane. A constant of the same byte four times is part of an instruction,
//! a shift as well: numbers are cut out first and shifted where they are used.
#![allow(unsafe_code)]

use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::quarters::columns::FOUR;
use crate::matching::backend::portable::sgm::quarters::cost::Costs;
use crate::matching::backend::portable::sgm::quarters::others::{NUMBERS, Others};
use crate::matching::backend::portable::sgm::quarters::steps::Steps;
use crate::matching::memory::winners::Found;
use core::arch::asm;
use core::cell::Cell;

/// One instruction.
macro_rules! op {
    ($name:literal, $first:literal $(, $other:literal)*) => {
        concat!($name, " ", $first, $(", ", $other,)* "\n")
    };
}

/// Makes `$over` what the first of two numbers, a marked one, is over the second, of their `$difference`. 3
/// instructions.
macro_rules! over {
    ($over:literal, $difference:literal) => {
        concat!(
            op!("and", $over, $difference, "#0x80808080"),
            op!("sub", $over, $over, $over, "lsr #7"),
            op!("and", $over, $over, $difference),
        )
    };
}

/// Makes the marked number the lesser of it and another one. 5 instructions.
macro_rules! lesser {
    ($marked:literal, $other:literal) => {
        concat!(op!("sub", "r10", $marked, $other), over!("r11", "r10"), op!("sub", $marked, $marked, "r11"),)
    };
}

/// Makes the word before what it costs to come to the word here; the step is in `r4`, the bound in `r5`. 16
/// instructions.
macro_rules! come {
    ($before:literal, $here:literal, $next:literal) => {
        concat!(
            op!("orr", $before, $before, "#0x80808080"),
            lesser!($before, $next),
            op!("add", $before, $before, "r4"),
            lesser!($before, $here),
            op!("sub", $before, $before, "r5"),
            op!("and", "r10", $before, "#0x80808080"),
            op!("sub", "r10", "r10", "r10", "lsr #7"),
            op!("bic", $before, $before, "r10"),
        )
    };
}

/// Of the words in turn `before`, `here` and `next`, the last of a round: what is after it, or behind the
/// column in `r0` where the count in `r12` says that it was the last round.
macro_rules! last_of_four {
    ($next:literal, $place:literal) => {
        concat!("subs r12, r12, #1\n", "ite ne\n", op!("ldrne", $next, $place), op!("moveq", $next, "r0"))
    };
}

/// Makes a word of the same byte four times of a number. 2 instructions.
macro_rules! splat {
    ($number:literal) => {
        concat!(
            op!("orr", $number, $number, $number, "lsl #8"),
            op!("orr", $number, $number, $number, "lsl #16"),
        )
    };
}

/// Makes `r0` the least of the marked numbers in `lr`. 12 instructions.
macro_rules! least_of_four {
    () => {
        concat!(
            op!("lsr", "r0", "lr", "#16"),
            op!("bic", "r0", "r0", "#0x80808080"),
            lesser!("lr", "r0"),
            op!("and", "r0", "lr", "#0x7f"),
            op!("ubfx", "lr", "lr", "#8", "#7"),
            "cmp r0, lr\n it hi\n movhi r0, lr\n",
        )
    };
}

/// Of the [`Steps`] at `r0`, the change of brightness in `lr`, the least in `r12` and the column at `r2`: the
/// step in `r4`, what a jump costs in `r6` and the bound in `r5`, what is behind the column in `r0`, before it
/// in `r8`, its first word in `r9` and its rounds in `r12`; `$base`, which may look at `r0`, goes before the
/// last ones. 22 instructions and that.
macro_rules! begin {
    ($base:literal) => {
        concat!(
            "ldrd r10, r11, [r0, #8]\n add r9, r0, #16\n",
            "cmp lr, r10\n it hs\n addhs r9, r9, #8\n cmp lr, r11\n it hs\n addhs r9, r9, #8\n",
            "ldrd r4, r6, [r9]\n add r5, r6, r12\n",
            splat!("r5"),
            $base,
            "ldrd r10, r12, [r0]\n ldr r9, [r2]\n",
            "add r11, r2, r12, lsl #4\n ldr r11, [r11, #-4]\n orr r8, r10, r11, lsl #8\n",
            "lsl r10, r10, #24\n orr r0, r10, r9, lsr #8\n",
        )
    };
}

/// What assembly takes of the costs, in this order.
#[repr(C)]
struct Row {
    margin: u32,
    others: *const Others,
    rounds: usize,
    most: u32,
    /// The left image's features of three kinds, one `width` behind the other, and its brightness.
    looks: *const u8,
    brightness: *const u8,
    width: usize,
    pixels: usize,
}

/// See `plain`.
#[inline(always)]
pub fn enter<S: SgmParameters>(costs: &Costs<'_>, x: usize, others: &[Others], columns: &mut [u32]) {
    let Costs { left, rounds, most, margin } = *costs;
    let (words, width) = (FOUR * rounds, left.brightness.len());
    let pixels = columns.len() / words.max(1);
    let is_there = x + pixels <= width && 3 * width <= left.rows.len() && pixels + words <= others.len() + 1;
    if words == 0 || pixels == 0 || !is_there {
        return;
    }
    let looks = left.rows.as_ptr().wrapping_add(x);
    let brightness = left.brightness.as_ptr().wrapping_add(x);
    let others = others.as_ptr();
    let mut row = Row { margin, others, rounds, most, looks, brightness, width, pixels };
    // SAFETY: so many pixels from `x` on have all they look like; the last one's others are there, as all
    // pixels' columns.
    unsafe {
        if S::WITHIN_EDGES {
            put_agreements(&mut row, columns.as_mut_ptr());
        } else {
            average_agreements(&mut row, columns.as_mut_ptr());
        }
    }
}

/// The agreement of a pixel with the four at `r1`, with the margin, in `r9`. 41 instructions.
macro_rules! agreement {
    () => {
        concat!(
            // Least and greatest gradient, that across, census.
            "ldm r1!, {{r9, r10, r11, r12}}\n",
            op!("sub", "r9", "r9", "r4"),
            over!("lr", "r9"),
            op!("add", "r10", "r10", "r4"),
            over!("r9", "r10"),
            op!("orr", "r9", "r9", "lr"),
            op!("sub", "r11", "r5", "r11"),
            over!("lr", "r11"),
            op!("add", "r9", "r9", "lr"),
            op!("sub", "r9", "r8", "r9", "lsl #1"),
            op!("add", "r9", "r9", "r11"),
            // Bits of the census.
            op!("eor", "r12", "r12", "r6"),
            op!("and", "lr", "r12", "#0xaaaaaaaa"),
            op!("sub", "r12", "r12", "lr", "lsr #1"),
            op!("and", "lr", "r12", "#0xcccccccc"),
            op!("and", "r12", "r12", "#0x33333333"),
            op!("add", "r12", "r12", "lr", "lsr #2"),
            op!("add", "r12", "r12", "r12", "lsr #4"),
            op!("and", "r12", "r12", "#0x0f0f0f0f"),
            op!("sub", "r9", "r9", "r12"),
            // A quarter of the brightness.
            op!("ldr", "r10", "[r1], #4"),
            op!("sub", "r10", "r7", "r10"),
            over!("lr", "r10"),
            op!("rsb", "r10", "r10", "lr", "lsl #1"),
            op!("add", "r10", "r10", "#0x80808080"),
            op!("and", "r10", "r10", "#0xfcfcfcfc"),
            op!("sub", "r10", "r9", "r10", "lsr #2"),
            over!("r9", "r10"),
            op!("add", "r9", "r9", "r0"),
        )
    };
}

/// The loops over pixels and the words of their columns, which `$put` an agreement that is in `r9` in their
/// place at `r2`.
macro_rules! agreements {
    ($(#[$doc:meta])* $name:ident, $put:literal) => {
        $(#[$doc])*
        ///
        /// # Safety
        /// What `row` says is there, and columns of its pixels, which are not 0, as its rounds.
        #[inline(never)]
        unsafe fn $name(row: &mut Row, columns: *mut u32) {
            // SAFETY: as the caller says; what is kept on the stack is taken back.
            unsafe {
                asm!(
                    "push {{r0, r6, r7}}",
                    "1:",
                    // The pixel's margin, others, rounds and most, and what it looks like, four times.
                    "ldr lr, [sp]",
                    "ldm lr, {{r0, r1, r3, r8, r9, r10, r11}}",
                    "ldrb r4, [r9]",
                    "ldrb r5, [r9, r11]",
                    "add r12, r9, r11",
                    "ldrb r6, [r12, r11]",
                    "add r9, r9, #1",
                    "ldrb r7, [r10], #1",
                    "strd r9, r10, [lr, #16]",
                    "add r9, r1, #{group}",
                    "str r9, [lr, #4]",
                    "lsr r7, r7, #1",
                    concat!(splat!("r4"), splat!("r5"), splat!("r6"), splat!("r7")),
                    "orr r5, r5, #0x80808080",
                    "orr r7, r7, #0x80808080",
                    "2:",
                    concat!(agreement!(), $put, agreement!(), $put, agreement!(), $put, agreement!(), $put),
                    "subs r3, r3, #1",
                    "bne 2b",
                    "ldr lr, [sp]",
                    "ldr r0, [lr, #28]",
                    "subs r0, r0, #1",
                    "str r0, [lr, #28]",
                    "bne 1b",
                    "pop {{r0, r6, r7}}",
                    inout("r0") row => _, out("r1") _, inout("r2") columns => _, out("r3") _, out("r4") _,
                    out("r5") _, out("r8") _, out("r9") _, out("r10") _, out("r11") _, out("r12") _,
                    out("lr") _, group = const NUMBERS * size_of::<u32>(),
                );
            }
        }
    };
}

agreements! {
    /// Puts a row's agreements. 170 instructions, and 31 for a pixel.
    put_agreements, "str r9, [r2], #4\n"
}
agreements! {
    /// Averages a row's agreements into its columns. 186 instructions, and 31 for a pixel.
    average_agreements, "ldr lr, [r2]\n add r9, r9, lr\n and r9, r9, #0xfefefefe\n lsr r9, r9, #1\n str r9, [r2], #4\n"
}

/// See `plain`.
#[inline(always)]
pub fn along(
    steps: &Steps,
    (change, least): (u8, u32),
    costs: &[u32],
    from: &[Cell<u32>],
    to: &[Cell<u32>],
) -> (u32, u32) {
    let words = FOUR * steps.rounds;
    if words == 0 || costs.len() < words || from.len() < words || to.len() < words {
        return (0, 0);
    }
    let [from, to] = [from, to].map(|cells| cells.as_ptr().cast_mut().cast());
    // SAFETY: there are as many words of all three, and cells may be written.
    let both = unsafe { step_along(steps, costs.as_ptr(), from, to, change.into(), least) };
    (both as u32, (both >> 32) as u32)
}

/// [`along`], the least low: 103 instructions, and 45.
///
/// # Safety
/// All rounds of costs and of the column can be read, those where they go to written; there is one.
#[inline(never)]
unsafe fn step_along(
    steps: &Steps,
    costs: *const u32,
    from: *const u32,
    to: *mut u32,
    change: u32,
    least: u32,
) -> u64 {
    /// What the word is that was before, less its costs; and the least so far.
    macro_rules! put {
        ($path:literal) => {
            concat!(
                op!("ldr", "r10", "[r1], #4"),
                op!("sub", $path, $path, "r10"),
                op!("str", $path, "[r3], #4"),
                lesser!("lr", $path),
            )
        };
    }
    let (least_of_all, jump): (u32, u32);
    // SAFETY: as the caller says; what is kept on the stack is taken back.
    unsafe {
        asm!(
            "push {{r6, r7}}",
            begin!(""),
            "push {{r6}}",
            "mvn lr, #0",
            "1:",
            concat!(op!("ldr", "r6", "[r2, #4]!"), come!("r8", "r9", "r6"), put!("r8")),
            concat!(op!("ldr", "r7", "[r2, #4]!"), come!("r9", "r6", "r7"), put!("r9")),
            concat!(op!("ldr", "r8", "[r2, #4]!"), come!("r6", "r7", "r8"), put!("r6")),
            concat!(last_of_four!("r9", "[r2, #4]!"), come!("r7", "r8", "r9"), put!("r7")),
            "bne 1b",
            least_of_four!(),
            "pop {{r1, r6, r7}}",
            inout("r0") steps => least_of_all, inout("r1") costs => jump, inout("r2") from => _,
            inout("r3") to => _, inout("r12") least => _, inout("lr") change => _, out("r4") _, out("r5") _,
            out("r8") _, out("r9") _, out("r10") _, out("r11") _,
        );
    }
    u64::from(jump) << 32 | u64::from(least_of_all)
}

/// See `plain`.
#[inline(always)]
pub fn down(
    steps: &Steps,
    (change, least): (u8, u32),
    costs: &[u32],
    path: &[Cell<u32>],
    sums: &[Cell<u32>],
) {
    let words = FOUR * steps.rounds;
    if words == 0 || costs.len() < words || path.len() < words || sums.len() < words {
        return;
    }
    let [path, sums] = [path, sums].map(|cells| cells.as_ptr().cast_mut().cast());
    // SAFETY: there are as many words of all three, and cells may be written.
    unsafe { step_down(steps, costs.as_ptr(), path, sums, change.into(), least) }
}

/// [`down`], 99 instructions, and 32.
///
/// # Safety
/// All rounds of costs, path and sums can be read, the last two written; there is one.
#[inline(never)]
unsafe fn step_down(
    steps: &Steps,
    costs: *const u32,
    path: *mut u32,
    sums: *mut u32,
    change: u32,
    least: u32,
) {
    /// What the word is that was before, more by the base and less by its costs; and added to the sums.
    macro_rules! put {
        ($path:literal, $place:literal) => {
            concat!(
                op!("ldr", "r10", "[r1], #4"),
                op!("add", $path, $path, "lr"),
                op!("sub", $path, $path, "r10"),
                op!("str", $path, $place),
                op!("ldr", "r10", "[r3]"),
                op!("add", "r10", "r10", $path),
                op!("str", "r10", "[r3], #4"),
            )
        };
    }
    // SAFETY: as the caller says; what is kept on the stack is taken back.
    unsafe {
        asm!(
            "push {{r6, r7}}",
            // The base is that of no jump and one.
            begin!("ldr lr, [r0, #48]\n orr r6, r6, r6, lsl #8\n orr r6, r6, r6, lsl #16\n add lr, lr, r6\n"),
            "1:",
            concat!(op!("ldr", "r6", "[r2, #4]"), come!("r8", "r9", "r6"), put!("r8", "[r2], #16")),
            concat!(op!("ldr", "r7", "[r2, #-8]"), come!("r9", "r6", "r7"), put!("r9", "[r2, #-12]")),
            concat!(op!("ldr", "r8", "[r2, #-4]"), come!("r6", "r7", "r8"), put!("r6", "[r2, #-8]")),
            concat!(last_of_four!("r9", "[r2]"), come!("r7", "r8", "r9"), put!("r7", "[r2, #-4]")),
            "bne 1b",
            "pop {{r6, r7}}",
            inout("r0") steps => _, inout("r1") costs => _, inout("r2") path => _, inout("r3") sums => _,
            inout("r12") least => _, inout("lr") change => _, out("r4") _, out("r5") _, out("r8") _,
            out("r9") _, out("r10") _, out("r11") _,
        );
    }
}

/// See `plain`.
#[inline(always)]
pub fn average_two([one, other]: [&[Cell<u32>]; 2], to: &[Cell<u32>]) -> u32 {
    let words = to.len();
    if words < FOUR || one.len() < words || other.len() < words {
        return 0;
    }
    let [one, other] = [one, other].map(|cells| cells.as_ptr().cast());
    // SAFETY: there are as many words of all three as four a round, and cells may be written.
    unsafe { average_columns(one, other, to.as_ptr().cast_mut().cast(), words / FOUR) }
}

/// [`average_two`], 36 instructions, and 12.
///
/// # Safety
/// `count` rounds of both columns can be read, those where they go to written; it is not 0.
#[inline(never)]
unsafe fn average_columns(one: *const u32, other: *const u32, to: *mut u32, count: usize) -> u32 {
    /// Two words.
    macro_rules! two {
        () => {
            concat!(
                op!("ldrd", "r4", "r5", "[r0], #8"),
                op!("ldrd", "r8", "r9", "[r1], #8"),
                op!("add", "r4", "r4", "r8"),
                op!("add", "r5", "r5", "r9"),
                op!("and", "r4", "r12", "r4", "lsr #1"),
                op!("and", "r5", "r12", "r5", "lsr #1"),
                op!("strd", "r4", "r5", "[r2], #8"),
                lesser!("lr", "r4"),
                lesser!("lr", "r5"),
            )
        };
    }
    let least;
    // SAFETY: as the caller says.
    unsafe {
        asm!(
            "1:",
            two!(),
            two!(),
            "subs r3, r3, #1",
            "bne 1b",
            least_of_four!(),
            inout("r0") one => least, inout("r1") other => _, inout("r2") to => _, inout("r3") count => _,
            inout("lr") u32::MAX => _, in("r12") 0x7f7f_7f7f, out("r4") _, out("r5") _, out("r8") _,
            out("r9") _, out("r10") _, out("r11") _, options(nostack),
        );
    }
    least
}

/// See `plain`.
#[inline(always)]
pub fn winner([path, sums]: [&[u32]; 2], candidates: usize, more: u32) -> Found {
    let count = path.len();
    if count < FOUR || sums.len() < count {
        return Found { disparity: 0, cost: 0, beside: (0, 0) };
    }
    // SAFETY: there are as many words of both, whole rounds: columns have no other number.
    let found = unsafe { least_sum(path.as_ptr(), sums.as_ptr(), count as u32, candidates as u32, more) };
    let [below, cost, above, disparity] = found.to_le_bytes();
    Found { disparity, cost, beside: (below, above) }
}

/// [`winner`], from the lowest byte up the cost below it, its own, the cost above it, and the disparity: 82
/// instructions, and 75.
///
/// # Safety
/// `count` words of path and sums can be read, whole rounds and one at least.
#[inline(never)]
unsafe fn least_sum(path: *const u32, sums: *const u32, count: u32, candidates: u32, more: u32) -> u32 {
    /// Makes the least of half the lanes in `$marked` that of it and those in `r6`. 6 instructions.
    macro_rules! lesser_sum {
        ($marked:literal) => {
            concat!(
                op!("add", "r6", "r3", "r6", "lsl #6"),
                op!("sub", "r6", $marked, "r6"),
                op!("and", "r7", "r6", "#0x80008000"),
                op!("sub", "r7", "r7", "r7", "lsr #15"),
                op!("and", "r6", "r6", "r7"),
                op!("sub", $marked, $marked, "r6"),
            )
        };
    }
    /// A word of the path and one of sums. 19 instructions.
    macro_rules! word {
        ($path:literal, $sums:literal) => {
            concat!(
                op!("sub", "r3", "r3", "#0x00010001"),
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
    /// The cost of the candidate so many bytes behind `r8` in both columns, up to 255. 6 instructions.
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
            // Counted down: the number of a word.
            "orr r3, r2, r2, lsl #16",
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
            inout("r10") u32::MAX => _, inout("r11") u32::MAX => _, out("r12") _, inout("lr") 0x00ff_00ff => _,
        );
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::plain;
    use super::*;
    use crate::matching::backend::portable::sgm::features::Looks;
    use crate::matching::backend::portable::sgm::quarters::lanes::splat;
    use crate::matching::method::Sgm;
    use crate::matching::method::SgmEdge;
    use crate::matching::penalties::Penalties;

    /// Words of a column.
    const SIZES: [usize; 6] = [4, 8, 12, 16, 32, 64];
    const MOST: usize = 64;

    /// Bytes up to a bound, in words (Marsaglia's xorshift).
    struct Draw(u32);

    impl Draw {
        fn byte(&mut self, most: u32) -> u8 {
            for shift in [13, -17, 5] {
                self.0 ^= if shift > 0 { self.0 << shift } else { self.0 >> -shift };
            }
            ((self.0 >> 8) % (most + 1)) as u8
        }

        fn words<const N: usize>(&mut self, most: u32) -> [u32; N] {
            core::array::from_fn(|_| u32::from_le_bytes([0; 4].map(|_| self.byte(most))))
        }
    }

    fn cells(words: &mut [u32]) -> &[Cell<u32>] {
        Cell::from_mut(words).as_slice_of_cells()
    }

    /// Changes of brightness on both sides of every edge.
    fn changes(penalties: &Penalties) -> impl Iterator<Item = u8> {
        penalties.edges.into_iter().flat_map(|edge| [edge - 1, edge, edge + 1]).chain([0, 255])
    }

    #[test]
    fn paths_are_those_in_plain_rust() {
        let penalties = Penalties::DEFAULT;
        let mut draw = Draw(1);
        for words in SIZES {
            let steps = Steps::new(&penalties, words);
            for change in changes(&penalties) {
                // The margin at least; a path's costs are none under the least, and leave room for a step.
                let least = draw.byte(20).into();
                let costs = draw.words::<MOST>(16).map(|word| word + splat(19));
                let path = draw.words::<MOST>(89).map(|word| word + splat(least));
                let sums = draw.words::<MOST>(109);
                let from = (change, least);
                for in_place in [false, true] {
                    let [mut found, mut expected] = [(path, sums); 2];
                    let both = [
                        (along as fn(&_, _, &_, &_, &_) -> _, &mut found),
                        (plain::along as fn(&_, _, &_, &_, &_) -> _, &mut expected),
                    ];
                    let [found_least, expected_least] = both.map(|(along, (path, sums))| {
                        let path = cells(&mut path[..words]);
                        let to = if in_place { path } else { cells(&mut sums[..words]) };
                        along(&steps, from, &costs[..words], path, to)
                    });
                    assert_eq!((found, found_least), (expected, expected_least), "{words} {change}");
                }
                let [mut found, mut expected] = [(path, sums); 2];
                down(
                    &steps,
                    from,
                    &costs[..words],
                    cells(&mut found.0[..words]),
                    cells(&mut found.1[..words]),
                );
                let (path, sums) = &mut expected;
                plain::down(
                    &steps,
                    from,
                    &costs[..words],
                    cells(&mut path[..words]),
                    cells(&mut sums[..words]),
                );
                assert_eq!(found, expected, "{words} {change}");
            }
        }
    }

    #[test]
    fn averages_and_winners_are_those_in_plain_rust() {
        let mut draw = Draw(2);
        for words in SIZES {
            for most in [0, 1, 2, 50, 109] {
                let [mut one, mut other] = [0; 2].map(|_| draw.words::<MOST>(most));
                let candidates = usize::from(draw.byte(4 * words as u32 - 1)) + 1;
                // Lanes that are no candidate cost more, as where they are searched.
                let mut sums = draw.words::<MOST>(2 * most);
                for place in 0..4 * words - candidates {
                    let lane = 0xff << (8 * (place / words));
                    (one[place % words], sums[place % words]) =
                        (one[place % words] | lane, sums[place % words] | lane);
                }
                let found = winner([&one[..words], &sums[..words]], candidates, 0);
                let expected = plain::winner([&one[..words], &sums[..words]], candidates, 0);
                let parts = |found: Found| (found.disparity, found.cost, found.beside);
                assert_eq!(parts(found), parts(expected), "{words} {most} {candidates}");
                one = draw.words(most);
                let (mut in_plain, mut second) = ([0; MOST], [0; MOST]);
                let both = [cells(&mut one[..words]), cells(&mut other[..words])];
                let found = average_two(both, cells(&mut second[..words]));
                assert_eq!(found, plain::average_two(both, cells(&mut in_plain[..words])), "{words} {most}");
                assert_eq!(second, in_plain, "{words} {most}");
                assert_eq!(average_two(both, both[0]), found, "{words} {most}");
                assert_eq!(one[..words], in_plain[..words], "{words} {most}");
            }
        }
    }

    #[test]
    fn costs_are_those_in_plain_rust() {
        const WIDTH: usize = 11;
        let mut draw = Draw(3);
        for words in SIZES {
            let mut rows = [0; 3 * WIDTH];
            rows.iter_mut().enumerate().for_each(|(i, look)| {
                *look = draw.byte(if i < 2 * WIDTH { 14 } else { 255 });
            });
            let brightness: [u8; WIDTH] = core::array::from_fn(|_| draw.byte(255));
            let [along, across, census] = [0, 1, 2].map(|row| &rows[row * WIDTH..(row + 1) * WIDTH]);
            let left = Looks { rows: &rows, along, across, census, brightness: &brightness };
            let costs = Costs { left, rounds: words / FOUR, most: splat(16), margin: splat(19) };
            let others: [Others; MOST + WIDTH] = core::array::from_fn(|_| {
                let [[least], [wide], [across], [census], [brightness]] =
                    [7, 7, 14, 255, 127].map(|most| draw.words::<1>(most));
                // 128 less the greatest, which is no less than the least.
                [least | splat(128), splat(128) - least - wide, across, census, brightness]
            });
            for x in [0, 3, WIDTH - 1] {
                let columns = draw.words::<{ MOST * WIDTH }>(35).map(|word| word | splat(16));
                let [mut found, mut expected] = [columns; 2];
                let end = words * (WIDTH - x);
                enter::<Sgm>(&costs, x, &others[..words + WIDTH], &mut found[..end]);
                plain::enter::<Sgm>(&costs, x, &others[..words + WIDTH], &mut expected[..end]);
                assert!(found == expected && found[..end] != columns[..end], "{words} {x}");
                enter::<SgmEdge>(&costs, x, &others[..words + WIDTH], &mut found[..end]);
                plain::enter::<SgmEdge>(&costs, x, &others[..words + WIDTH], &mut expected[..end]);
                assert!(found == expected, "{words} {x}, within edges");
            }
        }
    }
}
