//! The path from the left, and its sum with the one from above.

use super::columns::Columns;
use super::step::far;
use crate::matching::backend::work::PathWork;
use core::arch::asm;

/// Moves the path through row `row`, and adds to it the path from above: 23 instructions a pixel. `changes`
/// are what the path pays into each column from the one before it.
pub(super) fn right(work: &mut PathWork<'_>, row: usize, changes: &[u16], columns: Columns) {
    let Columns { stride, vtype } = columns;
    let (width, first) = (work.width, super::down::first(row));
    let lengths = [work.costs.len(), work.sums.len(), work.top.len().saturating_sub(first * stride)];
    if width == 0 || changes.len() < width || lengths.into_iter().any(|length| length < width * stride) {
        return;
    }
    // SAFETY: there are as many columns, one at least, and what is paid for each.
    unsafe {
        asm!(
            "vsetvl zero, {stride}, {vtype}",
            "li {least}, -1",
            "vmv.s.x v1, {least}",
            // A path that comes from nowhere costs nothing.
            "vmv.v.i v8, 0",
            "li {least}, 0",
            "2:",
            change!("step", "jump", "changes"),
            "addi {changes}, {changes}, 2",
            step!("step", "jump"),
            "add {costs}, {costs}, {stride}",
            least!("v8", "least"),
            "vle8.v v16, ({top})",
            "add {top}, {top}, {stride}",
            "vadd.vv v16, v16, v8",
            "vse8.v v16, ({sums})",
            "add {sums}, {sums}, {stride}",
            "addi {width}, {width}, -1",
            "bnez {width}, 2b",
            width = inout(reg) width => _, stride = in(reg) stride, vtype = in(reg) vtype,
            costs = inout(reg) work.costs.as_ptr() => _, sums = inout(reg) work.sums.as_mut_ptr() => _,
            top = inout(reg) work.top.as_ptr().add(first * stride) => _,
            changes = inout(reg) changes.as_ptr() => _, far = in(reg) far(work.penalties),
            least = out(reg) _, step = out(reg) _, jump = out(reg) _,
            out("v1") _, out("v2") _,
            out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
            out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _, out("v21") _,
            out("v22") _, out("v23") _, out("v24") _, out("v25") _, out("v26") _, out("v27") _, out("v28") _,
            out("v29") _, out("v30") _, out("v31") _, options(nostack),
        );
    }
}
