//! The sums of the windows along a row, and the winner of each.
#![allow(unsafe_code)]

use super::LANES;
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::winners::BESIDE;
use core::arch::asm;

/// The disparities of the lanes.
static DISPARITIES: [u8; 64] = {
    let mut disparities = [0; 64];
    let mut lane = 0;
    while lane < 64 {
        disparities[lane] = (63 - lane) as u8;
        lane += 1;
    }
    disparities
};

/// Windows that move along a row.
pub(super) struct Windows<'a, const STRIDE: usize> {
    /// Candidates of a column: `STRIDE`, unless that is 0.
    pub stride: usize,
    /// From the column on that leaves at the next pixel.
    pub leaves: &'a [u8],
    /// From the column on that enters there.
    pub enters: &'a [u8],
    /// The sums, with a byte before them and one after.
    pub sums: &'a mut [u8],
    /// From the next pixel on: the cost below it. `width` bytes after it stands its own cost, then the cost
    /// above it, then the disparity.
    pub rows: &'a mut [u8],
    /// Pixels in a row.
    pub width: usize,
}

impl<const STRIDE: usize> Windows<'_, STRIDE> {
    /// The cost and the disparity of the pixel before the next one.
    pub fn last(&self) -> (u8, u8) {
        let at = |place: usize| self.rows.get(place).copied().unwrap_or(0);
        (at(self.width - 1), at(3 * self.width - 1))
    }

    /// Selects the winners of the next `count` pixels. Lanes with ones in the `mask` are not selected; for
    /// each pixel it moves on by `step`. Where there is no disparity below or above the winner, what is
    /// said of it means nothing.
    #[inline(never)]
    pub fn select<S: WindowParameters, const MASKED: bool>(
        &mut self,
        count: usize,
        mask: &[u8],
        step: usize,
    ) {
        let stride = if STRIDE > 0 { STRIDE } else { self.stride };
        let columns = count * stride;
        let is_there = self.leaves.len() >= columns
            && self.enters.len() >= columns
            && self.sums.len() == stride + 2
            && self.rows.len() >= 3 * self.width + count
            && (!MASKED || mask.len() >= stride + count * step);
        if count == 0 || stride < LANES || !is_there {
            return;
        }
        if STRIDE > 0 {
            self.select_among::<S, MASKED>(count, mask, step);
        } else {
            self.select_among_any::<S>(count, mask, step);
        }
        self.move_on(count);
    }

    /// [`Self::select`] among `STRIDE` candidates: eight instructions for 16 of them, two more where there is
    /// a mask, and ten for a pixel.
    #[inline(always)]
    fn select_among<S: WindowParameters, const MASKED: bool>(
        &mut self,
        count: usize,
        mask: &[u8],
        step: usize,
    ) {
        const { assert!(STRIDE.is_multiple_of(LANES) && STRIDE != LANES && STRIDE <= DISPARITIES.len()) };
        let Some(lanes) = DISPARITIES.last_chunk::<STRIDE>() else { return };
        // SAFETY: [`Self::select`] asked for the lengths of what is read and written; `count` is not 0. The
        // winner is one of the lanes, and the bytes beside a lane are of `self.sums`.
        unsafe {
            asm!(
                "dls lr, {count}",
                ".irp v, 0, 1, 2, 3",
                ".if \\v < {groups}",
                "vldrb.u8 q\\v, [{sums}, #16 * \\v]",
                ".endif",
                ".endr",
                "vldrb.u8 q6, [{disparities}, #{stride} - 32]",
                "vldrb.u8 q7, [{disparities}, #{stride} - 16]",
                "2:",
                "mov {least}, #255",
                ".irp v, 0, 1, 2, 3",
                ".if \\v < {groups}",
                "vldrb.u8 q4, [{enters}], #16",
                ".if {shift}",
                "vshr.u8 q4, q4, #{shift}",
                ".endif",
                "vadd.i8 q\\v, q\\v, q4",
                "vldrb.u8 q4, [{leaves}], #16",
                ".if {shift}",
                "vshr.u8 q4, q4, #{shift}",
                ".endif",
                "vsub.i8 q\\v, q\\v, q4",
                "vstrb.8 q\\v, [{sums}, #16 * \\v]",
                ".if {masked}",
                "vldrb.u8 q4, [{mask}, #16 * \\v]",
                "vorr q4, q4, q\\v",
                "vminv.u8 {least}, q4",
                ".else",
                "vminv.u8 {least}, q\\v",
                ".endif",
                ".endif",
                ".endr",
                // The least of the disparities that have it.
                "mov {nearest}, #255",
                ".irp v, 0, 1, 2, 3",
                ".if \\v + 2 < {groups}",
                "vldrb.u8 q5, [{disparities}, #16 * \\v]",
                "vpt.i8 eq, q\\v, {least}",
                "vminvt.u8 {nearest}, q5",
                ".elseif \\v + 2 == {groups}",
                "vpt.i8 eq, q\\v, {least}",
                "vminvt.u8 {nearest}, q6",
                ".elseif \\v + 1 == {groups}",
                "vpt.i8 eq, q\\v, {least}",
                "vminvt.u8 {nearest}, q7",
                ".endif",
                ".endr",
                "strb {least}, [{row}, {width}]",
                "strb {nearest}, [{row}, {widths}]",
                "sub {nearest}, {sums}, {nearest}",
                "ldrb {least}, [{nearest}, #{stride} - 2]",
                "strb {least}, [{row}, {width}, lsl #1]",
                "ldrb {least}, [{nearest}, #{stride}]",
                "strb {least}, [{row}], #1",
                ".if {masked}",
                "add {mask}, {mask}, {step}",
                ".endif",
                "le lr, 2b",
                count = in(reg) count, enters = inout(reg) self.enters.as_ptr() => _,
                leaves = inout(reg) self.leaves.as_ptr() => _, sums = in(reg) self.sums.as_mut_ptr().add(1),
                mask = inout(reg) mask.as_ptr() => _, step = in(reg) step,
                disparities = in(reg) lanes.as_ptr(),
                row = inout(reg) self.rows.as_mut_ptr() => _, width = in(reg) self.width,
                widths = in(reg) 3 * self.width,
                least = out(reg) _, nearest = out(reg) _,
                stride = const STRIDE, groups = const STRIDE / LANES, shift = const S::COLUMN_SHIFT,
                masked = const MASKED as u32,
                out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
                out("q6") _,
                out("q7") _, options(nostack),
            );
        }
    }

    /// [`Self::select`] among any number of candidates, with a mask: 17 instructions for 16 of them, two more
    /// where only some digits of the columns count, and 21 for a pixel.
    #[inline(always)]
    fn select_among_any<S: WindowParameters>(&mut self, count: usize, mask: &[u8], step: usize) {
        // SAFETY: as for `select_among`.
        unsafe {
            asm!(
                "2:",
                "mov {least}, #255",
                "lsr r4, {stride}, #4",
                "dls lr, r4",
                "3:",
                "vldrb.u8 q1, [{enters}], #16",
                "vldrb.u8 q2, [{leaves}], #16",
                ".if {shift}",
                "vshr.u8 q1, q1, #{shift}",
                "vshr.u8 q2, q2, #{shift}",
                ".endif",
                "vldrb.u8 q0, [{sums}]",
                "vadd.i8 q0, q0, q1",
                "vsub.i8 q0, q0, q2",
                "vldrb.u8 q1, [{mask}], #16",
                "vstrb.8 q0, [{sums}], #16",
                "vorr q1, q1, q0",
                "vminv.u8 {least}, q1",
                "le lr, 3b",
                "sub {mask}, {mask}, {stride}",
                "add {mask}, {mask}, {step}",
                "sub {sums}, {sums}, {stride}",
                // The least of the disparities that have it.
                "mov {nearest}, #255",
                "dls lr, r4",
                "sub r4, {stride}, #1",
                "3:",
                "vldrb.u8 q0, [{sums}], #16",
                "vddup.u8 q1, r4, #1",
                "vpt.i8 eq, q0, {least}",
                "vminvt.u8 {nearest}, q1",
                "le lr, 3b",
                "add r4, {width}, {width}, lsl #1",
                "strb {least}, [{row}, {width}]",
                "strb {nearest}, [{row}, r4]",
                "sub r4, {sums}, {nearest}",
                "sub {sums}, {sums}, {stride}",
                "ldrb {least}, [r4, #-2]",
                "strb {least}, [{row}, {width}, lsl #1]",
                "ldrb {least}, [r4]",
                "strb {least}, [{row}], #1",
                "subs {count}, {count}, #1",
                "bne 2b",
                count = inout(reg) count => _, enters = inout(reg) self.enters.as_ptr() => _,
                leaves = inout(reg) self.leaves.as_ptr() => _,
                sums = inout(reg) self.sums.as_mut_ptr().add(1) => _,
                mask = inout(reg) mask.as_ptr() => _, step = in(reg) step, stride = in(reg) self.stride,
                row = inout(reg) self.rows.as_mut_ptr() => _, width = in(reg) self.width,
                least = out(reg) _, nearest = out(reg) _, shift = const S::COLUMN_SHIFT,
                out("r4") _, out("lr") _, out("q0") _, out("q1") _, out("q2") _, options(nostack),
            );
        }
    }

    /// Goes to the pixel that is so many after the next one.
    #[inline(always)]
    fn move_on(&mut self, count: usize) {
        self.leaves = part(self.leaves, count * self.stride..);
        self.enters = part(self.enters, count * self.stride..);
        let rows = core::mem::take(&mut self.rows);
        self.rows = part_mut(rows, count..);
    }
}

/// The other side for the side that a winner lacks which is the smallest or the last of the pixel's
/// candidates: of these the first pixel has one, the next one two, and so on up to `disparities`. Twelve
/// instructions for 16 pixels.
#[inline(never)]
pub(super) fn complete(rows: [&mut [u8]; 4], disparities: usize) {
    let [below, costs, above, winners] = rows;
    let count = winners.len();
    if count == 0 || below.len() < count || above.len() < count {
        return;
    }
    // SAFETY: `count` bytes are read and written of each row; the loop is one for so many lanes of bytes.
    unsafe {
        asm!(
            "vidup.u8 q4, r4, #1",
            "vdup.8 q5, {last}",
            "dlstp.8 lr, {count}",
            "2:",
            "vldrb.u8 q0, [{winners}], #16",
            "vldrb.u8 q1, [{below}]",
            "vldrb.u8 q2, [{above}]",
            "vpt.i8 eq, q0, zr",
            "vmovt q1, q2",
            "vmin.u8 q3, q4, q5",
            "vpt.i8 eq, q0, q3",
            "vmovt q2, q1",
            "vqadd.u8 q4, q4, {lanes}",
            "vstrb.8 q1, [{below}], #16",
            "vstrb.8 q2, [{above}], #16",
            "letp lr, 2b",
            count = in(reg) count, last = in(reg) disparities - 1, lanes = in(reg) LANES,
            winners = inout(reg) winners.as_ptr() => _, below = inout(reg) below.as_mut_ptr() => _,
            above = inout(reg) above.as_mut_ptr() => _,
            inout("r4") 0 => _, out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _,
            out("q5") _, options(nostack),
        );
    }
    // The only candidate has none beside it.
    if let (Some(below), Some(above), Some(&cost)) = (below.first_mut(), above.first_mut(), costs.first()) {
        (*below, *above) = (cost, cost);
    }
}

/// The least cost of the candidates over [`BESIDE`] px beside the winner; `u8::MAX` where there is none.
#[inline(never)]
pub(super) fn best_of_the_rest(disparity: usize, mask: &[u8], sums: &mut [u8]) -> u8 {
    // The winner and those beside it are raised while the others are looked at.
    let lane = (sums.len() - 1).saturating_sub(disparity);
    let nearest = lane.saturating_sub(BESIDE)..sums.len().min(lane + BESIDE + 1);
    let mut kept = [u8::MAX; 2 * BESIDE + 1];
    for (kept, sum) in kept.iter_mut().zip(part_mut(sums, nearest.clone())) {
        *kept = core::mem::replace(sum, u8::MAX);
    }
    let mut least = [u8::MAX; LANES];
    for (sums, mask) in sums.as_chunks::<LANES>().0.iter().zip(mask.as_chunks::<LANES>().0) {
        for i in 0..LANES {
            least[i] = least[i].min(sums[i] | mask[i]);
        }
    }
    for (kept, sum) in kept.iter().zip(part_mut(sums, nearest)) {
        *sum = *kept;
    }
    least.iter().fold(u8::MAX, |least, &lane| least.min(lane))
}
