//! Winners made answers, and flags said of them: what `portable/left_right_rows.rs` does.
#![allow(unsafe_code)]

use super::fractions::fractions;
use crate::matching::backend::parameters::MethodParameters;
use crate::matching::backend::work::Rules;
use crate::matching::memory::winners::WinnerRows;
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;

/// The answers and flags of the columns that have a candidate, `kept` by their partners. `room` has a byte a
/// pixel.
#[inline(never)]
pub(super) fn answer<P: MethodParameters>(
    winners: &WinnerRows<'_>,
    kept: &[u8],
    rules: &Rules,
    room: &mut [u8],
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
    fractions::<P>(winners.below, winners.costs, winners.above, room);
    flag(winners, kept, rules, flags);
    refine(winners.disparities, room, rules, flags, answers);
}

/// Flags of winners, beside those that there are. Sixteen instructions for 16 pixels.
fn flag(winners: &WinnerRows<'_>, kept: &[u8], rules: &Rules, flags: &mut [PixelFlags]) {
    let WinnerRows { below, costs, above, disparities } = winners;
    let count = flags.len();
    let rows = [below.len(), costs.len(), above.len(), disparities.len(), kept.len()];
    if count == 0 || rows.iter().any(|&length| length < count) {
        return;
    }
    // SAFETY: `count` bytes are read of each row, and written of the flags: the loop is one for so many lanes
    // of bytes. A `PixelFlags` is a byte, every value of which is one.
    unsafe {
        asm!(
            "vmov.i8 q5, #{mismatch}",
            "vdup.8 q6, {flat}",
            "vmov.i8 q7, #{ceiling}",
            "dlstp.8 lr, {count}",
            "2:",
            "vldrb.u8 q0, [{disparities}], #16",
            "vldrb.u8 q1, [{kept}], #16",
            "vabd.u8 q1, q1, q0",
            "vldrb.u8 q2, [{flags}]",
            "vpt.u8 hi, q1, {tolerance}",
            "vorrt q2, q2, q5",
            "vldrb.u8 q1, [{costs}], #16",
            "vldrb.u8 q3, [{below}], #16",
            "vldrb.u8 q4, [{above}], #16",
            "vptt.i8 eq, q3, q1",
            "vcmpt.i8 eq, q4, q1",
            "vorrt q2, q2, q6",
            "vpt.i8 eq, q0, {last}",
            "vorrt q2, q2, q7",
            "vstrb.8 q2, [{flags}], #16",
            "letp lr, 2b",
            count = in(reg) count, flat = in(reg) u32::from(rules.flat.bits()),
            mismatch = const PixelFlags::MISMATCH.bits() as u32,
            ceiling = const PixelFlags::CEILING.bits() as u32,
            tolerance = in(reg) u32::from(rules.tolerance), last = in(reg) u32::from(rules.ceiling),
            disparities = inout(reg) disparities.as_ptr() => _, kept = inout(reg) kept.as_ptr() => _,
            below = inout(reg) below.as_ptr() => _, costs = inout(reg) costs.as_ptr() => _,
            above = inout(reg) above.as_ptr() => _, flags = inout(reg) flags.as_mut_ptr() => _,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
            out("q6") _, out("q7") _, options(nostack),
        );
    }
}

/// The answers of winners with these fractions, none where the flags refuse. Ten instructions for eight
/// pixels.
fn refine(
    disparities: &[u8],
    fractions: &[u8],
    rules: &Rules,
    flags: &[PixelFlags],
    answers: &mut [Disparity],
) {
    let count = answers.len();
    if count == 0 || disparities.len() < count || fractions.len() < count || flags.len() < count {
        return;
    }
    let least = rules.min_disparity.wrapping_mul(Disparity::ONE);
    // SAFETY: `count` bytes are read of each row, and half-words written of the answers: the loop is one for
    // so many lanes of half-words. A `Disparity` is a half-word, every value of which is one.
    unsafe {
        asm!(
            "vdup.16 q4, {refused}",
            "vmov.i8 q5, #255",
            "dlstp.16 lr, {count}",
            "2:",
            "vldrb.s16 q0, [r0], #8",
            "vldrb.u16 q1, [r1], #8",
            "vmla.i16 q0, q1, {one}",
            "vadd.i16 q0, q0, {least}",
            "vldrb.u16 q1, [r2], #8",
            "vand q1, q1, q4",
            "vpt.i16 ne, q1, zr",
            "vmovt q0, q5",
            "vstrh.16 q0, [{answers}], #16",
            "letp lr, 2b",
            count = in(reg) count, refused = in(reg) u32::from(rules.refused.bits()),
            one = in(reg) u32::from(Disparity::ONE), least = in(reg) u32::from(least),
            answers = inout(reg) answers.as_mut_ptr() => _, inout("r0") fractions.as_ptr() => _,
            inout("r1") disparities.as_ptr() => _, inout("r2") flags.as_ptr() => _,
            out("lr") _, out("q0") _, out("q1") _, out("q4") _, out("q5") _, options(nostack),
        );
    }
}
