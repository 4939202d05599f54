//! Support counted and speckle dropped, many answers at a time.

use super::rows::copy;
use crate::matching::backend::portable::speckle::ROWS;
use crate::matching::backend::work::SpeckleWork;
use crate::matching::memory::rings::LOOK_AHEAD;
use crate::matching::memory::views::{view, view_mut};
use crate::units::PixelFlags;
use core::arch::asm;

/// [`Isa::speckle`](crate::matching::backend::Isa::speckle) in vectors, which keeps of a column what the
/// portable one keeps: 46 instructions for 32 answers and more.
#[inline(never)]
pub(super) fn speckle(work: SpeckleWork<'_>) {
    let SpeckleWork { here, above, lengths, kept, flags, answers, finished, step, pixels, run } = work;
    if let Some(answers) = answers {
        copy(view(answers), view_mut(finished));
    }
    let lengths = lengths.half_words();
    let count = here.len();
    let rows = [above.len(), lengths.len(), kept.len(), flags.len(), finished.len()];
    if count == 0 || rows.into_iter().any(|row| row < count) {
        return;
    }
    // SAFETY: `count` half-words or bytes of each row are read and written: each round takes as many as
    // `vsetvli` says.
    unsafe {
        asm!(
            "2:",
            "vsetvli {at_once}, {count}, e16, m4, ta, ma",
            "slli {bytes}, {at_once}, 1",
            "vle16.v v8, ({here})",
            "vle16.v v12, ({above})",
            "vmaxu.vv v16, v8, v12",
            "vminu.vv v8, v8, v12",
            "vsub.vv v8, v16, v8",
            // What goes on from above has its support.
            "vmsgtu.vx v0, v8, {step}",
            "vmv.v.i v16, 1",
            "vmerge.vim v16, v16, 0, v0",
            "vle16.v v20, ({kept})",
            "vsrl.vi v12, v20, 2 * {rows}",
            "vmerge.vim v12, v12, 0, v0",
            "vle16.v v24, ({lengths})",
            "vminu.vx v24, v24, {run}",
            "vsaddu.vv v24, v24, v12",
            "vminu.vx v24, v24, {bits_of_byte}",
            // Each bit stands for the row before now; the highest of both halves goes.
            "vadd.vv v20, v20, v20",
            "vand.vx v20, v20, {moved}",
            "vor.vv v20, v20, v16",
            // This row, and those above as far as they are joined.
            "vadd.vi v12, v20, 1",
            "vxor.vv v12, v12, v20",
            "vsll.vi v12, v12, {rows}",
            "vmsltu.vx v0, v24, {pixels}",
            "vmerge.vim v12, v12, 0, v0",
            "vor.vv v20, v20, v12",
            "vsll.vi v24, v24, 2 * {rows}",
            "vand.vx v12, v20, {bits_of_byte}",
            "vor.vv v24, v24, v12",
            "vse16.v v24, ({kept})",
            "vand.vx v20, v20, {enough}",
            "vmseq.vi v0, v20, 0",
            "vle16.v v8, ({finished})",
            "vmerge.vim v12, v8, -1, v0",
            "vse16.v v12, ({finished})",
            // What has no answer is no speckle.
            "vmsne.vv v0, v8, v12",
            "vsetvli zero, zero, e8, m2, ta, mu",
            "vle8.v v8, ({flags})",
            "vor.vx v8, v8, {speckle}, v0.t",
            "vse8.v v8, ({flags})",
            "add {here}, {here}, {bytes}",
            "add {above}, {above}, {bytes}",
            "add {lengths}, {lengths}, {bytes}",
            "add {kept}, {kept}, {bytes}",
            "add {finished}, {finished}, {bytes}",
            "add {flags}, {flags}, {at_once}",
            "sub {count}, {count}, {at_once}",
            "bnez {count}, 2b",
            at_once = out(reg) _, bytes = out(reg) _, count = inout(reg) count => _,
            here = inout(reg) here.as_ptr() => _, above = inout(reg) above.as_ptr() => _,
            lengths = inout(reg) lengths.as_ptr() => _, kept = inout(reg) kept.as_mut_ptr() => _,
            finished = inout(reg) finished.as_mut_ptr() => _, flags = inout(reg) flags.as_mut_ptr() => _,
            step = in(reg) u32::from(step.raw()), pixels = in(reg) u32::from(pixels),
            run = in(reg) if run == 0 { u32::from(u16::MAX) } else { run.into() },
            bits_of_byte = in(reg) 0xff, moved = in(reg) 0b1_1110_1110, rows = const ROWS,
            enough = in(reg) 1 << (ROWS + LOOK_AHEAD),
            speckle = in(reg) u32::from(PixelFlags::SPECKLE.bits()),
            out("v0") _, out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _,
            out("v14") _, out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _,
            out("v21") _, out("v22") _, out("v23") _, out("v24") _, out("v25") _, out("v26") _, out("v27") _,
            options(nostack),
        );
    }
}
