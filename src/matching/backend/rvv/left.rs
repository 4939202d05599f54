//! The path from the right, added to the others, and the winner of each pixel.

use super::columns::Columns;
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
            "j 2f",
            // The smallest disparity has the other side for what is below it, an only one itself.
            "3:",
            "mv {below}, {above}",
            "bne {lane}, {first}, 5f",
            "mv {below}, {best}",
            "mv {above}, {best}",
            "j 5f",
            // The largest one has none above.
            "4:",
            "mv {above}, {below}",
            "j 5f",
            "2:",
            change!("below", "above"),
            step!("below", "above"),
            "add {costs}, {costs}, {back}",
            least!("v8", "least"),
            "vle8.v v16, ({sums})",
            "add {sums}, {sums}, {back}",
            "vsaddu.vv v16, v16, v8",
            "vse8.v v16, ({room})",
            least!("v16", "best"),
            // Of those with the least cost the last one, which has the smallest disparity.
            "vmseq.vx v0, v16, {best}",
            "vid.v v24",
            "vredmaxu.vs v2, v24, v4, v0.t",
            "vmv.x.s {lane}, v2",
            "beqz {asked}, 6f",
            "addi {below}, {lane}, -2",
            "vsub.vx v24, v24, {below}",
            "vmsgtu.vi v0, v24, 4",
            "vredminu.vs v2, v16, v1, v0.t",
            "vmv.x.s {below}, v2",
            "sb {below}, 0({changes})",
            "6:",
            "addi {changes}, {changes}, -2",
            "add {above}, {room}, {lane}",
            "lbu {below}, 1({above})",
            "lbu {above}, -1({above})",
            "beq {lane}, {last}, 3b",
            "beq {lane}, {first}, 4b",
            "5:",
            "sb {below}, 0({winners})",
            "sb {best}, 1({winners})",
            "sb {above}, 2({winners})",
            "sub {lane}, {last}, {lane}",
            "sb {lane}, 3({winners})",
            "addi {winners}, {winners}, -4",
            "addi {count}, {count}, -1",
            // The first columns have fewer candidates.
            "sltu {lane}, {count}, {disparities}",
            "add {first}, {first}, {lane}",
            "bnez {count}, 2b",
            count = inout(reg) count => _, stride = in(reg) stride, vtype = inout(reg) vtype => _,
            costs = inout(reg) work.costs.as_ptr().add(x * stride) => _,
            sums = inout(reg) work.sums.as_ptr().add(x * stride) => _,
            changes = inout(reg) changes.as_mut_ptr().add(x + 1) => _,
            winners = inout(reg) winners.as_mut_ptr().add(x) => _,
            room = in(reg) room.as_mut_ptr().add(1), far = in(reg) super::far(work.penalties),
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
        fill(column.get_mut(..stride - searched).unwrap_or_default());
    }
}

/// Makes some bytes, as many as a group of eight registers holds at most, the most that there is.
fn fill(lanes: &mut [u8]) {
    // SAFETY: it writes so many bytes.
    unsafe {
        asm!(
            "vsetvli zero, {count}, e8, m8, ta, ma",
            "vmv.v.i v8, -1",
            "vse8.v v8, ({lanes})",
            count = in(reg) lanes.len(), lanes = in(reg) lanes.as_mut_ptr(),
            out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
            out("v15") _, options(nostack),
        );
    }
}
