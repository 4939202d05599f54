//! The path from the right, added to the others, and the winner of each pixel.
#![allow(unsafe_code)]

use super::LANES;
use super::room::Room;
use crate::matching::backend::mve::windows::best_of_the_rest;
use crate::matching::backend::work::{MASKS, PathWork};
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::winners::Unique;
use core::arch::asm;

/// The path through a row, from its last column to column `begin`, the first that has a candidate.
pub(super) struct Leftward<'w, 'a, const STRIDE: usize> {
    pub work: &'w mut PathWork<'a>,
    pub begin: usize,
    /// What the path pays, of each column in the place of the next one.
    pub along: &'w [u16],
    pub room: Room<'w, STRIDE>,
    /// The rows of the winners: the cost below, their own, that above, the disparity.
    pub rows: &'w mut [u8],
}

impl<const STRIDE: usize> Leftward<'_, '_, STRIDE> {
    /// Selects the winners.
    #[inline(always)]
    pub fn select(mut self, mut unique: Unique<'_>) {
        let (width, begin) = (self.work.width, self.begin);
        let bytes = width * STRIDE;
        let is_whole = self.work.costs.len() >= bytes && self.work.sums.len() >= bytes;
        if !is_whole || self.along.len() <= width || self.rows.len() < 4 * width || begin >= width {
            return;
        }
        close(self.work, self.begin, STRIDE);
        self.room.begin();
        let mut least = 0;
        let (mut end, is_checked) = (width, unique.is_asked());
        while end > begin {
            let count = if is_checked { 1 } else { end - begin };
            // SAFETY: `count` columns before `end` are in the row, and four bytes for each in the rows of the
            // winners. `count` is not 0.
            unsafe { self.walk(count, end - 1, &mut least) };
            end -= count;
            if is_checked {
                let at = |row: usize| self.rows.get(row * width + end).copied().unwrap_or(0);
                let (cost, disparity) = (at(1), at(3));
                let sums = self.room.sums();
                unique.check(end, cost, || {
                    best_of_the_rest(disparity.into(), part(MASKS, MASKS.len() - STRIDE..), sums)
                });
            }
        }
    }

    /// Selects the winners of `count` pixels from column `x` on to the left: 17 instructions for 16
    /// candidates, two more where there are four times as many, and 19 for a pixel. `least` is the path's
    /// least cost.
    ///
    /// # Safety
    /// There are so many columns, of which `select` has made sure that all memory has them.
    #[inline(never)]
    unsafe fn walk(&mut self, count: usize, x: usize, least: &mut usize) {
        let width = self.work.width;
        let (costs, sums) = (self.work.costs.as_ptr(), self.work.sums.as_ptr());
        // SAFETY: as the function's. The winner is one of the lanes, and the bytes beside a lane are of the
        // room.
        unsafe {
            asm!(
                ".irp v, 0, 1, 2, 3",
                ".if \\v < {groups}",
                "vldrb.u8 q\\v, [{room}, #16 * \\v + {path_at}]",
                ".endif",
                ".endr",
                // Of two vectors the disparities stay in registers, and the sums do from loop to loop.
                ".if {groups} <= 2",
                "vldrb.u8 q2, [{room}, #{lanes_at}]",
                "vldrb.u8 q3, [{room}, #{lanes_at} + 16]",
                ".endif",
                "dls lr, {best}",
                "2:",
                "ldrh {step}, [{changes}], #-2",
                "vldrb.u8 q4, [{room}, #{path_at} - 1]",
                "lsr {jump}, {step}, #8",
                "sub {off}, {jump}, {least}",
                "mov {least}, #255",
                "mov {best}, #255",
                ".macro go_left v, near, next, sum",
                ".if \\v < {groups}",
                "vldrb.u8 \\next, [{room}, #16 * \\v + {path_at} + 1]",
                "vmin.u8 \\near, \\near, \\next",
                ".if \\v + 1 < {groups}",
                "vldrb.u8 \\next, [{room}, #16 * \\v + {path_at} + 15]",
                ".endif",
                "vqadd.u8 \\near, \\near, {step}",
                "vmin.u8 q\\v, q\\v, \\near",
                "vqadd.u8 q\\v, q\\v, {off}",
                "vldrb.u8 \\near, [{costs}, #16 * \\v]",
                "vsub.i8 q\\v, q\\v, {jump}",
                "vadd.i8 q\\v, q\\v, \\near",
                "vstrb.8 q\\v, [{room}, #16 * \\v + {path_at}]",
                "vminv.u8 {least}, q\\v",
                "vldrb.u8 \\sum, [{sums}, #16 * \\v]",
                "vqadd.u8 \\sum, \\sum, q\\v",
                "vstrb.8 \\sum, [{room}, #16 * \\v + {sums_at}]",
                "vminv.u8 {best}, \\sum",
                ".endif",
                ".endm",
                // The least of the disparities that have it.
                ".macro nearest v, sum, lanes",
                ".if \\v < {groups}",
                ".if {groups} > 2",
                "vldrb.u8 \\sum, [{room}, #16 * \\v + {sums_at}]",
                "vldrb.u8 q4, [{room}, #16 * \\v + {lanes_at}]",
                "vpt.i8 eq, \\sum, {best}",
                "vminvt.u8 {step}, q4",
                ".else",
                "vpt.i8 eq, \\sum, {best}",
                "vminvt.u8 {step}, \\lanes",
                ".endif",
                ".endif",
                ".endm",
                "go_left 0, q4, q5, q6",
                "go_left 1, q5, q4, q7",
                "go_left 2, q4, q5, q6",
                "go_left 3, q5, q4, q7",
                "mov {step}, #255",
                "nearest 0, q6, q2",
                "nearest 1, q7, q3",
                "nearest 2, q6, q4",
                "nearest 3, q7, q4",
                ".purgem go_left",
                ".purgem nearest",
                "sub {costs}, {costs}, #{stride}",
                "sub {sums}, {sums}, #{stride}",
                "sub {jump}, {room}, {step}",
                "strb {step}, [{row}, {width}, lsl #1]",
                "ldrb {step}, [{jump}, #{sums_at} + {stride} - 2]",
                "ldrb {jump}, [{jump}, #{sums_at} + {stride}]",
                "strb {step}, [{row}, {width}]",
                "sub {off}, {row}, {width}",
                "strb {jump}, [{off}]",
                "strb {best}, [{row}], #-1",
                "le lr, 2b",
                best = inout(reg) count => _, costs = inout(reg) costs.add(x * STRIDE) => _,
                sums = inout(reg) sums.add(x * STRIDE) => _,
                changes = inout(reg) self.along.as_ptr().add(x + 1) => _, room = in(reg) self.room.middle(),
                row = inout(reg) self.rows.as_mut_ptr().add(width + x) => _, width = in(reg) width,
                least = inout(reg) *least, step = out(reg) _, jump = out(reg) _, off = out(reg) _,
                stride = const STRIDE, groups = const STRIDE / LANES,
                path_at = const Room::<STRIDE>::PATH_AT, sums_at = const Room::<STRIDE>::SUMS_AT,
                lanes_at = const Room::<STRIDE>::LANES_AT,
                out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
                out("q6") _, out("q7") _, options(nostack),
            );
        }
    }
}

/// Makes the sums of lanes that are not searched the most that there is, which they stay: the first pixels
/// from column `begin` on have fewer candidates than a column of `stride` has lanes.
#[inline(never)]
pub(super) fn close(work: &mut PathWork<'_>, begin: usize, stride: usize) {
    let (columns, disparities) = (work.width - begin, work.disparities.min(stride).max(1));
    let sums = part_mut(work.sums, begin * stride..);
    // The last columns have as many lanes as there are disparities, or there are none to be closed.
    let most = if disparities < stride { columns } else { columns.min(stride - 1) };
    if most == 0 || sums.len() < most * stride {
        return;
    }
    // SAFETY: of each of `most` columns at least one lane is written and at most all but one: the inner loop
    // is one for so many lanes of bytes.
    unsafe {
        asm!(
            "vmov.i8 q0, #255",
            "2:",
            "mov {lane}, {sums}",
            "dlstp.8 lr, {closed}",
            "3:",
            "vstrb.8 q0, [{lane}], #16",
            "letp lr, 3b",
            "cmp {closed}, {least}",
            "it hi",
            "subhi {closed}, {closed}, #1",
            "add {sums}, {sums}, {stride}",
            "subs {columns}, {columns}, #1",
            "bne 2b",
            sums = inout(reg) sums.as_mut_ptr() => _, columns = inout(reg) most => _,
            closed = inout(reg) stride - 1 => _, least = in(reg) (stride - disparities).max(1),
            lane = out(reg) _, stride = in(reg) stride, out("lr") _, out("q0") _, options(nostack),
        );
    }
}
