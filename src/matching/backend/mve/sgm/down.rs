//! The path from above: where it comes from is the average of two columns, rounded down.
#![allow(unsafe_code)]

use super::LANES;
use crate::matching::backend::mve::rows::fill;
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::layout::COLUMNS_OFF;
use core::arch::asm;

/// The ring of columns in which the paths from above are kept, two more than an image has. Each row stands
/// two columns before the row above it: a path goes where one of the two was that it comes from.
#[derive(Clone, Copy)]
pub(super) struct Ring {
    columns: usize,
    /// Where the row's first column is.
    first: usize,
}

impl Ring {
    /// The ring as it stands for row `row` of an image `width` pixels wide.
    pub fn new(width: usize, row: usize) -> Self {
        let columns = width + COLUMNS_OFF;
        let past = row.wrapping_mul(COLUMNS_OFF).checked_rem(columns).unwrap_or(0);
        Self { columns, first: (columns - past) % columns.max(1) }
    }

    /// Where the row above stands.
    fn above(self) -> Self {
        Self { first: self.wrapped(self.first + COLUMNS_OFF), ..self }
    }

    /// The place of a column, and how many there are from it on up to the end of the ring.
    pub fn place(self, column: usize) -> (usize, usize) {
        let place = self.wrapped(self.first + column);
        (place, self.columns - place)
    }

    fn wrapped(self, place: usize) -> usize {
        if place >= self.columns { place - self.columns } else { place }
    }
}

/// The places of the two columns that the path into column `x` comes from, each with how many there are from
/// it on. At the ends the nearest column that there is stands for those outside.
#[inline(always)]
fn sources(ring: Ring, width: usize, x: usize) -> [(usize, usize); 2] {
    let last = width.saturating_sub(1);
    [x.saturating_sub(COLUMNS_OFF), (x + COLUMNS_OFF).min(last)].map(|column| ring.above().place(column))
}

/// Pixels whose columns follow each other in all memory: how many, the two places that the first one's path
/// comes from, the one that it goes to, its costs, and its change. So many columns, and at least one, can be
/// read and written there in this order; the last place may be one of the two.
pub(super) struct Run {
    pub count: usize,
    pub from: [*const u8; 2],
    pub out: *mut u8,
    pub costs: *const u8,
    pub changes: *const u16,
}

/// Moves the path from above down to the row, of columns of `stride` bytes: `walk` does it for each run.
#[inline(always)]
pub(super) fn go(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    changes: &[u16],
    stride: usize,
    mut walk: impl FnMut(Run),
) {
    let width = work.width;
    let is_whole = work.top.len() >= (width + COLUMNS_OFF) * stride && work.costs.len() >= width * stride;
    if !is_whole || changes.len() < width || width == 0 {
        return;
    }
    // In the first row nothing is above.
    if guide.above.is_none() {
        fill(work.top, 0);
    }
    let ring = Ring::new(width, guide.row);
    let last = width - 1;
    let mut x = 0;
    while x < width {
        let [(before, of_before), (after, of_after)] = sources(ring, width, x);
        let (out, of_out) = ring.place(x);
        let is_inside = x >= COLUMNS_OFF && x + COLUMNS_OFF <= last;
        let alike = if is_inside { last + 1 - COLUMNS_OFF - x } else { 1 };
        let count = alike.min(of_before).min(of_after).min(of_out);
        let top = work.top.as_mut_ptr();
        // SAFETY: `count` columns from each of the three places on are in the ring, which `work.top` has,
        // and from `x` on in the row. `count` is not 0.
        let run = unsafe {
            let from = [before, after].map(|place| top.add(place * stride).cast_const());
            let (out, costs) = (top.add(out * stride), work.costs.as_ptr().add(x * stride));
            Run { count, from, out, costs, changes: changes.as_ptr().add(x) }
        };
        walk(run);
        x += count;
    }
}

/// The path of some pixels: 15 instructions for 16 candidates, and five for a pixel.
///
/// # Safety
/// Columns of the run have `STRIDE` bytes, and at `path` there is a path of a [`Room`](super::room::Room).
#[inline(always)]
pub(super) unsafe fn walk<const STRIDE: usize>(run: Run, path: *mut u8) {
    let Run { count, from: [before, after], out, costs, changes } = run;
    // SAFETY: as the function's.
    unsafe {
        asm!(
            "dls lr, {least}",
            "2:",
            "mov {least}, #255",
            ".irp v, 0, 1, 2, 3",
            ".if \\v < {groups}",
            "vldrb.u8 q4, [{before}], #16",
            "vldrb.u8 q5, [{after}], #16",
            "vhadd.u8 q\\v, q4, q5",
            "vstrb.8 q\\v, [{path}, #16 * \\v]",
            "vminv.u8 {least}, q\\v",
            ".endif",
            ".endr",
            "ldrh {step}, [{changes}], #2",
            "lsr {jump}, {step}, #8",
            "sub {least}, {jump}, {least}",
            ".irp v, 0, 1, 2, 3",
            ".if \\v < {groups}",
            "vldrb.u8 q4, [{path}, #16 * \\v - 1]",
            "vldrb.u8 q5, [{path}, #16 * \\v + 1]",
            "vmin.u8 q4, q4, q5",
            "vqadd.u8 q4, q4, {step}",
            "vmin.u8 q4, q4, q\\v",
            "vqadd.u8 q4, q4, {least}",
            "vldrb.u8 q5, [{costs}], #16",
            "vsub.i8 q4, q4, {jump}",
            "vadd.i8 q4, q4, q5",
            "vstrb.8 q4, [{out}], #16",
            ".endif",
            ".endr",
            "le lr, 2b",
            least = inout(reg) count => _, before = inout(reg) before => _, after = inout(reg) after => _,
            out = inout(reg) out => _, costs = inout(reg) costs => _, changes = inout(reg) changes => _,
            path = in(reg) path, step = out(reg) _, jump = out(reg) _, groups = const STRIDE / LANES,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
            options(nostack),
        );
    }
}
