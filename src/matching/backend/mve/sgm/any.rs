//! The passes for columns of any number of vectors: costs a pixel at a time, paths for runs of pixels
//! (`any_paths`). What the others have in registers is in memory here: two to four instructions more for 16
//! candidates and path, and some 40 for a pixel.
#![allow(unsafe_code)]

use super::LANES;
use super::any_paths::{Leftward, walk_down, walk_left, walk_right};
use super::changes::changes;
use super::{down, leftward, rightward};
use crate::matching::backend::mve::columns::BITS;
use crate::matching::backend::mve::rows::fill;
use crate::matching::backend::mve::sides::complete;
use crate::matching::backend::mve::windows::best_of_the_rest;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features::Features;
use crate::matching::backend::work::{Guide, MASKS, PathWork};
use crate::matching::memory::slices::{chunks_mut, part, part_mut, split_mut};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::{Select, Unique};
use core::arch::asm;

/// What `cost::enter` does.
#[inline(never)]
pub(super) fn enter<S: SgmParameters>(work: &mut PathWork<'_>, features: &Features<'_>) {
    let Features { left, right, count } = *features;
    let most = work.penalties.cost;
    let pixels = left.along.iter().zip(left.across).zip(left.census.iter().zip(left.brightness));
    for (column, (x, ((&along, &across), (&census, &brightness)))) in
        chunks_mut(work.costs, work.stride.max(LANES)).zip(pixels.enumerate())
    {
        let along = if S::BETWEEN_PIXELS { along.wrapping_mul(2) } else { along };
        compare::<S>([along, across, census, brightness >> 1, most], part(right, x..), count, column);
    }
}

/// A pixel's costs. Of each row of the `right` image, `count` numbers further on each, the first is that of
/// the column's first candidate.
#[inline(always)]
fn compare<S: SgmParameters>(pixel: [u8; 5], right: &[u8], count: usize, costs: &mut [u8]) {
    let [low, high] = if S::BETWEEN_PIXELS { [4, 5] } else { [0, 0] };
    if costs.len() < LANES || right.len() < high.max(3) * count + costs.len() {
        return;
    }
    // SAFETY: whole vectors of the costs are read and written, and as many numbers read of each row: the last
    // one has them. A byte's entry of the table is in it.
    unsafe {
        let row = |row: usize| right.as_ptr().add(row * count);
        asm!(
            ".irp v, 0, 1, 2, 3, 4",
            "ldrb lr, [{pixel}, #\\v]",
            "vdup.8 q\\v, lr",
            ".endr",
            "dls lr, {groups}",
            "2:",
            "vldrb.u8 q6, [{low}], #16",
            ".if {between}",
            "vldrb.u8 q5, [{high}], #16",
            "vqsub.u8 q5, q0, q5",
            "vqsub.u8 q6, q6, q0",
            ".else",
            "vabd.u8 q5, q6, q0",
            "vabd.u8 q6, q6, q0",
            ".endif",
            "vadd.i8 q5, q5, q6",
            "vldrb.u8 q7, [{dark}], #16",
            "vabd.u8 q7, q7, q3",
            "vshr.u8 q7, q7, #2",
            "vadd.i8 q5, q5, q7",
            "vldrb.u8 q7, [{across}], #16",
            "vabd.u8 q7, q7, q1",
            "vadd.i8 q5, q5, q7",
            "vldrb.u8 q6, [{codes}], #16",
            "veor q6, q6, q2",
            "vldrb.u8 q7, [{bits}, q6]",
            "vadd.i8 q5, q5, q7",
            "vmin.u8 q5, q5, q4",
            ".if {averages}",
            "vldrb.u8 q6, [{costs}]",
            "vrhadd.u8 q5, q5, q6",
            ".endif",
            "vstrb.8 q5, [{costs}], #16",
            "le lr, 2b",
            pixel = in(reg) pixel.as_ptr(), groups = in(reg) costs.len() / LANES,
            low = inout(reg) row(low) => _, high = inout(reg) row(high) => _, across = inout(reg) row(1) => _,
            codes = inout(reg) row(2) => _, dark = inout(reg) row(3) => _,
            costs = inout(reg) costs.as_mut_ptr() => _, bits = in(reg) BITS.as_ptr(),
            between = const S::BETWEEN_PIXELS as u32, averages = const !S::WITHIN_EDGES as u32,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
            out("q6") _, out("q7") _, options(nostack),
        );
    }
}

/// Selects the winners of a row.
#[inline(never)]
pub(super) fn select(work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
    let Select { mut winners, unique, .. } = select;
    let (width, stride) = (work.width, work.stride.max(LANES));
    let (begin, groups) = (work.min_disparity.min(width), stride / LANES);
    let workspace = core::mem::take(&mut work.workspace);
    let (along, rest) = split_mut(view_mut::<u32, u16>(workspace), width + 1);
    // A path, with a vector before and after that no path comes from.
    let Some(room) = view_mut::<u16, u8>(rest).get_mut(..stride + 2 * LANES) else { return };
    fill(room, u8::MAX);
    let down = part_mut(view_mut::<u8, u16>(winners.bytes()), ..width);
    changes(guide.here, guide.above.unwrap_or(guide.here), work.penalties, down);
    down::go(work, guide, down, stride, |run| {
        // SAFETY: the columns are those of `go`; the path is in the room.
        unsafe { walk_down(run, groups, room.as_mut_ptr().add(LANES)) }
    });

    changes(guide.here.get(1..).unwrap_or_default(), guide.here, work.penalties, part_mut(along, 1..width));
    fill(part_mut(room, LANES..LANES + stride), 0);
    let mut least = 0;
    rightward::go(work, guide.row, along, stride, |run| {
        // SAFETY: as above.
        unsafe { walk_right(run, groups, &mut least, room.as_mut_ptr().add(LANES)) }
    });

    fill(part_mut(room, LANES..LANES + stride), 0);
    select_leftward(work, begin, along, room, winners.bytes(), unique);
    let rows = winners.rows(begin);
    let rows = [rows.below, rows.costs, rows.above, rows.disparities];
    complete(rows, work.disparities);
}

/// Takes the path from the right through the row, up to the column `begin`, and selects the winners.
fn select_leftward(
    work: &mut PathWork<'_>,
    begin: usize,
    along: &[u16],
    room: &mut [u8],
    rows: &mut [u8],
    mut unique: Unique<'_>,
) {
    let (width, stride) = (work.width, work.stride.max(LANES));
    let is_whole = work.costs.len() >= width * stride && work.sums.len() >= width * stride;
    if !is_whole || along.len() <= width || rows.len() < 4 * width || room.len() < stride + 2 * LANES {
        return;
    }
    leftward::close(work, begin, stride);
    let (mut end, mut least) = (width, 0);
    while end > begin {
        let count = if unique.is_asked() { 1 } else { end - begin };
        let last = end - 1;
        // SAFETY: `count` columns before `end` are in the row, of which all memory has been made sure to have
        // them; the sums are closed, and the path is in the room.
        unsafe {
            let row = rows.as_mut_ptr().add(width + last);
            let at = Leftward { change: along.as_ptr().add(end), row, width, count };
            let costs = work.costs.as_ptr().add(last * stride);
            let sums = work.sums.as_mut_ptr().add(last * stride);
            walk_left(at, stride / LANES, &mut least, room.as_mut_ptr().add(LANES), costs, sums);
        }
        end -= count;
        if unique.is_asked() {
            let found = |row: usize| rows.get(row * width + end).copied().unwrap_or(0);
            let (cost, disparity) = (found(1), found(3));
            let sums = part_mut(work.sums, end * stride..(end + 1) * stride);
            unique.check(end, cost, || {
                best_of_the_rest(disparity.into(), part(MASKS, MASKS.len() - stride..), sums)
            });
        }
    }
}
