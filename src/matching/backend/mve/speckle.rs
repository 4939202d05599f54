//! Support counted and speckle dropped: what `speckle.rs` of the stages does.
#![allow(unsafe_code)]

use crate::matching::backend::work::SpeckleWork;
use crate::units::PixelFlags;
use core::arch::asm;

/// Drops the answers of the row that waited which have a support under `pixels`. What is kept is
/// two rows of bytes: the support so far, and the bits.
///
/// 30 instructions for eight answers.
#[inline(never)]
pub(super) fn speckle(work: SpeckleWork<'_>) {
    let SpeckleWork { here, above, lengths, kept, flags, answers, finished, step, pixels, run } = work;
    let count = finished.len();
    let run = if run == 0 { u32::from(u8::MAX) } else { u32::from(run) };
    let lengths = lengths.bytes();
    let rows = [here.len(), above.len(), kept.len(), flags.len(), answers.map_or(count, <[_]>::len)];
    if count == 0 || lengths.len() < count || rows.iter().any(|&length| length < count) {
        return;
    }
    let finished = finished.as_mut_ptr();
    let answers = answers.map_or(finished.cast_const(), <[_]>::as_ptr);
    let counts = kept.as_mut_ptr().cast::<u8>();
    // SAFETY: `count` of each are read and written, which all have, of `lengths` one byte for each and of
    // `kept` two: the loop is one for so many lanes of half-words. A `Disparity` is a half-word and a
    // `PixelFlags` a byte, every value of which is one.
    unsafe {
        asm!(
            "vdup.16 q7, {limits}",
            "lsr {limits}, {limits}, #16",
            "vdup.16 q5, {limits}",
            "vmov.i16 q6, #255",
            "vmov.i8 q4, #255",
            "dlstp.16 lr, {count}",
            // There are no registers for more: the number of lanes is done with.
            "mov {count}, #1",
            "2:",
            "vldrh.u16 q0, [{here}], #16",
            "vldrh.u16 q1, [{above}], #16",
            "vabd.u16 q0, q0, q1",
            // Each bit stands for the row before now; the highest of both halves goes.
            "vldrb.u16 q2, [r2]",
            "vshl.i16 q2, q2, #1",
            "vbic.i16 q2, #0x11",
            "vldrb.u16 q1, [r0], #8",
            "vmin.u16 q1, q1, q5",
            "vptt.u16 cs, q7, q0",
            "vldrbt.u16 q3, [r1]",
            "vorrt.i16 q2, #1",
            "vadd.i16 q1, q1, q3",
            "vmin.u16 q1, q1, q6",
            "vstrb.16 q1, [r1], #8",
            // This row, and those above as far as they are joined.
            "vadd.i16 q0, q2, {count}",
            "veor q0, q0, q2",
            "vshl.i16 q0, q0, #4",
            "vpt.u16 cs, q1, {pixels}",
            "vorrt q2, q2, q0",
            "vstrb.16 q2, [r2], #8",
            // The bit of the row that waited, as a sign.
            "vshl.i16 q2, q2, #7",
            "vldrh.u16 q0, [{answers}], #16",
            "vldrb.u16 q1, [r3]",
            "vpttt.s16 ge, q2, zr",
            "vcmpt.i16 ne, q0, q4",
            "vorrt.i16 q1, #{speckle}",
            "vorrt q0, q4, q4",
            "vstrh.16 q0, [{finished}], #16",
            "vstrb.16 q1, [r3], #8",
            "letp lr, 2b",
            count = inout(reg) count => _,
            limits = inout(reg) u32::from(step.raw()) | run << 16 => _,
            pixels = in(reg) u32::from(pixels),
            here = inout(reg) here.as_ptr() => _, above = inout(reg) above.as_ptr() => _,
            answers = inout(reg) answers => _, finished = inout(reg) finished => _,
            speckle = const PixelFlags::SPECKLE.bits() as u32,
            inout("r0") lengths.as_ptr() => _, inout("r1") counts => _, inout("r2") counts.add(count) => _,
            inout("r3") flags.as_mut_ptr() => _, out("lr") _, out("q0") _, out("q1") _, out("q2") _,
            out("q3") _,
            out("q4") _, out("q5") _, out("q6") _, out("q7") _, options(nostack),
        );
    }
}
