//! What a path pays on its way into each pixel of a row, by the change of the left image's brightness.
#![allow(unsafe_code)]

use crate::matching::penalties::Penalties;
use core::arch::asm;

/// Step of each pixel, and above it `255 - jump`, from the brightness `here` and where the path comes
/// from: eleven instructions for eight pixels.
#[inline(never)]
pub(super) fn changes(here: &[u8], from: &[u8], penalties: &Penalties, out: &mut [u16]) {
    let count = out.len();
    if count == 0 || here.len() < count || from.len() < count {
        return;
    }
    let [little, more, much] =
        penalties.changes().map(|change| u32::from(change.step) | u32::from(!change.jump) << 8);
    let [first, second] = penalties.edges.map(u32::from);
    // SAFETY: `count` bytes are read of both rows, and so many half-words are written: the loop is one for
    // so many lanes of half-words.
    unsafe {
        asm!(
            "vdup.16 q3, {little}",
            "dlstp.16 lr, {count}",
            "2:",
            "vldrb.u16 q0, [r0], #8",
            "vldrb.u16 q1, [r1], #8",
            "vabd.u16 q0, q0, q1",
            "vmov q2, q3",
            "vpt.u16 cs, q0, {first}",
            "vdupt.16 q2, {more}",
            "vpt.u16 cs, q0, {second}",
            "vdupt.16 q2, {much}",
            "vstrh.16 q2, [{out}], #16",
            "letp lr, 2b",
            count = in(reg) count, little = in(reg) little, more = in(reg) more, much = in(reg) much,
            first = in(reg) first, second = in(reg) second, out = inout(reg) out.as_mut_ptr() => _,
            inout("r0") here.as_ptr() => _, inout("r1") from.as_ptr() => _,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, options(nostack),
        );
    }
}
