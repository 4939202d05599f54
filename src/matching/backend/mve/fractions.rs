//! Fractions of a pixel, from the costs beside the winners: `portable/subpixel.rs` says what they are.
#![allow(unsafe_code)]

use crate::matching::backend::parameters::MethodParameters;
use core::arch::asm;

/// The fraction of each winner with its sign, 1/32 px, from the costs of the disparity below, of its own and
/// of the one above: a division bit by bit. The method's slant cost of the
/// steeper rise is not counted. 44 instructions for
/// 16 pixels, two more where there is a slant.
#[inline(never)]
pub(super) fn fractions<P: MethodParameters>(below: &[u8], costs: &[u8], above: &[u8], out: &mut [u8]) {
    let count = below.len();
    if count == 0 || costs.len() < count || above.len() < count || out.len() < count {
        return;
    }
    // SAFETY: `count` bytes are read of each row of costs, and written: the loop is one for so many lanes of
    // bytes.
    unsafe {
        asm!(
            "vmov.i8 q7, #1",
            "dlstp.8 lr, {count}",
            "2:",
            "vldrb.u8 q0, [{below}], #16",
            "vldrb.u8 q1, [{costs}], #16",
            "vldrb.u8 q2, [{above}], #16",
            "vsub.i8 q0, q0, q1",
            "vsub.i8 q2, q2, q1",
            "vmax.u8 q3, q0, q2",
            "vabd.u8 q4, q0, q2",
            ".if {slant}",
            "vqsub.u8 q3, q3, {step}",
            "vmax.u8 q3, q3, q4",
            ".endif",
            "vmax.u8 q3, q3, q7",
            "vmov.i8 q5, #0",
            "vptt.u8 cs, q4, q3",
            "vmovt q5, q7",
            "vmovt.i32 q4, #0",
            ".rept 4",
            // The rest is less than what it is divided by, and so is twice the rest less it.
            "vadd.i8 q5, q5, q5",
            "vsub.i8 q6, q3, q4",
            "vptte.u8 cs, q4, q6",
            "vsubt.i8 q4, q4, q6",
            "vaddt.i8 q5, q5, q7",
            "vadde.i8 q4, q4, q4",
            ".endr",
            "vshr.u8 q6, q3, #1",
            "vsub.i8 q6, q3, q6",
            "vpt.u8 cs, q4, q6",
            "vaddt.i8 q5, q5, q7",
            "vpt.u8 hi, q2, q0",
            "vnegt.s8 q5, q5",
            "vstrb.8 q5, [{out}], #16",
            "letp lr, 2b",
            count = in(reg) count, slant = const P::SLANT_COST, step = in(reg) u32::from(P::SLANT_COST),
            below = inout(reg) below.as_ptr() => _, costs = inout(reg) costs.as_ptr() => _,
            above = inout(reg) above.as_ptr() => _, out = inout(reg) out.as_mut_ptr() => _,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
            out("q6") _, out("q7") _, options(nostack),
        );
    }
}
