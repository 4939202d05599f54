//! Paths from pixel to pixel.
#![allow(unsafe_code)]

use crate::matching::backend::portable::sgm::quarters::columns::FOUR;
use crate::matching::backend::portable::sgm::quarters::steps::Steps;
use core::arch::asm;
use core::cell::Cell;

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
/// step in `r4`, what a jump costs in `r6`, the bound in `r5`, what is behind the column in `r0`, before it
/// in `r8`, its first word in `r9` and its rounds in `r12`; `$base`, which may look at `r0`, goes before the
/// last ones. 19 instructions and that.
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

/// [`along`], the least low: 104 instructions, and 41.
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

/// [`down`], 100 instructions, and 31.
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
            // What a jump costs is added to the base, in all lanes.
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

/// [`average_two`], 36 instructions, and 19.
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
