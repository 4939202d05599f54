//! A row's costs, averaged into those of the rows above.

use super::columns::Columns;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features::Features;
use crate::matching::backend::work::PathWork;
use core::arch::asm;

/// Adds a row, or within edges puts it in their place: 55 instructions for a pixel (54 where nothing is
/// compared between pixels).
#[inline(never)]
pub(super) fn enter<S: SgmParameters>(work: &mut PathWork<'_>, features: &Features<'_>, columns: Columns) {
    let (width, Features { left, right, count }) = (work.width, *features);
    let Columns { stride, vtype } = columns;
    let rows = if S::BETWEEN_PIXELS { 6 } else { 4 };
    let is_left_whole = left.rows.len() >= 3 * width && left.brightness.len() >= width;
    let is_right_whole = count >= width + stride - 1 && right.len() >= rows * count;
    if width == 0 || !is_left_whole || !is_right_whole || work.costs.len() < width * stride {
        return;
    }
    let (left_rows, right) = (left.rows.as_ptr(), right.as_ptr());
    // The two rows that the gradient along the line is compared with, or the one, twice.
    let [low, high] = if S::BETWEEN_PIXELS { [4, 5] } else { [0, 0] };
    // SAFETY: the lengths asked for above are what is read and written: of column `x` its number in each row
    // of the left image, `stride` numbers from the same place on in each row of the right one, and as many
    // costs. `width` is not 0.
    unsafe {
        asm!(
            "vsetvl zero, {stride}, {vtype}",
            // Averages are rounded up.
            "csrwi vxrm, 0",
            "2:",
            "lbu {number}, 0({along})",
            "addi {along}, {along}, 1",
            "vle8.v v8, ({low})",
            "addi {low}, {low}, 1",
            ".if {between}",
            // Only one of the differences is not 0.
            "vle8.v v16, ({high})",
            "addi {high}, {high}, 1",
            "vssubu.vx v8, v8, {number}",
            "vmaxu.vx v24, v16, {number}",
            "vsub.vv v16, v24, v16",
            "vor.vv v8, v8, v16",
            ".else",
            "vmaxu.vx v24, v8, {number}",
            "vminu.vx v8, v8, {number}",
            "vsub.vv v8, v24, v8",
            ".endif",
            "vadd.vv v8, v8, v8",
            "lbu {number}, 0({brightness})",
            "addi {brightness}, {brightness}, 1",
            "srli {number}, {number}, 1",
            "vle8.v v16, ({dark})",
            "addi {dark}, {dark}, 1",
            "vmaxu.vx v24, v16, {number}",
            "vminu.vx v16, v16, {number}",
            "vsub.vv v16, v24, v16",
            "vsrl.vi v16, v16, 2",
            "vadd.vv v8, v8, v16",
            "lbu {number}, 0({across})",
            "addi {across}, {across}, 1",
            "vle8.v v16, ({acrosses})",
            "addi {acrosses}, {acrosses}, 1",
            "vmaxu.vx v24, v16, {number}",
            "vminu.vx v16, v16, {number}",
            "vsub.vv v16, v24, v16",
            "vadd.vv v8, v8, v16",
            "lbu {number}, 0({code})",
            "addi {code}, {code}, 1",
            "vle8.v v16, ({codes})",
            "addi {codes}, {codes}, 1",
            bits_apart!("number"),
            "vadd.vv v8, v8, v16",
            "vminu.vx v8, v8, {most}",
            ".if {averages}",
            "vle8.v v16, ({costs})",
            "vaaddu.vv v8, v8, v16",
            ".endif",
            "vse8.v v8, ({costs})",
            "add {costs}, {costs}, {stride}",
            "addi {width}, {width}, -1",
            "bnez {width}, 2b",
            width = inout(reg) width => _, number = out(reg) _, stride = in(reg) stride,
            vtype = in(reg) vtype,
            along = inout(reg) left_rows => _, across = inout(reg) left_rows.add(width) => _,
            code = inout(reg) left_rows.add(2 * width) => _,
            brightness = inout(reg) left.brightness.as_ptr() => _,
            low = inout(reg) right.add(low * count) => _, high = inout(reg) right.add(high * count) => _,
            acrosses = inout(reg) right.add(count) => _, codes = inout(reg) right.add(2 * count) => _,
            dark = inout(reg) right.add(3 * count) => _, costs = inout(reg) work.costs.as_mut_ptr() => _,
            most = in(reg) u32::from(work.penalties.cost), odd = in(reg) 0x55, pairs = in(reg) 0x33,
            between = const S::BETWEEN_PIXELS as u32, averages = const !S::WITHIN_EDGES as u32,
            out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
            out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _, out("v21") _,
            out("v22") _, out("v23") _, out("v24") _, out("v25") _, out("v26") _, out("v27") _, out("v28") _,
            out("v29") _, out("v30") _, out("v31") _, options(nostack),
        );
    }
}
