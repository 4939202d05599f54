//! The path from the right, added to the others, and the winner of each pixel.

use super::columns::Columns;
use super::rows::fill;
use super::step::far;
use crate::matching::backend::work::PathWork;
use crate::matching::memory::winners::Winner;
use core::arch::asm;

/// Moves the path through the row, and selects the winners of all columns that have a candidate.
///
/// `changes` are what the path pays, of each column in the place of the next one. If `wants_second`, the
/// least cost farther than two px beside the winner is left there, in the lower byte. `room` has a byte more
/// than a column at both ends.
pub(super) fn left(
    work: &mut PathWork<'_>,
    changes: &mut [u16],
    room: &mut [u8],
    winners: &mut [Winner],
    wants_second: bool,
    columns: Columns,
) {
    let Columns { stride, vtype } = columns;
    let (width, begin, disparities) = (work.width, work.min_disparity, work.disparities);
    let is_whole = work.costs.len() >= width * stride && work.sums.len() >= width * stride;
    let is_searched = begin < width && (1..=stride).contains(&disparities);
    if !is_whole || !is_searched || changes.len() <= width || winners.len() < width || room.len() < stride + 2
    {
        return;
    }
    close(work, begin, columns);
    let (count, x) = (width - begin, width - 1);
    // SAFETY: the lengths asked for above are what is read and written, of `count` columns, one at least. A
    // winner stands in one of the lanes, and beside each lane is a byte of the room.
    unsafe {
        asm!(
            "vsetvl zero, {stride}, {vtype}",
            "sub {back}, zero, {stride}",
            "li {least}, -1",
            "vmv.s.x v1, {least}",
            // A path that comes from nowhere costs nothing.
            "vmv.v.i v8, 0",
            "vmv.s.x v4, zero",
            "li {least}, 0",
            winner_at_ends!(),
            change!("below", "above", "second"),
            step!("below", "above"),
            "add {costs}, {costs}, {back}",
            least!("v8", "least"),
            "vle8.v v16, ({sums})",
            "add {sums}, {sums}, {back}",
            "vsaddu.vv v16, v16, v8",
            winner!(),
            "addi {second}, {second}, -2",
            "addi {winners}, {winners}, -4",
            "addi {count}, {count}, -1",
            // The first columns have fewer candidates.
            "sltu {lane}, {count}, {disparities}",
            "add {first}, {first}, {lane}",
            "bnez {count}, 2b",
            count = inout(reg) count => _, stride = in(reg) stride, vtype = inout(reg) vtype => _,
            costs = inout(reg) work.costs.as_ptr().add(x * stride) => _,
            sums = inout(reg) work.sums.as_ptr().add(x * stride) => _,
            second = inout(reg) changes.as_mut_ptr().add(x + 1) => _,
            winners = inout(reg) winners.as_mut_ptr().add(x) => _,
            room = in(reg) room.as_mut_ptr().add(1), far = in(reg) far(work.penalties),
            asked = in(reg) u32::from(wants_second), disparities = in(reg) disparities,
            first = inout(reg) stride - disparities.min(count) => _, last = in(reg) stride - 1,
            back = out(reg) _, least = out(reg) _, below = out(reg) _, above = out(reg) _, best = out(reg) _,
            lane = out(reg) _, out("v0") _, out("v1") _, out("v2") _, out("v4") _, out("v5") _, out("v6") _,
            out("v7") _, out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _,
            out("v14") _, out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _,
            out("v21") _, out("v22") _, out("v23") _, out("v24") _, out("v25") _, out("v26") _, out("v27") _,
            out("v28") _, out("v29") _, out("v30") _, out("v31") _, options(nostack),
        );
    }
}

/// Makes the sums of lanes that are not searched the most that there is, which they stay: the first columns
/// have fewer candidates than lanes.
fn close(work: &mut PathWork<'_>, begin: usize, columns: Columns) {
    let stride = columns.stride;
    let columns = work.sums.get_mut(begin * stride..work.width * stride).unwrap_or_default();
    for (before, column) in columns.chunks_exact_mut(stride.max(1)).enumerate() {
        let searched = work.disparities.min(before + 1);
        if searched == stride {
            break;
        }
        fill(column.get_mut(..stride - searched).unwrap_or_default(), u8::MAX);
    }
}
