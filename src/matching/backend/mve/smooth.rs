//! The surfaces along a row, and answers averaged within them: what `surface/lanes.rs` does.
#![allow(unsafe_code)]

use super::LANES;
use super::rows::{copy, fill};
use crate::matching::backend::portable::smooth::{MARGIN, RECIPROCALS};
use crate::matching::config::Checks;
use crate::matching::memory::slices::{part_mut, split_mut};
use crate::matching::memory::views::view_mut;
use crate::units::Disparity;
use core::arch::asm;
use core::mem::MaybeUninit;

/// How far the answers around a pixel reach, to each side.
const REACH: usize = MARGIN / 2;

/// The radius that has code of its own.
const USUAL: usize = Checks::DEFAULT.smoothing_radius as usize;

/// The reciprocals of 1, 3, 5 and so on, by 2^16; the first, which nothing is multiplied by, as 0.
static HALVES: [u16; REACH + 1] = {
    let mut halves = [0; REACH + 1];
    let mut reach = 0;
    while reach <= REACH {
        halves[reach] = RECIPROCALS[reach] as u16;
        reach += 1;
    }
    halves
};

/// [`Isa::smooth`](crate::matching::backend::Isa::smooth); a length is at most 255.
#[inline(never)]
pub(super) fn smooth(
    answers: &mut [Disparity],
    lengths: &mut [u8],
    room: &mut [u16],
    step: Disparity,
    radius: u8,
) {
    let width = answers.len();
    let Some(room) = room.get_mut(..width + MARGIN) else { return };
    // The answers as they were, with none outside.
    let (before, more) = split_mut(room, REACH);
    let (inside, after) = split_mut(more, width);
    fill(before, Disparity::NONE.raw());
    fill(after, Disparity::NONE.raw());
    copy(answers, inside);
    match usize::from(radius) {
        USUAL => pairs::<USUAL>(answers, room, step, USUAL),
        radius => pairs::<0>(answers, room, step, radius.min(REACH)),
    }
    count(room, lengths, width);
}

/// Averages the answers, which `room` holds with [`REACH`] before and after; leaves in the `room`, from its
/// beginning, a byte for each: all ones where a surface begins.
///
/// For eight answers 13 instructions and 10 for each pair where the `RADIUS` is known; where it is not, and
/// 0, 23 and 14, in less flash.
#[inline(never)]
fn pairs<const RADIUS: usize>(answers: &mut [Disparity], room: &mut [u16], step: Disparity, radius: usize) {
    const { assert!(RADIUS <= REACH) };
    let count = answers.len();
    if count == 0 || room.len() < count + MARGIN || RADIUS > 0 && RADIUS != radius {
        return;
    }
    let room = room.as_mut_ptr();
    // SAFETY: of the `room` there is read from `REACH` before to `REACH` after each answer. The bytes are
    // written behind what is still to be read: with answers from `x` on, up to `x + 8`, where the next
    // ones read from byte `2 * (x + 8)` on. As many `answers` are written as there are: the loop is one
    // for so many lanes of half-words. `HALVES` are read at twice the number of pairs, in bytes.
    unsafe {
        asm!(
            // The predicate stays from pair to pair: the lanes whose pairs are all of the surface so far.
            ".macro add_pair left, right, apart",
            "vpstttt",
            "vcmpt.u16 cs, q7, \\apart",
            "vaddt.i16 q3, q3, \\left",
            "vaddt.i16 q3, q3, \\right",
            "vaddt.i16 q4, q4, {two}",
            ".endm",
            "vdup.16 q7, {step}",
            "dlstp.16 lr, {count}",
            "2:",
            "vldrh.u16 q0, [{at}], #16",
            "vldrh.u16 q5, [{at}, #-18]",
            "vmov.i32 q3, #0",
            "vmov.i8 q2, #255",
            "vabd.u16 q1, q0, q5",
            "vcmp.u16 hi, q1, {step}",
            "vpsel q2, q2, q3",
            "vstrb.16 q2, [r0], #8",
            ".if {radius} == 0",
            // Pair by pair, out to any radius.
            "sub {near}, {at}, #18",
            "sub {far}, {at}, #14",
            "vmov q5, q0",
            "vmov q6, q0",
            "vmov.i32 q4, #0",
            // At first all lanes.
            "vcmp.i16 eq, q0, q0",
            "movs {pair}, {any}",
            "beq 4f",
            "3:",
            "vldrh.u16 q1, [{near}], #-2",
            "vldrh.u16 q2, [{far}], #2",
            "vabd.u16 q5, q5, q1",
            "vabd.u16 q6, q6, q2",
            "vmax.u16 q5, q5, q6",
            "add_pair q1, q2, q5",
            "vmov q5, q1",
            "vmov q6, q2",
            "subs {pair}, #1",
            "bne 3b",
            ".else",
            "vldrh.u16 q6, [{at}, #-14]",
            "vabd.u16 q2, q0, q6",
            "vmov.i32 q4, #0",
            "vmax.u16 q1, q1, q2",
            "vpttt.u16 cs, q7, q1",
            "vaddt.i16 q3, q3, q5",
            "vaddt.i16 q3, q3, q6",
            "vaddt.i16 q4, q4, {two}",
            ".irp pair, 2, 4, 6, 8",
            ".if \\pair <= {radius}",
            "vldrh.u16 q1, [{at}, #-16 - 2 * \\pair]",
            "vabd.u16 q5, q5, q1",
            "vldrh.u16 q2, [{at}, #-16 + 2 * \\pair]",
            "vabd.u16 q6, q6, q2",
            "vmax.u16 q5, q5, q6",
            "add_pair q1, q2, q5",
            ".endif",
            ".if \\pair < {radius}",
            "vldrh.u16 q5, [{at}, #-18 - 2 * \\pair]",
            "vabd.u16 q1, q1, q5",
            "vldrh.u16 q6, [{at}, #-14 + 2 * \\pair]",
            "vabd.u16 q2, q2, q6",
            "vmax.u16 q1, q1, q2",
            "add_pair q5, q6, q1",
            ".endif",
            ".endr",
            ".endif",
            "vmul.i16 q1, q4, q0",
            "vsub.i16 q3, q3, q1",
            "vldrh.u16 q1, [{halves}, q4]",
            "vrmulh.s16 q3, q3, q1",
            "vadd.i16 q0, q0, q3",
            "4:",
            "vstrh.16 q0, [{answers}], #16",
            "letp lr, 2b",
            ".purgem add_pair",
            count = in(reg) count, step = in(reg) u32::from(step.raw()), any = in(reg) radius,
            two = in(reg) 2, radius = const RADIUS, pair = out(reg) _, near = out(reg) _, far = out(reg) _,
            at = inout(reg) room.add(REACH) => _,
            answers = inout(reg) answers.as_mut_ptr() => _, halves = in(reg) HALVES.as_ptr(),
            inout("r0") room => _, out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _,
            out("q4") _,
            out("q5") _, out("q6") _, out("q7") _, options(nostack),
        );
    }
}

/// Bytes from which a vector is read again, its lanes moved up or down, and zeros moved in.
type Shift = [[u8; LANES]; 3];

/// The numbers of the lanes from 1 on.
static LANE: [u8; LANES] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];
/// Lane numbers backwards.
static BACK: [u8; LANES] = [16, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1];

/// For every answer how many its surface has, from the bytes that say where one begins.
///
/// How far the beginning is from each lane is a maximum over the lanes up to it, made in four steps; from one
/// vector to the next a number is carried. Then the same backwards with the end. 20 and 27 instructions for
/// 16 answers.
#[inline(never)]
fn count(begins: &mut [u16], lengths: &mut [u8], width: usize) {
    let groups = width.div_ceil(LANES);
    let mut shift = MaybeUninit::<Shift>::uninit();
    if groups == 0 || 2 * begins.len() < groups * LANES + 1 || lengths.len() < width {
        return;
    }
    let begins = view_mut::<u16, u8>(begins);
    // What lies outside is no surface, on both sides.
    fill(part_mut(begins, width..groups * LANES), u8::MAX);
    let [first, .., last] = part_mut(begins, ..=groups * LANES) else { return };
    (*first, *last) = (u8::MAX, 0);
    let (begins, shift) = (begins.as_mut_ptr(), shift.as_mut_ptr().cast::<u8>());
    // SAFETY: `begins` has a byte for each lane of the groups and one more, as asked for above, and `lengths`
    // one for each of `width`: the last stores are of the lanes up to there. `shift` is read up to eight
    // bytes before and after its middle, and written before that: zeros, and the middle in each round.
    unsafe {
        asm!(
            "vmov.i8 q1, #0",
            "vstrb.8 q1, [{shift}, #-16]",
            "vstrb.8 q1, [{shift}, #16]",
            "vldrb.u8 q3, [{lane}]",
            "dls lr, {groups}",
            "2:",
            "vldrb.u8 q0, [{begins}]",
            "vand q0, q0, q3",
            ".irp by, 1, 2, 4, 8",
            "vstrb.8 q0, [{shift}]",
            "vldrb.u8 q1, [{shift}, #-\\by]",
            "vmax.u8 q0, q0, q1",
            ".endr",
            "vsub.i8 q1, q3, q0",
            "vpt.i8 eq, q0, zr",
            "vqaddt.u8 q1, q1, {carry}",
            "vmov.u8 {carry}, q1[15]",
            "vstrb.8 q1, [{begins}], #16",
            "le lr, 2b",
            groups = in(reg) groups, lane = in(reg) LANE.as_ptr(), begins = inout(reg) begins => _,
            shift = in(reg) shift.add(LANES), carry = inout(reg) 0 => _,
            out("lr") _, out("q0") _, out("q1") _, out("q3") _, options(nostack),
        );
        let last = (groups - 1) * LANES;
        asm!(
            "vldrb.u8 q3, [{back}]",
            "vmov.i32 q4, #0",
            "dls lr, {groups}",
            "2:",
            "vldrb.u8 q0, [{begins}, #1]",
            "vcmp.i8 eq, q0, zr",
            "vpsel q0, q3, q4",
            ".irp by, 1, 2, 4, 8",
            "vstrb.8 q0, [{shift}]",
            "vldrb.u8 q1, [{shift}, #\\by]",
            "vmax.u8 q0, q0, q1",
            ".endr",
            "vsub.i8 q1, q3, q0",
            "vpt.i8 eq, q0, zr",
            "vqaddt.u8 q1, q1, {carry}",
            "vmov.u8 {carry}, q1[0]",
            "vldrb.u8 q0, [{begins}], #-16",
            "vqadd.u8 q1, q1, q0",
            "vqadd.u8 q1, q1, {one}",
            "vctp.8 {lanes}",
            "vpst",
            "vstrbt.8 q1, [{lengths}], #-16",
            "add {lanes}, {lanes}, #16",
            "le lr, 2b",
            groups = in(reg) groups, back = in(reg) BACK.as_ptr(), begins = inout(reg) begins.add(last) => _,
            lengths = inout(reg) lengths.as_mut_ptr().add(last) => _, lanes = inout(reg) width - last => _,
            shift = in(reg) shift.add(LANES), carry = inout(reg) 0 => _, one = in(reg) 1,
            out("lr") _, out("q0") _, out("q1") _, out("q3") _, out("q4") _, options(nostack),
        );
    }
}
