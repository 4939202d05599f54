//! The paths through a row.
#![allow(unsafe_code)]

use super::changes::changes;
use super::stride;
use super::walk::{Frame, Padded, Step, go_along, go_down};
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::layout::COLUMNS_OFF;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::{view, view_mut};

/// The direction of a path along the row.
pub(super) enum Direction {
    Left,
    Right,
}

/// Whether there are all columns that the paths go through.
fn is_whole(work: &PathWork<'_>, stride: usize) -> bool {
    let bytes = work.width * stride;
    work.costs.len() >= bytes && work.sums.len() >= bytes && work.top.len() >= bytes + COLUMNS_OFF * stride
}

/// Moves the path from above down to the row.
///
/// Above the first row of a frame paths cost nothing: all is zero there. It takes no room of its own: the
/// paths of an odd row stand two columns further to the right than those of an even row. So each goes
/// where one of the two was that it comes from, if odd rows are taken from right to left.
#[inline(always)]
pub(super) fn down<const WORDS: usize, const ALL: bool>(work: &mut PathWork<'_>, guide: Guide<'_>) {
    let (width, stride) = (work.width, stride::<WORDS, ALL>(work));
    // In the first row nothing is above.
    let line = guide.above.unwrap_or(guide.here);
    if !is_whole(work, stride) || width == 0 || guide.here.len() < width || line.len() < width {
        return;
    }
    let steps = Step::kinds(work.penalties);
    let places = part_mut(view_mut::<u32, u8>(work.workspace), ..width);
    if places.len() < width {
        return;
    }
    changes(guide.here, line, work.penalties.edges, places);
    let change = places.as_ptr();
    let mut between = Padded::<WORDS>::new(stride / 4, work.penalties);
    let top = view_mut::<u8, u32>(work.top).as_mut_ptr();
    let costs = view::<u8, u32>(work.costs).as_ptr();
    let is_odd = !guide.row.is_multiple_of(2);
    let last = width - 1;
    let (from, to) = if is_odd { (0, COLUMNS_OFF) } else { (COLUMNS_OFF, 0) };
    let (on, gap) = if is_odd { (-1, -2) } else { (1, 0) };
    let mut frame = Frame {
        change: change.wrapping_add(if is_odd { last } else { 0 }),
        on,
        steps: &steps,
        path: between.place(),
        fours: stride / 16,
        gap: gap * stride as isize,
        end: core::ptr::null(),
        beside: [0; 2],
    };
    let mut done = 0;
    while done < width {
        let x = if is_odd { last - done } else { done };
        // Beyond the row's ends stands the nearest column. Between them the two are as far away for all.
        let is_inner = x >= COLUMNS_OFF && x + COLUMNS_OFF <= last;
        let count = if is_inner { width - 2 * COLUMNS_OFF } else { 1 };
        let beside = [x.saturating_sub(COLUMNS_OFF), (x + COLUMNS_OFF).min(last)];
        let place = (x + to) * stride / 4;
        frame.beside = beside.map(|x| ((x + from) * stride) as isize - 4 * place as isize);
        frame.end = top.wrapping_add(place).wrapping_offset(on * (count * stride / 4) as isize).cast_const();
        // SAFETY: `width` columns are in the volume of the costs and two more in that of the paths, of which
        // `count` from column `x` on are taken, none twice; so many places are there; and a column has
        // `4 * fours` words, `WORDS` at the most, as the average has room for.
        unsafe { go_down(&raw mut frame, costs.wrapping_add(x * stride / 4), top.wrapping_add(place)) };
        done += count;
    }
}

/// Takes a path along the row, and adds it to the path from above, or the second one to both.
#[inline(never)]
pub(super) fn along<const WORDS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    direction: Direction,
) {
    let (width, stride) = (work.width, stride::<WORDS, ALL>(work));
    if !is_whole(work, stride) || width <= work.min_disparity || guide.here.len() < width {
        return;
    }
    let steps = Step::kinds(work.penalties);
    // Either end of the row begins a path, where any step will do.
    let places = part_mut(view_mut::<u32, u8>(work.workspace), ..width + 1);
    if places.len() <= width {
        return;
    }
    // They are the same for the path back.
    if let (Direction::Right, [first, inner @ .., last]) = (&direction, &mut *places) {
        (*first, *last) = (0, 0);
        changes(part(guide.here, 1..width), guide.here, work.penalties.edges, inner);
    }
    let change = places.as_ptr();
    let mut path = Padded::<WORDS>::new(stride / 4, work.penalties);
    let shift = if !guide.row.is_multiple_of(2) { COLUMNS_OFF } else { 0 };
    let top = view::<u8, u32>(work.top).as_ptr().wrapping_add(shift * stride / 4);
    let (costs, sums) = (view::<u8, u32>(work.costs).as_ptr(), view_mut::<u8, u32>(work.sums).as_mut_ptr());
    let from = match direction {
        Direction::Right => top,
        Direction::Left => sums.cast_const(),
    };
    let (x, on, gap, columns) = match direction {
        Direction::Right => (0, 1, 0, width),
        Direction::Left => (width - 1, -1, -2, width - work.min_disparity),
    };
    let first = x * stride / 4;
    let mut frame = Frame {
        change: change.wrapping_add(if on > 0 { 0 } else { width }),
        on,
        steps: &steps,
        path: path.place(),
        fours: stride / 16,
        gap: gap * stride as isize,
        end: sums.wrapping_add(first).wrapping_offset(on * (columns * stride / 4) as isize).cast_const(),
        beside: [0; 2],
    };
    // SAFETY: `columns` columns from column `x` on are in the volumes, and a place more is there; and a
    // column has `4 * fours` words, `WORDS` at the most, as the path has room for.
    unsafe {
        go_along(
            &raw mut frame,
            costs.wrapping_add(first),
            from.wrapping_add(first),
            sums.wrapping_add(first),
        );
    }
}
