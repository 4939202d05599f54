//! The windows of a row, and their winners.

use super::columns::Columns;
use super::rows::with_more_before;
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::work::WindowWork;
use crate::matching::memory::layout::OUTSIDE;
use crate::matching::memory::slices::{part, part_mut, split_mut};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::Select;
use core::arch::asm;

/// [`Isa::window`](crate::matching::backend::Isa::window) in vectors.
#[inline(never)]
pub(super) fn window<P: WindowParameters>(
    work: WindowWork<'_>,
    select: Option<Select<'_>>,
    columns: Columns,
) {
    const { assert!(P::RADIUS_X < OUTSIDE) };
    let WindowWork { width, stride, min_disparity, enter, leave, columns: sums, workspace } = work;
    let room = view_mut::<u32, u8>(workspace);
    let inside = part_mut(sums, OUTSIDE * stride..);
    for (row, sign) in [(enter, 1), (leave, -1)] {
        if let Some((left, right)) = row.and_then(|row| row.split_at_checked(width)) {
            let right = with_more_before(right, min_disparity, stride, room);
            move_columns([left, right], sign, inside, columns);
        }
    }
    if let Some(select) = select {
        winners::<P>(sums, min_disparity, room, select, columns);
    }
}

/// Adds to each column how many bits of its code and of those that it is compared with differ, or takes
/// that off: 23 instructions.
fn move_columns([left, right]: [&[u8]; 2], sign: i32, sums: &mut [u8], columns: Columns) {
    let Columns { stride, vtype } = columns;
    let width = left.len();
    if width == 0 || right.len() < width + stride - 1 || sums.len() < width * stride {
        return;
    }
    // SAFETY: the lengths asked for above are what is read and written: of column `x` `left[x]`, `stride`
    // codes of `right` from `x` on, and as many sums. `width` is not 0.
    unsafe {
        asm!(
            "vsetvl zero, {stride}, {vtype}",
            "2:",
            "lbu {code}, 0({left})",
            "addi {left}, {left}, 1",
            "vle8.v v16, ({right})",
            "addi {right}, {right}, 1",
            bits_apart!("code"),
            "vle8.v v8, ({sums})",
            // What is multiplied is added.
            "vmacc.vx v8, {sign}, v16",
            "vse8.v v8, ({sums})",
            "add {sums}, {sums}, {stride}",
            "addi {width}, {width}, -1",
            "bnez {width}, 2b",
            width = inout(reg) width => _, stride = in(reg) stride, vtype = in(reg) vtype, code = out(reg) _,
            left = inout(reg) left.as_ptr() => _, right = inout(reg) right.as_ptr() => _,
            sums = inout(reg) sums.as_mut_ptr() => _, sign = in(reg) sign, odd = in(reg) 0x55,
            pairs = in(reg) 0x33,
            out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
            out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _, out("v21") _,
            out("v22") _, out("v23") _, out("v24") _, out("v25") _, out("v26") _, out("v27") _, out("v28") _,
            out("v29") _, out("v30") _, out("v31") _, options(nostack),
        );
    }
}

/// Selects the winners of all columns that have a candidate, of windows that move from the first of these on.
fn winners<P: WindowParameters>(
    sums: &[u8],
    begin: usize,
    room: &mut [u8],
    select: Select<'_>,
    columns: Columns,
) {
    let Columns { stride, vtype } = columns;
    let Select { disparities, winners, unique } = select;
    let winners = winners.words();
    let width = winners.len();
    let (costs, seconds) = split_mut(room, stride + 2);
    let is_whole = sums.len() >= (width + 2 * OUTSIDE) * stride && seconds.len() >= width;
    if begin >= width || !is_whole || costs.len() < stride + 2 || !(1..=stride).contains(&disparities) {
        return;
    }
    let column = |x: usize| sums.as_ptr().wrapping_add((OUTSIDE + x) * stride);
    // SAFETY: the lengths asked for above are what is read and written, of the columns from `begin` on,
    // one at least, and of up to `OUTSIDE` to both sides. A winner stands in one of the lanes, and beside
    // each lane is a byte of the room.
    unsafe {
        asm!(
            "vsetvl zero, {stride}, {vtype}",
            "li {best}, -1",
            "vmv.s.x v1, {best}",
            "vmv.s.x v4, zero",
            // The first window, but for its last column, and with the one before it.
            "vmv.v.i v8, 0",
            "mv {enters}, {leaves}",
            "li {best}, 2 * {radius} + 1",
            "7:",
            "vle8.v v16, ({enters})",
            ".if {shift}",
            "vsrl.vi v16, v16, {shift}",
            ".endif",
            "vadd.vv v8, v8, v16",
            "add {enters}, {enters}, {stride}",
            "addi {best}, {best}, -1",
            "bnez {best}, 7b",
            winner_at_ends!(),
            "vle8.v v16, ({enters})",
            "add {enters}, {enters}, {stride}",
            "vle8.v v24, ({leaves})",
            "add {leaves}, {leaves}, {stride}",
            ".if {shift}",
            "vsrl.vi v16, v16, {shift}",
            "vsrl.vi v24, v24, {shift}",
            ".endif",
            "vadd.vv v8, v8, v16",
            "vsub.vv v8, v8, v24",
            // Those that are not searched are the most that there is.
            "vid.v v24",
            "vmsltu.vx v0, v24, {first}",
            "vmerge.vim v16, v8, -1, v0",
            winner!(),
            "addi {second}, {second}, 1",
            "addi {winners}, {winners}, 4",
            // The first columns have fewer candidates.
            "sltu {lane}, {least_first}, {first}",
            "sub {first}, {first}, {lane}",
            "addi {count}, {count}, -1",
            "bnez {count}, 2b",
            count = inout(reg) width - begin => _, stride = in(reg) stride, vtype = in(reg) vtype,
            leaves = inout(reg) column(begin).wrapping_sub((P::RADIUS_X + 1) * stride) => _,
            enters = out(reg) _, room = in(reg) costs.as_mut_ptr().add(1),
            second = inout(reg) seconds.as_mut_ptr().add(begin) => _,
            winners = inout(reg) winners.as_mut_ptr().add(begin) => _,
            asked = in(reg) u32::from(unique.is_asked()), first = inout(reg) stride - 1 => _,
            least_first = in(reg) stride - disparities, last = in(reg) stride - 1,
            below = out(reg) _, above = out(reg) _, best = out(reg) _, lane = out(reg) _,
            radius = const P::RADIUS_X, shift = const P::COLUMN_SHIFT,
            out("v0") _, out("v1") _, out("v2") _, out("v4") _,
            out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
            out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _, out("v21") _,
            out("v22") _, out("v23") _, out("v24") _, out("v25") _, out("v26") _, out("v27") _, out("v28") _,
            out("v29") _, out("v30") _, out("v31") _, options(nostack),
        );
    }
    if unique.is_asked() {
        let mut check = unique.checks_from(begin);
        for (winner, &second) in part(winners, begin..).iter().zip(part(seconds, begin..)) {
            check(winner.cost(), &mut || second);
        }
    }
}
