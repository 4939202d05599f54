//! Support counted and speckle dropped, four answers at a time: what `speckle.rs` of the stages does.
//!
//! Of four columns is kept a word of support, then one of bits, in which the second byte and the third have
//! changed places: so that what comes of two half-words of answers, and of the next two, goes to bytes and
//! comes back without being sorted. The last columns, fewer than four, have a half-word each.
#![allow(unsafe_code)]

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::speckle::ROWS;
use crate::matching::backend::work::SpeckleWork;
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;

/// Drops the answers of the row that waited which have a support under `pixels`.
#[inline(never)]
pub(super) fn speckle(work: SpeckleWork<'_>) {
    let SpeckleWork { here, above, lengths, kept, flags, answers, finished, step, pixels, run } = work;
    // Lengths are less by the answer itself; without a limit it is over all of them.
    let run = run.wrapping_sub(1);
    let count = finished.len();
    let rows = [here.len(), above.len(), kept.len(), flags.len(), answers.map_or(count, <[_]>::len)];
    let lengths = lengths.bytes();
    if lengths.len() < count || rows.iter().any(|&length| length < count) {
        return;
    }
    let four = count & !3;
    if four > 0 {
        join(here, above, lengths, kept, (four, step, pixels, run));
        drop_speckle(lengths, answers, finished, flags, four);
    }
    for x in four..count {
        keep_loop();
        let (Some(&here), Some(&above), Some(&length)) = (here.get(x), above.get(x), lengths.get(x)) else {
            return;
        };
        let (Some(kept), Some(flags), Some(finished)) =
            (kept.get_mut(x), flags.get_mut(x), finished.get_mut(x))
        else {
            return;
        };
        let joined = u16::from(here.raw().abs_diff(above.raw()) <= step.raw());
        let support = (*kept >> 8) * joined;
        let support = (u16::from(length.min(run)) + 1 + support).min(0xff);
        let mut bits = (*kept << 1 & 0b1_1110_1110) | joined;
        bits |= ((bits ^ (bits + 1)) << ROWS) * u16::from(support >= u16::from(pixels));
        *kept = support << 8 | (bits & 0xff);
        let answer = answers.and_then(|answers| answers.get(x)).copied().unwrap_or(*finished);
        *finished = if bits & 0x100 == 0 { Disparity::NONE } else { answer };
        *flags = flags.union(PixelFlags::SPECKLE.when(*finished != answer));
    }
}

/// Counts the support of `four` columns, a multiple of four and not 0, and leaves where their lengths stood
/// the highest bit set of those whose row that waited has enough. 47 instructions for four.
#[inline(never)]
fn join(
    here: &[Disparity],
    above: &[Disparity],
    lengths: &mut [u8],
    kept: &mut [u16],
    (four, step, pixels, run): (usize, Disparity, u8, u8),
) {
    let (here, lengths) = (here.as_ptr(), lengths.as_mut_ptr());
    // SAFETY: of every slice `four` elements are read, and of the last two written, four in every round:
    // `speckle` asked for so many. They are integers, or integers' own types, any of which is one. The
    // stack and the two registers that no operand may be are left as they were.
    unsafe {
        asm!(
            "push {{r6, r7}}",
            "mov r7, #0x01010101",
            "2:",
            // Joined where the step is no less than the difference.
            "ldr r0, [r3], #4",
            "ldr r1, [r5], #4",
            "uqsub16 r2, r0, r1",
            "uqsub16 r1, r1, r0",
            "orr r2, r2, r1",
            "usub16 r2, r10, r2",
            "mov r1, #0",
            "sel r6, r12, r1",
            "ldr r0, [r3], #4",
            "ldr r1, [r5], #4",
            "uqsub16 r2, r0, r1",
            "uqsub16 r1, r1, r0",
            "orr r2, r2, r1",
            "usub16 r2, r10, r2",
            "orr r2, r6, #0xff00ff00",
            "sel r6, r2, r6",
            // Lengths as far as they count, the two in the middle changed.
            "ldr r2, [r8]",
            "uqsub8 r0, r2, lr",
            "sub r2, r2, r0",
            "uxtb16 r0, r2",
            "uxtb16 r1, r2, ror #8",
            "pkhbt r2, r0, r1, lsl #16",
            "pkhtb r1, r1, r0, asr #16",
            "orr r2, r2, r1, lsl #8",
            // The support, 255 at most, the answer itself in it, goes on where it is joined.
            "ldr r0, [r9]",
            "and r0, r0, r6",
            "uqadd8 r0, r0, r2",
            "uqadd8 r0, r0, r7",
            "str r0, [r9], #4",
            // Each bit stands for the row before now; the highest of both halves goes.
            "ldr r1, [r9]",
            "and r2, r1, #0x80808080",
            "bic r1, r1, #0x88888888",
            "and r6, r6, #0x01010101",
            "orr r1, r6, r1, lsl #1",
            // This row, and those above as far as they are joined, where there is enough.
            "add r6, r1, #0x01010101",
            "eor r6, r6, r1",
            "usub8 r0, r0, r11",
            "mov r0, #0",
            "sel r6, r6, r0",
            "and r0, r6, #0x0f0f0f0f",
            "orr r1, r1, r0, lsl #4",
            "str r1, [r9], #4",
            // The row that waited had enough, or is reached.
            "and r6, r6, #0x10101010",
            "orr r2, r2, r6, lsl #3",
            "str r2, [r8], #4",
            "cmp r3, r4",
            "bne 2b",
            "pop {{r6, r7}}",
            inout("r3") here => _, in("r4") here.wrapping_add(four),
            inout("r5") above.as_ptr() => _,
            inout("r8") lengths => _,
            inout("r9") kept.as_mut_ptr() => _,
            in("r10") u32::from(step.raw()) * 0x1_0001,
            in("r11") u32::from(pixels) * 0x0101_0101,
            in("r12") 0x00ff_00ff,
            in("lr") u32::from(run) * 0x0101_0101,
            out("r0") _, out("r1") _, out("r2") _,
        );
    }
}

/// Finishes `four` answers, a multiple of four and not 0, that [`join`] has marked if they stay. 25
/// instructions for four.
#[inline(never)]
fn drop_speckle(
    marks: &[u8],
    answers: Option<&[Disparity]>,
    finished: &mut [Disparity],
    flags: &mut [PixelFlags],
    four: usize,
) {
    let finished = finished.as_mut_ptr();
    let answers = answers.map_or(finished.cast_const(), <[_]>::as_ptr);
    let speckle = const { PixelFlags::SPECKLE.bits() as u32 * 0x1_0001 };
    // SAFETY: as for `join`.
    unsafe {
        asm!(
            "2:",
            // All ones where there is no answer any more.
            "ldr {a}, [{marks}], #4",
            "uadd8 {a}, {a}, {a}",
            "sel {a}, {zero}, {none}",
            "sxtb16 {b}, {a}, ror #8",
            "sxtb16 {a}, {a}",
            "ldr {c}, [{answers}], #4",
            "ldr {d}, [{answers}], #4",
            "orr {a}, {a}, {c}",
            "orr {b}, {b}, {d}",
            "str {a}, [{finished}], #4",
            "str {b}, [{finished}], #4",
            // What changed is speckle.
            "eor {a}, {a}, {c}",
            "usub16 {a}, {zero}, {a}",
            "sel {a}, {zero}, {speckle}",
            "eor {b}, {b}, {d}",
            "usub16 {b}, {zero}, {b}",
            "sel {b}, {zero}, {speckle}",
            "orr {a}, {a}, {a}, lsr #8",
            "orr {b}, {b}, {b}, lsr #8",
            "pkhbt {a}, {a}, {b}, lsl #16",
            "ldr {b}, [{flags}]",
            "orr {a}, {a}, {b}",
            "str {a}, [{flags}], #4",
            "subs {four}, {four}, #4",
            "bne 2b",
            marks = inout(reg) marks.as_ptr() => _,
            answers = inout(reg) answers => _,
            finished = inout(reg) finished => _,
            flags = inout(reg) flags.as_mut_ptr() => _,
            four = inout(reg) four => _,
            zero = in(reg) 0, none = in(reg) u32::MAX, speckle = in(reg) speckle,
            a = out(reg) _, b = out(reg) _, c = out(reg) _, d = out(reg) _,
            options(nostack),
        );
    }
}
