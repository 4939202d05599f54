//! Small gaps along a row closed, as many pixels at a time as a group of registers holds: what
//! `portable/fill.rs` does, whatever the row shows.

use crate::matching::backend::work::FillWork;
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;

/// No answer.
const NONE: u32 = Disparity::NONE.raw() as u32;

/// [`Isa::fill`](crate::matching::backend::Isa::fill).
pub(super) fn fill(work: FillWork<'_>) {
    let FillWork { answers, flags, room, most, step } = work;
    let places = room.get_mut(..answers.len()).map_or(0, |room| answered(answers, room));
    if let Some(places) = room.get(..places).filter(|_| flags.len() >= answers.len()) {
        close(answers, flags, places, (most, step));
    }
}

/// The columns with answers, one behind the other in `places`, which is as long as the row; how many there
/// are.
#[inline(never)]
fn answered(answers: &[Disparity], places: &mut [u16]) -> usize {
    let count = answers.len().min(places.len());
    let mut found = 0;
    // SAFETY: `count` answers are read, as many at a time as `vsetvli` says, and no more places are written:
    // what lies behind those that are found is written again in the next round.
    unsafe {
        asm!(
            "j 3f",
            "2:",
            "vsetvli {at_once}, {count}, e16, m8, ta, ma",
            "vle16.v v8, ({answers})",
            "vid.v v16",
            "vmsne.vx v0, v8, {none}",
            "vadd.vx v16, v16, {x}",
            "vcpop.m {here}, v0",
            "vcompress.vm v24, v16, v0",
            "vse16.v v24, ({places})",
            "add {found}, {found}, {here}",
            "slli {here}, {here}, 1",
            "add {places}, {places}, {here}",
            "add {x}, {x}, {at_once}",
            "sub {count}, {count}, {at_once}",
            "slli {at_once}, {at_once}, 1",
            "add {answers}, {answers}, {at_once}",
            "3:",
            "bnez {count}, 2b",
            at_once = out(reg) _, here = out(reg) _, count = inout(reg) count => _, x = inout(reg) 0 => _,
            found = inout(reg) found, none = in(reg) NONE, answers = inout(reg) answers.as_ptr() => _,
            places = inout(reg) places.as_mut_ptr() => _,
            out("v0") _, out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _,
            out("v14") _, out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _,
            out("v20") _, out("v21") _, out("v22") _, out("v23") _, out("v24") _, out("v25") _,
            out("v26") _, out("v27") _, out("v28") _, out("v29") _, out("v30") _, out("v31") _,
            options(nostack),
        );
    }
    found
}

/// Closes the gaps between answers in these `places`: of up to `most` pixels whose sides differ by up to
/// `step`. A pixel without an answer has as many places on its left as there are before it.
#[inline(never)]
fn close(answers: &mut [Disparity], flags: &mut [PixelFlags], places: &[u16], (most, step): (u8, Disparity)) {
    let count = answers.len().min(flags.len());
    let row = answers.as_mut_ptr();
    // SAFETY: `count` answers and flags are read and written, as many at a time as `vsetvli` says. Of places
    // those are read that a pixel has on both sides, and of answers those in them: columns of the row.
    unsafe {
        asm!(
            "j 3f",
            "2:",
            "vsetvli {at_once}, {count}, e16, m4, ta, ma",
            "vle16.v v4, ({here})",
            "vmsne.vx v0, v4, {none}",
            "viota.m v8, v0",
            "vcpop.m {found}, v0",
            "vadd.vx v8, v8, {before}",
            "vmsltu.vx v1, v8, {places}",
            "vmandn.mm v1, v1, v0",
            "vmsne.vx v2, v8, zero",
            "vmand.mm v0, v1, v2",
            // Places are numbers of two bytes, and so are answers.
            "vadd.vv v8, v8, v8",
            "vluxei16.v v12, ({right}), v8, v0.t",
            "vluxei16.v v16, ({left}), v8, v0.t",
            "vsub.vv v20, v12, v16",
            "vmsleu.vx v1, v20, {apart}",
            "vmand.mm v0, v0, v1",
            "vadd.vv v12, v12, v12",
            "vadd.vv v16, v16, v16",
            "vluxei16.v v20, ({row}), v12, v0.t",
            "vluxei16.v v24, ({row}), v16, v0.t",
            "vminu.vv v4, v20, v24",
            "vmaxu.vv v20, v20, v24",
            "vsub.vv v20, v20, v4",
            "vmsleu.vx v1, v20, {step}",
            "vmand.mm v0, v0, v1",
            "vse16.v v4, ({here}), v0.t",
            // Half as wide in half as many registers: a mask is the same.
            "vsetvli zero, {at_once}, e8, m2, ta, ma",
            "vle8.v v8, ({flags}), v0.t",
            "vor.vx v8, v8, {filled}",
            "vse8.v v8, ({flags}), v0.t",
            "add {before}, {before}, {found}",
            "add {flags}, {flags}, {at_once}",
            "sub {count}, {count}, {at_once}",
            "slli {at_once}, {at_once}, 1",
            "add {here}, {here}, {at_once}",
            "3:",
            "bnez {count}, 2b",
            at_once = out(reg) _, found = out(reg) _, count = inout(reg) count => _,
            before = inout(reg) 0 => _, none = in(reg) NONE, places = in(reg) places.len(),
            right = in(reg) places.as_ptr(), left = in(reg) places.as_ptr().wrapping_sub(1),
            apart = in(reg) u32::from(most) + 1, step = in(reg) u32::from(step.raw()),
            filled = in(reg) u32::from(PixelFlags::FILLED.bits()), row = in(reg) row,
            here = inout(reg) row => _, flags = inout(reg) flags.as_mut_ptr() => _,
            out("v0") _, out("v1") _, out("v2") _, out("v4") _, out("v5") _, out("v6") _, out("v7") _,
            out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
            out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _,
            out("v21") _, out("v22") _, out("v23") _, out("v24") _, out("v25") _, out("v26") _,
            out("v27") _, options(nostack),
        );
    }
}
