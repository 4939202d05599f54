//! The loops of a path over the pixels of a row, in assembler: between two loops over a pixel's words the
//! compiler has more to hold than there are registers.
//!
//! With m the least that it costs to come from beside, and j the least cost and a jump, a path's cost at a
//! pixel is `most - agreement - (j - m, at least 0)`: one saturating subtraction does for the minimum of m
//! and j and for taking the least off. The least is found on the way, of each byte of a word first.
#![allow(unsafe_code)]

use super::{far, splat};
use crate::matching::backend::loops::keep_loop;
use crate::matching::memory::slices::part_mut;
use crate::matching::penalties::Penalties;
use core::arch::asm;

/// A path's costs at a pixel, with a word before and after that no path comes from.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct Padded<const WORDS: usize> {
    before: u32,
    words: [u32; WORDS],
    after: u32,
}

impl<const WORDS: usize> Padded<WORDS> {
    /// A path at its start: `words` words of no cost.
    // Where their number is known when compiled, the compiler's own routine would clear them, and be there
    // for this alone.
    #[inline(never)]
    pub fn new(words: usize, penalties: &Penalties) -> Self {
        let far = splat(far(penalties));
        let mut path = Self { before: far, words: [far; WORDS], after: far };
        for word in part_mut(&mut path.words, ..words) {
            keep_loop();
            *word = 0;
        }
        path
    }

    /// Where its words begin, by a pointer to all of it: the word before and the one after are read too.
    pub fn place(&mut self) -> *mut u32 {
        core::ptr::from_mut(self).cast::<u32>().wrapping_add(1)
    }
}

/// What a path pays on its way into a pixel, four times in a word.
#[repr(C)]
pub(super) struct Step {
    /// One disparity up or down.
    step: u32,
    /// Any further.
    jump: u32,
    /// Upper bound of an aggregated cost: the largest jump and the largest cost of a pixel.
    most: u32,
}

impl Step {
    /// The three kinds of step, by the change of the left image's brightness.
    pub fn kinds(penalties: &Penalties) -> [Self; 3] {
        penalties.changes().map(|change| Self {
            step: splat(change.step),
            jump: splat(change.jump),
            most: splat(penalties.cost.wrapping_add(change.jump)),
        })
    }
}

/// What both functions go by, at these places of the frame in `lr`.
#[repr(C)]
pub(super) struct Frame {
    /// 0: the place of the pixel's kind of step, see `changes`, and 4: how far it is to the next.
    pub change: *const u8,
    pub on: isize,
    /// 8: the kinds of step.
    pub steps: *const [Step; 3],
    /// 12: the path before, in the place of which the one after is put; or the average.
    pub path: *mut u32,
    /// 16: a column's words, in fours.
    pub fours: usize,
    /// 20: bytes from a column's end to the next column's beginning.
    pub gap: isize,
    /// 24: where the sums, or the paths that are kept, are at their end.
    pub end: *const u32,
    /// 28, 32: bytes from where a path is kept to the two columns of the row above that it comes from.
    pub beside: [isize; 2],
}

/// Twice the lines of two words, and around again until `$count` is 0.
macro_rules! four_words {
    ($label:literal, $count:literal, $($line:expr),*) => {
        concat!(
            $label, ":\n", $($line, "\n",)* $($line, "\n",)*
            "subs ", $count, ", ", $count, ", #1\n", "bne ", $label, "b"
        )
    };
}

/// The least of four bytes in `r9`, in all of them: half a word off, then a byte. 6 instructions.
macro_rules! least_of_four {
    () => {
        "ror r10, r9, #16
         usub8 r11, r9, r10
         sel r9, r10, r9
         ror r10, r9, #8
         usub8 r11, r9, r10
         sel r9, r10, r9"
    };
}

/// Goes on to the next pixel, and puts what it costs to come into this one in `r6` to `r8`: step, jump from
/// the least cost, most. 7 instructions.
macro_rules! choose_step {
    () => {
        "ldm lr, {{r6, r7, r8}}
         ldrb r10, [r6]
         add r6, r6, r7
         str r6, [lr]
         add r8, r8, r10
         ldm r8, {{r6, r7, r8}}
         add r7, r7, r9"
    };
}

/// Two words of the path at `r0`, taken into the pixel whose agreements are at `r2`, in `r10` and `r11`. `r1`
/// is the word a byte before them, and then that a byte before the next two. 22 instructions with `$here`,
/// which loads the two words into `r10` and `r11`, and `$next`, which loads `r1`.
macro_rules! step_two {
    ($here:literal, $next:literal) => {
        concat!(
            "ldr r10, [r0, #1]
         usub8 r11, r1, r10
         sel r1, r10, r1
         ldr r5, [r0, #3]
         ldr r10, [r0, #5]
         usub8 r11, r5, r10
         sel r5, r10, r5
         ",
            $here,
            "
         add r1, r1, r6
         add r5, r5, r6
         usub8 r12, r1, r10
         sel r1, r10, r1
         usub8 r12, r5, r11
         sel r5, r11, r5
         uqsub8 r12, r7, r1
         uqsub8 r5, r7, r5
         ldrd r10, r11, [r2], #8
         usub8 r10, r8, r10
         usub8 r11, r8, r11
         sub r10, r10, r12
         sub r11, r11, r5
         ",
            $next
        )
    };
}

/// Takes a path along a row with agreements `costs`: what is in `from` and the path's cost are the `sums`,
/// 255 at the most. 31 instructions for two words and 26 a pixel.
///
/// # Safety
/// The frame's columns, `fours` times four words each, can be read from `costs` and `from` on, and written
/// from `sums` on; a place of a step for each from the first on; and the path has a word more before and
/// after.
#[inline(never)]
pub(super) unsafe fn go_along(frame: *mut Frame, costs: *const u32, from: *const u32, sums: *mut u32) {
    // SAFETY: as the function's. `r6` and `r7`, which are the compiler's, are put back.
    unsafe {
        asm!(
            // r0 path, r2 costs, r3 from, r4 sums; lr is the frame, and in the loop over words their number
            "push {{r6, r7, lr}}",
            "mov r9, #0",
            "1:",
            choose_step!(),
            "ldrd r0, lr, [lr, #12]",
            "ldr r1, [r0, #-1]",
            "mvn r9, #0",
            four_words!(
                "2",
                "lr",
                step_two!("ldrd r10, r11, [r0]", "ldr r1, [r0, #7]"),
                "strd r10, r11, [r0], #8
                 usub8 r5, r9, r10
                 sel r9, r10, r9
                 usub8 r5, r9, r11
                 sel r9, r11, r9
                 ldrd r5, r12, [r3], #8
                 uqadd8 r10, r10, r5
                 uqadd8 r11, r11, r12
                 strd r10, r11, [r4], #8"
            ),
            least_of_four!(),
            "ldr lr, [sp, #8]",
            "ldrd r10, r11, [lr, #20]",
            "add r2, r2, r10",
            "add r3, r3, r10",
            "add r4, r4, r10",
            "cmp r4, r11",
            "bne 1b",
            "pop {{r6, r7, lr}}",
            inout("r2") costs => _, inout("r3") from => _, inout("r4") sums => _, inout("lr") frame => _,
            out("r0") _, out("r1") _, out("r5") _, out("r8") _, out("r9") _, out("r10") _, out("r11") _,
            out("r12") _,
        );
    }
}

/// Takes the path from above into columns with agreements `costs`, from the average of two columns of the row
/// above, rounded down. `kept` begins with what was one of the two, or will be. 32 instructions for two words
/// and 29 a pixel.
///
/// # Safety
/// As for [`go_along`]; and for each column two of the row above can be read.
#[inline(never)]
pub(super) unsafe fn go_down(frame: *mut Frame, costs: *const u32, kept: *mut u32) {
    // SAFETY: as for `go_along`.
    unsafe {
        asm!(
            // r0 average, r2 costs, r3 kept
            "push {{r6, r7, lr}}",
            "1:",
            "ldrd r0, r1, [lr, #28]",
            "add r0, r3, r0",
            "add r1, r3, r1",
            "ldrd r12, r5, [lr, #12]",
            "mvn r9, #0",
            four_words!(
                "2",
                "r5",
                "ldrd r10, r11, [r0], #8
                 ldrd r6, r7, [r1], #8
                 uhadd8 r10, r10, r6
                 uhadd8 r11, r11, r7
                 strd r10, r11, [r12], #8
                 usub8 r6, r9, r10
                 sel r9, r10, r9
                 usub8 r6, r9, r11
                 sel r9, r11, r9"
            ),
            least_of_four!(),
            choose_step!(),
            "ldrd r0, lr, [lr, #12]",
            "ldr r1, [r0, #-1]",
            four_words!(
                "4",
                "lr",
                step_two!("ldrd r10, r11, [r0], #8", "ldr r1, [r0, #-1]"),
                "strd r10, r11, [r3], #8"
            ),
            "ldr lr, [sp, #8]",
            "ldrd r10, r11, [lr, #20]",
            "add r2, r2, r10",
            "add r3, r3, r10",
            "cmp r3, r11",
            "bne 1b",
            "pop {{r6, r7, lr}}",
            inout("r2") costs => _, inout("r3") kept => _, inout("lr") frame => _,
            out("r0") _, out("r1") _, out("r5") _, out("r8") _, out("r9") _, out("r10") _, out("r11") _,
            out("r12") _,
        );
    }
}
