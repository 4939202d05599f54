//! The path from above: where it comes from is the average of two columns, rounded down.
//!
//! The paths stand in memory for two columns more than an image has. The rows go through it in turns to the
//! right, each column two places before the one that it replaces, and back: so what is replaced is done with.

use super::columns::Columns;
use super::step::far;
use crate::matching::backend::work::PathWork;
use crate::matching::memory::layout::COLUMNS_OFF;
use core::arch::asm;

/// The place of the first column of row `row`.
pub(super) const fn first(row: usize) -> usize {
    if row.is_multiple_of(2) { 0 } else { COLUMNS_OFF }
}

/// Pixels whose columns follow each other.
struct Run {
    /// How many, one at least.
    count: usize,
    /// The places of the two columns that the first one's path comes from, and of the one that it goes to.
    from: [usize; 2],
    to: usize,
    /// The first one's column.
    x: usize,
}

/// Moves the path down to row `row`. `changes` are what each pixel's path pays.
pub(super) fn down(work: &mut PathWork<'_>, row: usize, changes: &[u16], columns: Columns) {
    let (width, stride) = (work.width, columns.stride);
    let is_whole = work.top.len() >= (width + COLUMNS_OFF) * stride && work.costs.len() >= width * stride;
    if !is_whole || changes.len() < width || width == 0 {
        return;
    }
    let last = width - 1;
    let (here, above) = (first(row), COLUMNS_OFF - first(row));
    let is_rightward = here < above;
    let mut done = 0;
    while done < width {
        // At both ends the nearest column that there is stands for those outside.
        let is_inside = done >= COLUMNS_OFF && done + COLUMNS_OFF < width;
        let count = if is_inside { width - COLUMNS_OFF - done } else { 1 };
        let x = if is_rightward { done } else { last - done };
        let from = [x.saturating_sub(COLUMNS_OFF), (x + COLUMNS_OFF).min(last)].map(|column| above + column);
        let run = Run { count, from, to: here + x, x };
        // SAFETY: of all that many columns each stands in its memory, as asked above: on the way to the right
        // they end, and on the way to the left they begin, two before an end of the row.
        unsafe { walk(work, run, changes, columns, is_rightward) };
        done += count;
    }
}

/// Moves the path into some pixels, one after the other to the right or to the left: 26 instructions a pixel.
///
/// # Safety
/// All columns of the run are in memory.
unsafe fn walk(work: &mut PathWork<'_>, run: Run, changes: &[u16], columns: Columns, is_rightward: bool) {
    let Columns { stride, vtype } = columns;
    let Run { count, from: [a, b], to, x } = run;
    let (on, next) = if is_rightward { (stride as isize, 2) } else { (-(stride as isize), -2) };
    let top = work.top.as_mut_ptr();
    // SAFETY: as the function's.
    unsafe {
        asm!(
            "vsetvl zero, {stride}, {vtype}",
            // Averages are rounded down.
            "csrwi vxrm, 2",
            "li {least}, -1",
            "vmv.s.x v1, {least}",
            "2:",
            "vle8.v v8, ({a})",
            "add {a}, {a}, {on}",
            "vle8.v v16, ({b})",
            "add {b}, {b}, {on}",
            "vaaddu.vv v8, v8, v16",
            least!("v8", "least"),
            change!("step", "jump", "changes"),
            "add {changes}, {changes}, {next}",
            step!("step", "jump"),
            "add {costs}, {costs}, {on}",
            "vse8.v v8, ({to})",
            "add {to}, {to}, {on}",
            "addi {count}, {count}, -1",
            "bnez {count}, 2b",
            count = inout(reg) count => _, stride = in(reg) stride, vtype = in(reg) vtype,
            a = inout(reg) top.add(a * stride) => _, b = inout(reg) top.add(b * stride) => _,
            to = inout(reg) top.add(to * stride) => _, on = in(reg) on, next = in(reg) next,
            costs = inout(reg) work.costs.as_ptr().add(x * stride) => _,
            changes = inout(reg) changes.as_ptr().add(x) => _, far = in(reg) far(work.penalties),
            least = out(reg) _, step = out(reg) _, jump = out(reg) _,
            out("v1") _, out("v2") _,
            out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
            out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _, out("v21") _,
            out("v22") _, out("v23") _, out("v24") _, out("v25") _, out("v26") _, out("v27") _, out("v28") _,
            out("v29") _, out("v30") _, out("v31") _, options(nostack),
        );
    }
}
