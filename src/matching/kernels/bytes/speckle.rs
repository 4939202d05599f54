//! Support counted and speckle dropped, four answers at a time: what `speckle.rs` of the stages does.
//!
//! Of four columns is kept a word of support, then one of bits, in which the second byte and the third have changed places: so
//! that what comes of two half-words of answers, and of the next two, goes to bytes and comes back without being sorted. The
//! last columns, fewer than four, have a half-word each.
#![allow(unsafe_code)]

use crate::matching::kernels::scratch::bytes_of_halves;
use crate::matching::speckle::{Judged, ROWS};
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;

/// Judges the row with support of at least `pixels`, where a surface changes by up to `step`.
#[inline(never)]
pub fn judge(work: Judged<'_>, step: Disparity, pixels: u8) {
    let Judged { here, above, lengths, kept, flags, answers, finished } = work;
    let count = finished.len();
    let rows = [here.len(), above.len(), kept.len(), flags.len(), answers.map_or(count, <[_]>::len)];
    let lengths = bytes_of_halves(lengths);
    if lengths.len() < count || rows.iter().any(|&length| length < count) {
        return;
    }
    let four = count & !3;
    if four > 0 {
        join(here, above, lengths, kept, (four, step, pixels));
        drop_speckle(lengths, answers, finished, flags, four);
    }
    for x in four..count {
        let (Some(&here), Some(&above), Some(&length)) = (here.get(x), above.get(x), lengths.get(x)) else { return };
        let (Some(kept), Some(flags), Some(finished)) = (kept.get_mut(x), flags.get_mut(x), finished.get_mut(x)) else {
            return;
        };
        let joined = u16::from(here.raw().abs_diff(above.raw()) <= step.raw());
        let support = (*kept >> 8) * joined;
        let support = (u16::from(length) + support).min(0xff);
        let mut bits = (*kept << 1 & 0b1_1110_1110) | joined;
        bits |= ((bits ^ (bits + 1)) << ROWS) * u16::from(support >= u16::from(pixels));
        *kept = support << 8 | (bits & 0xff);
        let answer = answers.and_then(|answers| answers.get(x)).copied().unwrap_or(*finished);
        *finished = if bits & 0x100 == 0 { Disparity::NONE } else { answer };
        *flags = flags.union(PixelFlags::SPECKLE.when(*finished != answer));
    }
}

/// Counts the support of `four` columns, a multiple of four and not 0, and leaves where their lengths stood the highest bit set
/// of those whose row that waited has enough. 42 instructions for four.
#[inline(never)]
fn join(
    here: &[Disparity],
    above: &[Disparity],
    lengths: &mut [u8],
    kept: &mut [u16],
    (four, step, pixels): (usize, Disparity, u8),
) {
    let (here, lengths) = (here.as_ptr(), lengths.as_mut_ptr());
    // SAFETY: of every slice `four` elements are read, and of the last two written, four in every round: `judge` asked for so
    // many. They are integers, or integers' own types, any of which is one.
    unsafe {
        asm!(
            "2:",
            // Joined where the step is no less than the difference.
            "ldr {a}, [{here}], #4",
            "ldr {b}, [{above}], #4",
            "uqsub16 {t}, {a}, {b}",
            "uqsub16 {b}, {b}, {a}",
            "orr {t}, {t}, {b}",
            "usub16 {t}, {step}, {t}",
            "sel {j}, {low}, {zero}",
            "ldr {a}, [{here}], #4",
            "ldr {b}, [{above}], #4",
            "uqsub16 {t}, {a}, {b}",
            "uqsub16 {b}, {b}, {a}",
            "orr {t}, {t}, {b}",
            "usub16 {t}, {step}, {t}",
            "orr {t}, {j}, #0xff00ff00",
            "sel {j}, {t}, {j}",
            // Lengths, the two in the middle changed.
            "ldr {t}, [{lengths}]",
            "uxtb16 {a}, {t}",
            "uxtb16 {b}, {t}, ror #8",
            "pkhbt {t}, {a}, {b}, lsl #16",
            "pkhtb {b}, {b}, {a}, asr #16",
            "orr {t}, {t}, {b}, lsl #8",
            // The support, 255 at most, goes on where it is joined.
            "ldr {a}, [{kept}]",
            "and {a}, {a}, {j}",
            "uqadd8 {a}, {a}, {t}",
            "str {a}, [{kept}], #4",
            // Each bit stands for the row before now; the highest of both halves goes.
            "ldr {b}, [{kept}]",
            "and {t}, {b}, #0x80808080",
            "bic {b}, {b}, #0x88888888",
            "and {j}, {j}, #0x01010101",
            "orr {b}, {j}, {b}, lsl #1",
            // This row, and those above as far as they are joined, where there is enough.
            "add {j}, {b}, #0x01010101",
            "eor {j}, {j}, {b}",
            "usub8 {a}, {a}, {pixels}",
            "sel {j}, {j}, {zero}",
            "and {a}, {j}, #0x0f0f0f0f",
            "orr {b}, {b}, {a}, lsl #4",
            "str {b}, [{kept}], #4",
            // The row that waited had enough, or is reached.
            "and {j}, {j}, #0x10101010",
            "orr {t}, {t}, {j}, lsl #3",
            "str {t}, [{lengths}], #4",
            "cmp {here}, {end}",
            "bne 2b",
            here = inout(reg) here => _, end = in(reg) here.wrapping_add(four),
            above = inout(reg) above.as_ptr() => _,
            lengths = inout(reg) lengths => _,
            kept = inout(reg) kept.as_mut_ptr() => _,
            step = in(reg) u32::from(step.raw()) * 0x1_0001,
            pixels = in(reg) u32::from(pixels) * 0x0101_0101,
            low = in(reg) 0x00ff_00ff,
            zero = in(reg) 0,
            a = out(reg) _, b = out(reg) _, t = out(reg) _, j = out(reg) _,
            options(nostack),
        );
    }
}

/// Finishes `four` answers, a multiple of four and not 0, that [`join`] has marked if they stay. 25 instructions for four.
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
