//! The path from the left, added to that from above.
#![allow(unsafe_code)]

use super::LANES;
use super::down::Ring;
use crate::matching::backend::work::PathWork;
use crate::matching::memory::layout::COLUMNS_OFF;
use core::arch::asm;

/// Pixels whose columns follow each other in all memory: how many, the first one's costs, its path from
/// above, its sums, and its change. So many columns, and at least one, can be read there or written.
pub(super) struct Run {
    pub count: usize,
    pub costs: *const u8,
    pub top: *const u8,
    pub sums: *mut u8,
    pub changes: *const u16,
}

/// Takes the path through the row, of columns of `stride` bytes: `walk` does it for each run.
#[inline(always)]
pub(super) fn go(
    work: &mut PathWork<'_>,
    row: usize,
    changes: &[u16],
    stride: usize,
    mut walk: impl FnMut(Run),
) {
    let width = work.width;
    let bytes = width * stride;
    let is_whole = work.top.len() >= bytes + COLUMNS_OFF * stride && work.costs.len() >= bytes;
    if !is_whole || work.sums.len() < bytes || changes.len() < width {
        return;
    }
    let ring = Ring::new(width, row);
    let mut x = 0;
    while x < width {
        let (place, there) = ring.place(x);
        let count = there.min(width - x);
        // SAFETY: `count` columns are in the ring from the place on, and in the row from `x` on. `count` is
        // not 0.
        let run = unsafe {
            let top = work.top.as_ptr().add(place * stride);
            let (costs, sums) = (work.costs.as_ptr().add(x * stride), work.sums.as_mut_ptr().add(x * stride));
            Run { count, costs, top, sums, changes: changes.as_ptr().add(x) }
        };
        walk(run);
        x += count;
    }
}

/// The path of some pixels: 14 instructions for 16 candidates, and six for a pixel. `least` is the path's
/// least cost.
///
/// # Safety
/// Columns of the run have `STRIDE` bytes, and at `path` there is a path of a [`Room`](super::room::Room).
#[inline(always)]
pub(super) unsafe fn walk<const STRIDE: usize>(run: Run, least: &mut usize, path: *mut u8) {
    let Run { count, costs, top, sums, changes } = run;
    // The path is written 16 bytes at a time: what is read one byte before is read first.
    // SAFETY: as the function's.
    unsafe {
        asm!(
            ".irp v, 0, 1, 2, 3",
            ".if \\v < {groups}",
            "vldrb.u8 q\\v, [{path}, #16 * \\v]",
            ".endif",
            ".endr",
            "dls lr, {off}",
            "2:",
            "ldrh {step}, [{changes}], #2",
            "vldrb.u8 q4, [{path}, #-1]",
            "lsr {jump}, {step}, #8",
            "sub {off}, {jump}, {least}",
            "mov {least}, #255",
            ".macro go_right v, near, next",
            ".if \\v < {groups}",
            "vldrb.u8 \\next, [{path}, #16 * \\v + 1]",
            "vmin.u8 \\near, \\near, \\next",
            ".if \\v + 1 < {groups}",
            "vldrb.u8 \\next, [{path}, #16 * \\v + 15]",
            ".endif",
            "vqadd.u8 \\near, \\near, {step}",
            "vmin.u8 q\\v, q\\v, \\near",
            "vqadd.u8 q\\v, q\\v, {off}",
            "vldrb.u8 q6, [{costs}], #16",
            "vsub.i8 q\\v, q\\v, {jump}",
            "vadd.i8 q\\v, q\\v, q6",
            "vstrb.8 q\\v, [{path}, #16 * \\v]",
            "vminv.u8 {least}, q\\v",
            "vldrb.u8 q6, [{top}], #16",
            "vadd.i8 q6, q6, q\\v",
            "vstrb.8 q6, [{sums}], #16",
            ".endif",
            ".endm",
            "go_right 0, q4, q5",
            "go_right 1, q5, q4",
            "go_right 2, q4, q5",
            "go_right 3, q5, q4",
            ".purgem go_right",
            "le lr, 2b",
            off = inout(reg) count => _, costs = inout(reg) costs => _, top = inout(reg) top => _,
            sums = inout(reg) sums => _, changes = inout(reg) changes => _, path = in(reg) path,
            least = inout(reg) *least, step = out(reg) _, jump = out(reg) _,
            groups = const STRIDE / LANES,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
            out("q6") _, options(nostack),
        );
    }
}
