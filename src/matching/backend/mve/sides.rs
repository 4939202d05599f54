//! The costs beside winners at the ends of their candidates, and winners' records put into rows.
#![allow(unsafe_code)]

use super::LANES;
use crate::matching::memory::winners::WinnerRows;
use core::arch::asm;
use core::ops::Range;

/// Bytes of a winner's record: the cost above it, its own, the one below, the complement of its disparity.
pub(super) const RECORD: usize = 4;

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

/// Puts the first records of the `room` into these places of the rows, with the other side for the side that
/// a winner lacks which is the smallest or the last of the pixel's candidates: of these a row's first pixel
/// has one, the next one two, and so on up to `disparities`. Nineteen instructions for 16 pixels.
#[inline(never)]
pub(super) fn spread(room: &[u8], rows: &mut WinnerRows<'_>, places: Range<usize>, disparities: usize) {
    let WinnerRows { below, costs, above, disparities: winners } = rows;
    let (first, count) = (places.start, places.len());
    let groups = count.div_ceil(LANES);
    let lengths = [below.len(), costs.len(), above.len(), winners.len()];
    let is_there = lengths.iter().all(|&length| length >= places.end);
    if count == 0 || !is_there || room.len() < groups * LANES * RECORD {
        return;
    }
    // SAFETY: whole vectors are read of the `room`, which are there, and `count` bytes written of each row.
    unsafe {
        asm!(
            "vidup.u8 q4, r4, #1",
            "vqadd.u8 q4, q4, {first}",
            "vdup.8 q5, {last}",
            "dls lr, {groups}",
            "2:",
            "vld40.8 {{q0, q1, q2, q3}}, [{room}]",
            "vld41.8 {{q0, q1, q2, q3}}, [{room}]",
            "vld42.8 {{q0, q1, q2, q3}}, [{room}]",
            "vld43.8 {{q0, q1, q2, q3}}, [{room}]!",
            "vmvn q3, q3",
            "vmin.u8 q6, q4, q5",
            "vqadd.u8 q4, q4, {lanes}",
            "vpt.i8 eq, q3, zr",
            "vmovt q2, q0",
            "vpt.i8 eq, q3, q6",
            "vmovt q0, q2",
            "vctp.8 {count}",
            "vpstttt",
            "vstrbt.8 q2, [{below}], #16",
            "vstrbt.8 q1, [{costs}], #16",
            "vstrbt.8 q0, [{above}], #16",
            "vstrbt.8 q3, [{winners}], #16",
            "sub {count}, {count}, #16",
            "le lr, 2b",
            groups = in(reg) groups, count = inout(reg) count => _, first = in(reg) first.min(255),
            last = in(reg) disparities - 1, lanes = in(reg) LANES, room = inout(reg) room.as_ptr() => _,
            winners = inout(reg) winners.as_mut_ptr().add(first) => _,
            below = inout(reg) below.as_mut_ptr().add(first) => _,
            above = inout(reg) above.as_mut_ptr().add(first) => _,
            costs = inout(reg) costs.as_mut_ptr().add(first) => _,
            inout("r4") 0 => _, out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _,
            out("q5") _, out("q6") _, options(nostack),
        );
    }
    // The only candidate has none beside it.
    if let (0, Some(below), Some(above), Some(&mut cost)) =
        (first, below.first_mut(), above.first_mut(), costs.first_mut())
    {
        (*below, *above) = (cost, cost);
    }
}
