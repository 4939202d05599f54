//! The paths of columns of any number of vectors, for runs of pixels: what the others have in registers is in
//! memory here.
#![allow(unsafe_code)]

use super::{down, rightward};
use core::arch::asm;

/// The step of a path along the row, in place, of 16 candidates. Before it `q4` has the costs from one byte
/// before the path's on, and after it `q5` has those of the next 16.
macro_rules! step_along {
    () => {
        concat!(
            "vldrb.u8 q5, [{path}, #1]\n",
            "vmin.u8 q4, q4, q5\n",
            "vldrb.u8 q5, [{path}, #15]\n",
            "vqadd.u8 q4, q4, {step}\n",
            "vldrb.u8 q0, [{path}]\n",
            "vmin.u8 q0, q0, q4\n",
            "vqadd.u8 q0, q0, {off}\n",
            "vldrb.u8 q1, [{costs}], #16\n",
            "vsub.i8 q0, q0, {jump}\n",
            "vadd.i8 q0, q0, q1\n",
            "vstrb.8 q0, [{path}], #16\n",
            "vminv.u8 {least}, q0\n",
        )
    };
}

/// The path from above of some pixels: 18 instructions for 16 candidates, and ten for a pixel.
///
/// # Safety
/// Columns of the run have `groups` vectors, and at `path` there are as many bytes to write, with one before
/// and one after that no path comes from. `groups` is not 0.
#[inline(always)]
pub(super) unsafe fn walk_down(run: down::Run, groups: usize, path: *mut u8) {
    let down::Run { count, from: [before, after], out, costs, changes } = run;
    // SAFETY: as the function's.
    unsafe {
        asm!(
            "2:",
            "dls lr, {groups}",
            "mov {least}, #255",
            "3:",
            "vldrb.u8 q0, [{before}], #16",
            "vldrb.u8 q1, [{after}], #16",
            "vhadd.u8 q0, q0, q1",
            "vstrb.8 q0, [{path}], #16",
            "vminv.u8 {least}, q0",
            "le lr, 3b",
            "ldrh {step}, [{changes}], #2",
            "sub {path}, {path}, {groups}, lsl #4",
            "lsr {jump}, {step}, #8",
            "sub {least}, {jump}, {least}",
            "dls lr, {groups}",
            "3:",
            "vldrb.u8 q4, [{path}, #-1]",
            "vldrb.u8 q5, [{path}, #1]",
            "vmin.u8 q4, q4, q5",
            "vldrb.u8 q0, [{path}], #16",
            "vqadd.u8 q4, q4, {step}",
            "vmin.u8 q0, q0, q4",
            "vqadd.u8 q0, q0, {least}",
            "vldrb.u8 q1, [{costs}], #16",
            "vsub.i8 q0, q0, {jump}",
            "vadd.i8 q0, q0, q1",
            "vstrb.8 q0, [{out}], #16",
            "le lr, 3b",
            "sub {path}, {path}, {groups}, lsl #4",
            "subs {count}, {count}, #1",
            "bne 2b",
            count = inout(reg) count => _, before = inout(reg) before => _, after = inout(reg) after => _,
            out = inout(reg) out => _, costs = inout(reg) costs => _, changes = inout(reg) changes => _,
            path = inout(reg) path => _, groups = in(reg) groups, least = out(reg) _, step = out(reg) _,
            jump = out(reg) _, out("lr") _, out("q0") _, out("q1") _, out("q4") _, out("q5") _,
            options(nostack),
        );
    }
}

/// The path from the left of some pixels: 17 instructions for 16 candidates, and nine for a pixel. `least` is
/// the path's least cost.
///
/// # Safety
/// As [`walk_down`]'s; the path is read as well.
#[inline(always)]
pub(super) unsafe fn walk_right(run: rightward::Run, groups: usize, least: &mut usize, path: *mut u8) {
    let rightward::Run { count, costs, top, sums, changes } = run;
    // The path is written 16 bytes at a time: what is read one byte before is read first.
    // SAFETY: as the function's.
    unsafe {
        asm!(
            "2:",
            "ldrh {step}, [{changes}], #2",
            "dls lr, {groups}",
            "lsr {jump}, {step}, #8",
            "sub {off}, {jump}, {least}",
            "mov {least}, #255",
            "vldrb.u8 q4, [{path}, #-1]",
            "3:",
            step_along!(),
            "vldrb.u8 q1, [{top}], #16",
            "vadd.i8 q1, q1, q0",
            "vstrb.8 q1, [{sums}], #16",
            "vmov q4, q5",
            "le lr, 3b",
            "sub {path}, {path}, {groups}, lsl #4",
            "subs {count}, {count}, #1",
            "bne 2b",
            count = inout(reg) count => _, costs = inout(reg) costs => _, top = inout(reg) top => _,
            sums = inout(reg) sums => _, changes = inout(reg) changes => _, path = inout(reg) path => _,
            groups = in(reg) groups, least = inout(reg) *least, step = out(reg) _, jump = out(reg) _,
            off = out(reg) _, out("lr") _, out("q0") _, out("q1") _, out("q4") _, out("q5") _,
            options(nostack),
        );
    }
}

/// Where a path from the right is. The assembly reads and writes the numbers in this order.
#[repr(C)]
pub(super) struct Leftward {
    /// The change into the pixel, and its place in the second row of winners.
    pub change: *const u16,
    pub row: *mut u8,
    /// Bytes from row to row.
    pub width: usize,
    /// Pixels that are to come.
    pub count: usize,
}

/// The path from the right of some pixels, added to their sums, and their winners: 21 instructions for 16
/// candidates, and 36 for a pixel. `least` is the path's least cost.
///
/// # Safety
/// At `costs` there are the first pixel's costs, of `groups` vectors, with those of the pixels to come before
/// them, and at `sums` its sums, likewise, which are written as well; changes are read, and the four rows of
/// the winners written, of as many pixels. Of pixels that have fewer candidates than lanes the lanes without
/// one are 255 in the sums, and the first pixel of a line has one candidate. At `path` there are as many
/// bytes as in a column, with one before and one after that no path comes from. Neither number is 0.
#[inline(never)]
pub(super) unsafe fn walk_left(
    mut at: Leftward,
    groups: usize,
    least: &mut usize,
    path: *mut u8,
    costs: *const u8,
    sums: *mut u8,
) {
    // SAFETY: as the function's. What stands beside the winner is one of the column's lanes, but below
    // disparity 0, where nothing is read, and above the last lane, before which is another column.
    unsafe {
        asm!(
            "2:",
            "ldr {jump}, [{at}]",
            "dls lr, {groups}",
            "ldrh {step}, [{jump}], #-2",
            "str {jump}, [{at}]",
            "lsr {jump}, {step}, #8",
            "sub {off}, {jump}, {least}",
            "mov {least}, #255",
            "mov {best}, #255",
            "vldrb.u8 q4, [{path}, #-1]",
            // The least of each lane in any vector, and the disparity of the last vector that has it.
            "vmov.i8 q2, #255",
            "lsl r4, {groups}, #4",
            "sub r4, r4, #1",
            "3:",
            step_along!(),
            "vldrb.u8 q1, [{sums}]",
            "vqadd.u8 q1, q1, q0",
            "vstrb.8 q1, [{sums}], #16",
            "vddup.u8 q6, r4, #1",
            "vptt.u8 cs, q2, q1",
            "vmovt q2, q1",
            "vmovt q3, q6",
            "vmov q4, q5",
            "le lr, 3b",
            "vminv.u8 {best}, q2",
            "mov {off}, #255",
            "vpt.i8 eq, q2, {best}",
            "vminvt.u8 {off}, q3",
            "ldrd {jump}, {step}, [{at}, #4]",
            "strb {best}, [{jump}]",
            "strb {off}, [{jump}, {step}, lsl #1]",
            "sub r4, {sums}, {off}",
            "ldrb {best}, [r4, #-2]",
            "strb {best}, [{jump}, {step}]",
            "sub {step}, {jump}, {step}",
            "cmp {off}, #0",
            "it ne",
            "ldrbne {best}, [r4]",
            "strb {best}, [{step}]",
            "sub {jump}, {jump}, #1",
            "str {jump}, [{at}, #4]",
            "sub {path}, {path}, {groups}, lsl #4",
            "sub {costs}, {costs}, {groups}, lsl #5",
            "ldr {jump}, [{at}, #12]",
            "sub {sums}, {sums}, {groups}, lsl #5",
            "subs {jump}, {jump}, #1",
            "str {jump}, [{at}, #12]",
            "bne 2b",
            at = in(reg) &raw mut at, groups = in(reg) groups, path = inout(reg) path => _,
            costs = inout(reg) costs => _, sums = inout(reg) sums => _, least = inout(reg) *least,
            step = out(reg) _, jump = out(reg) _, off = out(reg) _, best = out(reg) _,
            out("r4") _, out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _,
            out("q5") _, out("q6") _, options(nostack),
        );
    }
}
