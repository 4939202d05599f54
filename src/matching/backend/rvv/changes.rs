//! What a path pays on its way into each pixel of a row, by the change of the left image's brightness.

use crate::matching::penalties::Penalties;
use core::arch::asm;

/// The step of each pixel, and above it the jump, from the brightness `here` and where the path comes
/// from: 21 instructions for 32 pixels and more.
#[inline(never)]
pub(super) fn changes(here: &[u8], from: &[u8], penalties: &Penalties, out: &mut [u16]) {
    let count = out.len();
    if count == 0 || here.len() < count || from.len() < count {
        return;
    }
    let [little, more, much] = penalties.changes();
    let [first, second] = penalties.edges;
    // SAFETY: `count` bytes are read of both rows, and so many pairs of bytes are written: each round
    // takes as many as `vsetvli` says.
    unsafe {
        asm!(
            "2:",
            "vsetvli {at_once}, {count}, e8, m2, ta, ma",
            "vle8.v v8, ({here})",
            "vle8.v v10, ({from})",
            "vmaxu.vv v12, v8, v10",
            "vminu.vv v8, v8, v10",
            "vsub.vv v12, v12, v8",
            "vmv.v.x v8, {step_of_much}",
            "vmv.v.x v10, {jump_of_much}",
            "vmsltu.vx v0, v12, {second}",
            "vmerge.vxm v8, v8, {step_of_more}, v0",
            "vmerge.vxm v10, v10, {jump_of_more}, v0",
            "vmsltu.vx v0, v12, {first}",
            "vmerge.vxm v8, v8, {step_of_little}, v0",
            "vmerge.vxm v10, v10, {jump_of_little}, v0",
            "vsseg2e8.v v8, ({out})",
            "add {here}, {here}, {at_once}",
            "add {from}, {from}, {at_once}",
            "add {out}, {out}, {at_once}",
            "add {out}, {out}, {at_once}",
            "sub {count}, {count}, {at_once}",
            "bnez {count}, 2b",
            at_once = out(reg) _, count = inout(reg) count => _, here = inout(reg) here.as_ptr() => _,
            from = inout(reg) from.as_ptr() => _, out = inout(reg) out.as_mut_ptr() => _,
            first = in(reg) u32::from(first), second = in(reg) u32::from(second),
            step_of_little = in(reg) u32::from(little.step), jump_of_little = in(reg) u32::from(little.jump),
            step_of_more = in(reg) u32::from(more.step), jump_of_more = in(reg) u32::from(more.jump),
            step_of_much = in(reg) u32::from(much.step), jump_of_much = in(reg) u32::from(much.jump),
            out("v0") _, out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _,
            options(nostack),
        );
    }
}
