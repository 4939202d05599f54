//! The sums of the windows along a row, and the winner of each.
#![allow(unsafe_code)]

use super::LANES;
use super::sides::RECORD;
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::winners::BESIDE;
use core::arch::asm;

/// The complements of the lanes' disparities, the last of which is 0: the nearest disparity has the greatest.
static COMPLEMENTS: [u8; 64] = {
    let mut complements = [0; 64];
    let mut lane = 0;
    while lane < 64 {
        complements[lane] = u8::MAX - (63 - lane as u8);
        lane += 1;
    }
    complements
};

/// Windows that move along a row.
pub(super) struct Windows<'a, const STRIDE: usize> {
    /// Candidates of a column: `STRIDE`, unless that is 0.
    pub stride: usize,
    /// From the column on that leaves at the next pixel.
    pub leaves: &'a [u8],
    /// From the column on that enters there.
    pub enters: &'a [u8],
    /// The records of the pixels selected last, [`Self::at_once`] of them at most, then the sums, with a byte
    /// before them and three after.
    pub room: &'a mut [u8],
    /// Pixels that records have places for.
    pub at_once: usize,
}

/// Bytes beside the sums: one before them, and the rest of a word after them.
pub(super) const BESIDE_SUMS: usize = 4;

impl<'a, const STRIDE: usize> Windows<'a, STRIDE> {
    /// Windows over `stride` candidates, with what is left of the `room` for records: whole vectors of them,
    /// if there is place for one.
    pub fn new(stride: usize, leaves: &'a [u8], enters: &'a [u8], room: &'a mut [u8]) -> Self {
        let places = room.len().saturating_sub(stride + BESIDE_SUMS) / RECORD;
        let at_once = if places < LANES { places } else { places - places % LANES };
        Self { stride, leaves, enters, room, at_once }
    }

    /// The sums.
    pub fn sums(&mut self) -> &mut [u8] {
        let begin = RECORD * self.at_once + 1;
        part_mut(self.room, begin..begin + self.stride)
    }

    /// The cost and the disparity of the only pixel that was selected last.
    pub fn only(&self) -> (u8, u8) {
        self.room.first_chunk::<RECORD>().map_or((0, 0), |&[_, cost, _, complement]| (cost, !complement))
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
            && self.at_once >= count
            && self.room.len() >= RECORD * self.at_once + stride + BESIDE_SUMS
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
    /// a mask, and six for a pixel, seven if there are more than 48.
    #[inline(always)]
    fn select_among<S: WindowParameters, const MASKED: bool>(
        &mut self,
        count: usize,
        mask: &[u8],
        step: usize,
    ) {
        const { assert!(STRIDE.is_multiple_of(LANES) && STRIDE != LANES && STRIDE <= COMPLEMENTS.len()) };
        let Some(complements) = COMPLEMENTS.last_chunk::<STRIDE>() else { return };
        let sums = self.sums().as_mut_ptr();
        // SAFETY: [`Self::select`] asked for the lengths of what is read and written; `count` is not 0. The
        // winner is one of the lanes, and the word from the byte before a lane is of the room: the first
        // lane's stands in `before` at its complement, 256 less the number of lanes.
        unsafe {
            asm!(
                "dls lr, {count}",
                ".irp v, 0, 1, 2, 3",
                ".if \\v < {groups}",
                "vldrb.u8 q\\v, [{sums}, #16 * \\v]",
                ".endif",
                ".endr",
                ".if {groups} > 2",
                "vldrb.u8 q5, [{complements}, #{stride} - 48]",
                ".endif",
                "vldrb.u8 q6, [{complements}, #{stride} - 32]",
                "vldrb.u8 q7, [{complements}, #{stride} - 16]",
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
                // The nearest of the disparities that have it.
                "mov {nearest}, #0",
                ".irp v, 0, 1, 2, 3",
                ".if \\v + 3 < {groups}",
                "vldrb.u8 q4, [{complements}, #16 * \\v]",
                "vpt.i8 eq, q\\v, {least}",
                "vmaxvt.u8 {nearest}, q4",
                ".elseif \\v + 3 == {groups}",
                "vpt.i8 eq, q\\v, {least}",
                "vmaxvt.u8 {nearest}, q5",
                ".elseif \\v + 2 == {groups}",
                "vpt.i8 eq, q\\v, {least}",
                "vmaxvt.u8 {nearest}, q6",
                ".elseif \\v + 1 == {groups}",
                "vpt.i8 eq, q\\v, {least}",
                "vmaxvt.u8 {nearest}, q7",
                ".endif",
                ".endr",
                "ldr {least}, [{before}, {nearest}]",
                "bfi {least}, {nearest}, #24, #8",
                "str {least}, [{record}], #4",
                ".if {masked}",
                "add {mask}, {mask}, {step}",
                ".endif",
                "le lr, 2b",
                count = in(reg) count, enters = inout(reg) self.enters.as_ptr() => _,
                leaves = inout(reg) self.leaves.as_ptr() => _,
                sums = in(reg) sums, before = in(reg) sums.wrapping_sub(1 + (256 - STRIDE)),
                mask = inout(reg) mask.as_ptr() => _, step = in(reg) step,
                complements = in(reg) complements.as_ptr(),
                record = inout(reg) self.room.as_mut_ptr() => _,
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
                "lsr r4, {stride}, #4",
                "dls lr, r4",
                "sub r4, {stride}, #1",
                // The least of each lane in any vector, and the disparity of the last vector that has it.
                "vmov.i8 q3, #255",
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
                "vddup.u8 q0, r4, #1",
                "vptt.u8 cs, q3, q1",
                "vmovt q3, q1",
                "vmovt q4, q0",
                "le lr, 3b",
                "mov {least}, #255",
                "mov {nearest}, #255",
                "vminv.u8 {least}, q3",
                "vpt.i8 eq, q3, {least}",
                "vminvt.u8 {nearest}, q4",
                "add {mask}, {mask}, {back}",
                "sub r4, {sums}, {nearest}",
                "sub {sums}, {sums}, {stride}",
                "ldr r4, [r4, #-2]",
                "mvn {nearest}, {nearest}",
                "bfi r4, {nearest}, #24, #8",
                "str r4, [{record}], #4",
                "subs {count}, {count}, #1",
                "bne 2b",
                count = inout(reg) count => _, enters = inout(reg) self.enters.as_ptr() => _,
                leaves = inout(reg) self.leaves.as_ptr() => _,
                sums = inout(reg) self.room.as_mut_ptr().add(RECORD * self.at_once + 1) => _,
                mask = inout(reg) mask.as_ptr() => _, back = in(reg) step.wrapping_sub(self.stride),
                stride = in(reg) self.stride,
                record = inout(reg) self.room.as_mut_ptr() => _,
                least = out(reg) _, nearest = out(reg) _, shift = const S::COLUMN_SHIFT,
                out("r4") _, out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _,
                options(nostack),
            );
        }
    }

    /// Goes to the pixel that is so many after the next one.
    #[inline(always)]
    fn move_on(&mut self, count: usize) {
        self.leaves = part(self.leaves, count * self.stride..);
        self.enters = part(self.enters, count * self.stride..);
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
        // A copy of so few bytes by a routine takes longer.
        keep_loop();
        *kept = core::mem::replace(sum, u8::MAX);
    }
    let mut least = [u8::MAX; LANES];
    for (sums, mask) in sums.as_chunks::<LANES>().0.iter().zip(mask.as_chunks::<LANES>().0) {
        for i in 0..LANES {
            least[i] = least[i].min(sums[i] | mask[i]);
        }
    }
    for (kept, sum) in kept.iter().zip(part_mut(sums, nearest)) {
        keep_loop();
        *sum = *kept;
    }
    least.iter().fold(u8::MAX, |least, &lane| least.min(lane))
}
