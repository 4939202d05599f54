//! The passes for columns of any number of vectors, a pixel at a time: what the others have in registers is
//! in memory here. Three to seven instructions more for 16 candidates, and some dozens for a pixel.
#![allow(unsafe_code)]

use super::LANES;
use super::changes::changes;
use super::down::{Ring, sources};
use crate::matching::backend::mve::columns::BITS;
use crate::matching::backend::mve::sides::complete;
use crate::matching::backend::mve::windows::best_of_the_rest;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features::Features;
use crate::matching::backend::work::{Guide, MASKS, PathWork};
use crate::matching::memory::slices::{chunks_mut, part, part_mut, split_mut};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::Select;
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

/// A path at a pixel: a column of costs, with a vector before and after that no path comes from.
struct Path<'a> {
    room: &'a mut [u8],
    least: u8,
}

impl<'a> Path<'a> {
    /// A path at its start, of no cost; `None` where there is too little room.
    fn new(room: &'a mut [u8], stride: usize) -> Option<Self> {
        let room = room.get_mut(..stride + 2 * LANES)?;
        room.fill(u8::MAX);
        part_mut(room, LANES..LANES + stride).fill(0);
        Some(Self { room, least: 0 })
    }

    /// Makes it the average of two columns, rounded down.
    #[inline(always)]
    fn average(&mut self, before: &[u8], after: &[u8]) {
        let groups = (self.room.len() / LANES).saturating_sub(2);
        if groups == 0 || before.len() < groups * LANES || after.len() < groups * LANES {
            return;
        }
        let mut least = u32::from(u8::MAX);
        // SAFETY: as many vectors of both columns are read, and written inside of the room.
        unsafe {
            asm!(
                "dls lr, {groups}",
                "2:",
                "vldrb.u8 q0, [{before}], #16",
                "vldrb.u8 q1, [{after}], #16",
                "vhadd.u8 q0, q0, q1",
                "vstrb.8 q0, [{path}], #16",
                "vminv.u8 {least}, q0",
                "le lr, 2b",
                groups = in(reg) groups, before = inout(reg) before.as_ptr() => _,
                after = inout(reg) after.as_ptr() => _,
                path = inout(reg) self.room.as_mut_ptr().add(LANES) => _, least = inout(reg) least,
                out("lr") _, out("q0") _, out("q1") _, options(nostack),
            );
        }
        self.least = least as u8;
    }

    /// Goes on to a pixel of these costs. Its own there, and if `ADDS` those that are in `from` already, or
    /// in `to` where there is none, go to `to`, 255 at the most.
    #[inline(always)]
    fn advance<const ADDS: bool>(&mut self, change: u16, costs: &[u8], from: Option<&[u8]>, to: &mut [u8]) {
        let groups = (self.room.len() / LANES).saturating_sub(2);
        let is_whole = |column: &[u8]| column.len() >= groups * LANES;
        if groups == 0 || !is_whole(costs) || !from.is_none_or(is_whole) || !is_whole(to) {
            return;
        }
        let to = to.as_mut_ptr();
        let from = from.map_or(to.cast_const(), <[u8]>::as_ptr);
        let jump = u32::from(change >> 8);
        let mut least = u32::from(u8::MAX);
        // The path is written 16 bytes at a time: what is read one byte before is read first.
        // SAFETY: as many vectors of the columns are read and written as the path has between the two of the
        // room, of which is read from one byte before it to 15 after.
        unsafe {
            asm!(
                "vldrb.u8 q4, [{path}, #-1]",
                "dls lr, {groups}",
                "2:",
                "vldrb.u8 q5, [{path}, #1]",
                "vmin.u8 q4, q4, q5",
                "vldrb.u8 q5, [{path}, #15]",
                "vqadd.u8 q4, q4, {step}",
                "vldrb.u8 q0, [{path}]",
                "vmin.u8 q0, q0, q4",
                "vqadd.u8 q0, q0, {off}",
                "vldrb.u8 q1, [{costs}], #16",
                "vsub.i8 q0, q0, {jump}",
                "vadd.i8 q0, q0, q1",
                "vstrb.8 q0, [{path}], #16",
                "vminv.u8 {least}, q0",
                ".if {adds}",
                "vldrb.u8 q1, [{from}], #16",
                "vqadd.u8 q0, q1, q0",
                ".endif",
                "vstrb.8 q0, [{to}], #16",
                "vmov q4, q5",
                "le lr, 2b",
                groups = in(reg) groups, path = inout(reg) self.room.as_mut_ptr().add(LANES) => _,
                costs = inout(reg) costs.as_ptr() => _, from = inout(reg) from => _, to = inout(reg) to => _,
                adds = const ADDS as u32,
                step = in(reg) u32::from(change), jump = in(reg) jump,
                off = in(reg) jump.wrapping_sub(self.least.into()), least = inout(reg) least,
                out("lr") _, out("q0") _, out("q1") _, out("q4") _, out("q5") _, options(nostack),
            );
        }
        self.least = least as u8;
    }
}

/// The least of a column's sums and the smallest disparity that has it.
#[inline(never)]
fn least(sums: &[u8]) -> (u8, u8) {
    let groups = sums.len() / LANES;
    if groups == 0 {
        return (u8::MAX, 0);
    }
    let (mut best, mut nearest) = (u32::from(u8::MAX), u32::from(u8::MAX));
    // SAFETY: whole vectors of the sums are read.
    unsafe {
        asm!(
            "dls lr, {groups}",
            "mov {at}, {sums}",
            "2:",
            "vldrb.u8 q0, [{at}], #16",
            "vminv.u8 {best}, q0",
            "le lr, 2b",
            "dls lr, {groups}",
            "2:",
            "vldrb.u8 q0, [{sums}], #16",
            "vddup.u8 q1, r4, #1",
            "vpt.i8 eq, q0, {best}",
            "vminvt.u8 {nearest}, q1",
            "le lr, 2b",
            groups = in(reg) groups, sums = inout(reg) sums.as_ptr() => _, at = out(reg) _,
            best = inout(reg) best, nearest = inout(reg) nearest,
            inout("r4") groups * LANES - 1 => _, out("lr") _, out("q0") _, out("q1") _, options(nostack),
        );
    }
    (best as u8, nearest as u8)
}

/// Selects the winners of a row.
#[inline(never)]
pub(super) fn select(work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
    let Select { mut winners, mut unique, .. } = select;
    let (width, stride) = (work.width, work.stride.max(LANES));
    let begin = work.min_disparity.min(width);
    let ring = Ring::new(width, guide.row);
    let workspace = core::mem::take(&mut work.workspace);
    let (along, rest) = split_mut(view_mut::<u32, u16>(workspace), width + 1);
    let room = view_mut::<u16, u8>(rest);
    let down = part_mut(view_mut::<u8, u16>(winners.bytes()), ..width);
    changes(guide.here, guide.above.unwrap_or(guide.here), work.penalties, down);
    let (costs, tops) = (&*work.costs, &mut *work.top);
    if guide.above.is_none() {
        tops.fill(0);
    }
    let (sums, at) = (&mut *work.sums, |x: usize| x * stride..(x + 1) * stride);
    let Some(mut path) = Path::new(room, stride) else { return };
    for (x, &change) in down.iter().enumerate() {
        let [before, after] = sources(ring, width, x).map(|(place, _)| part(tops, at(place)));
        path.average(before, after);
        path.advance::<false>(change, part(costs, at(x)), None, part_mut(tops, at(ring.place(x).0)));
    }

    changes(guide.here.get(1..).unwrap_or_default(), guide.here, work.penalties, part_mut(along, 1..width));
    let Some(mut path) = Path::new(room, stride) else { return };
    for (x, &change) in along.iter().enumerate().take(width) {
        let top = part(tops, at(ring.place(x).0));
        path.advance::<true>(change, part(costs, at(x)), Some(top), part_mut(sums, at(x)));
    }

    let Some(mut path) = Path::new(room, stride) else { return };
    let mut rows = winners.rows(begin);
    for x in (begin..width).rev() {
        let sums = part_mut(sums, at(x));
        // The first pixels have fewer candidates than there are lanes.
        let candidates = work.disparities.min(x + 1 - begin);
        if candidates < stride {
            part_mut(sums, ..stride - candidates).fill(u8::MAX);
        }
        let change = along.get(x + 1).copied().unwrap_or(0);
        path.advance::<true>(change, part(costs, at(x)), None, sums);
        let (cost, disparity) = least(sums);
        let lane = (stride - 1).wrapping_sub(disparity.into());
        let beside = [lane + 1, lane.wrapping_sub(1)].map(|lane| sums.get(lane).copied().unwrap_or(0));
        let found = [beside[0], cost, beside[1], disparity];
        let places = [&mut rows.below, &mut rows.costs, &mut rows.above, &mut rows.disparities];
        for (row, found) in places.into_iter().zip(found) {
            if let Some(place) = row.get_mut(x - begin) {
                *place = found;
            }
        }
        unique.check(x, cost, || {
            let zeros = part(MASKS, MASKS.len() - stride..);
            best_of_the_rest(disparity.into(), zeros, sums)
        });
    }
    let rows = [rows.below, rows.costs, rows.above, rows.disparities];
    complete(rows, work.disparities);
}
