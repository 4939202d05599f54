//! Answers refused that spread, as `portable/fattening.rs` does: both directions in the halves of a word,
//! then four pixels at a time.
//!
//! Half-words hold bounds up to the number of no answer, and that bounds nothing.
#![allow(unsafe_code)]

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::work::FatteningWork;
use crate::matching::memory::slices::part_mut;
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;

/// Pixels that are refused in a round.
const GROUP: usize = 4;
/// The mark in both halves of a word.
const MARKS: u32 = FatteningWork::REFUSED as u32 * 0x0001_0001;

/// [`Isa::refuse_fattening`](crate::matching::backend::Isa::refuse_fattening): 31 instructions for a pixel.
#[inline(never)]
pub(super) fn refuse(work: FatteningWork<'_>) {
    let FatteningWork { answers, flags, edges, row, slope } = work;
    let count = answers.len();
    if flags.len() < count || edges.len() < count {
        return;
    }
    mark(answers, edges, row, slope);
    let (groups, done) = (count / GROUP, count - count % GROUP);
    refuse_groups(answers, flags, edges, groups);
    let rest = part_mut(answers, done..).iter_mut().zip(part_mut(flags, done..));
    for ((answer, flags), edges) in rest.zip(part_mut(edges, done..)) {
        keep_loop();
        if *edges & FatteningWork::REFUSED != 0 && answer.is_some() {
            (*answer, *flags) = (Disparity::NONE, flags.union(PixelFlags::UNTEXTURED));
        }
    }
}

/// Marks the answers that are beyond the bound of those on their left or of those on their right: 24
/// instructions for a pixel.
fn mark(answers: &[Disparity], edges: &mut [u8], row: u8, slope: Disparity) {
    let count = answers.len();
    if count == 0 || edges.len() < count {
        return;
    }
    let halves = |number: u16| u32::from(number) * 0x0001_0001;
    let (answers, edges) = (answers.as_ptr_range(), part_mut(edges, ..count).as_mut_ptr_range());
    // SAFETY: `count` answers are read from the first on and from the last back, and as many edges read and
    // written both ways. `r6` and `r7`, which are the compiler's, are put back.
    unsafe {
        asm!(
            // r0, r2 answers and edges to the right, r1, r3 to the left; r4 both bounds
            "push {{r6, r7}}",
            "mov r6, r8",
            "mov r7, r9",
            "2:",
            "ldrh r8, [r0], #2",
            "ldrh r9, [r1, #-2]!",
            "ldrb r10, [r2]",
            "orr r8, r8, r9, lsl #16",
            "tst r10, r5",
            "itt ne",
            "orrne r4, r4, #0xff00",
            "orrne r4, r4, #0xff",
            "usub16 r9, r4, r8",
            "sel r9, r11, r12",
            "orr r10, r10, r9",
            "strb r10, [r2], #1",
            "ldrb r10, [r3, #-1]!",
            "uqadd16 r4, r4, r6",
            "uqadd16 r8, r8, r7",
            "orr r9, r10, r9, lsr #16",
            "strb r9, [r3]",
            "usub16 r9, r4, r8",
            "sel r4, r8, r4",
            "tst r10, r5",
            "it ne",
            "movtne r4, #0xffff",
            "subs lr, lr, #1",
            "bne 2b",
            "pop {{r6, r7}}",
            inout("r0") answers.start => _, inout("r1") answers.end => _,
            inout("r2") edges.start => _, inout("r3") edges.end => _,
            inout("r4") u32::MAX => _, in("r5") u32::from(row),
            inout("r8") halves(slope.raw()) => _, inout("r9") halves(FatteningWork::TOLERANCE) => _,
            in("r11") 0, in("r12") MARKS, inout("lr") count => _, out("r10") _,
        );
    }
}

/// Refuses the answers that are marked; what has no answer is not flagged. 27 instructions for four pixels.
fn refuse_groups(answers: &mut [Disparity], flags: &mut [PixelFlags], edges: &[u8], groups: usize) {
    let count = groups * GROUP;
    if groups == 0 || answers.len() < count || flags.len() < count || edges.len() < count {
        return;
    }
    // SAFETY: as many groups of edges are read, and of answers and flags read and written; a load or a
    // store of a word may be anywhere. `r6` and `r7`, which are the compiler's, are put back.
    unsafe {
        asm!(
            // r0 answers, r1 flags, r2 edges
            "push {{r6, r7}}",
            "2:",
            // Marks to all bits of bytes, then of half-words.
            "ldr r4, [r2], #4",
            "uadd8 r5, r4, r4",
            "sel r4, r10, r11",
            "sxtb16 r5, r4",
            "sxtb16 r6, r4, ror #8",
            "pkhbt r4, r5, r6, lsl #16",
            "pkhtb r5, r6, r5, asr #16",
            "ldr r6, [r0]",
            "ldr r7, [r0, #4]",
            "bic r8, r4, r6",
            "bic r9, r5, r7",
            "orr r6, r6, r4",
            "orr r7, r7, r5",
            "str r6, [r0], #4",
            "str r7, [r0], #4",
            // What was refused, of the even pixels and of the odd ones.
            "pkhbt r4, r8, r9, lsl #16",
            "pkhtb r5, r9, r8, asr #16",
            "usub16 r6, r4, r12",
            "sel r4, r3, r11",
            "usub16 r6, r5, r12",
            "sel r5, r3, r11",
            "ldr r6, [r1]",
            "orr r6, r6, r4",
            "orr r6, r6, r5, lsl #8",
            "str r6, [r1], #4",
            "subs lr, lr, #1",
            "bne 2b",
            "pop {{r6, r7}}",
            inout("r0") answers.as_mut_ptr() => _, inout("r1") flags.as_mut_ptr() => _,
            inout("r2") edges.as_ptr() => _, in("r3") u32::from(PixelFlags::UNTEXTURED.bits()) * 0x0001_0001,
            in("r10") u32::MAX, in("r11") 0, in("r12") 0x0001_0001, inout("lr") groups => _,
            out("r4") _, out("r5") _, out("r8") _, out("r9") _,
        );
    }
}
