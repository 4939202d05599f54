//! Costs along paths in Helium: the passes of `portable::sgm` for columns of 16, 32, 48 and 64 candidates,
//! one to four vectors; for any other number they are in `any` and `any_paths`.
//!
//! * A path stays in memory, between bytes that no path comes from: what stands beside a disparity is the
//!   same vector one byte off.
//! * With m the least that it costs to come from near, a path's cost at a pixel is
//!   `cost + min(m, least + jump) - least`. A saturating addition of `255 - jump - least` to m is the minimum
//!   and the subtraction at once: what it has too much is `255 - jump`, the same for all lanes, which is
//!   taken off. Everything stays within a byte: the paths through a row have a least of at most `cost`, and
//!   the average of two of them one of at most `cost + jump / 2`, so that `least + jump` is at most 190 by
//!   what `Penalties::check` asks for; and a step from a path's cost that is more than 255 counts as 255,
//!   which is more than any cost that it is compared with.
//!
//! * `features`: what is compared. `cost`: its comparison. `edges`: how far costs are averaged.
//! * `changes`: what the paths pay at each pixel. `down`, `rightward`, `leftward`: the paths, the last one
//!   with the winners. `room`: what they work with.
#![allow(unsafe_code)]

mod any;
mod any_paths;
mod changes;
mod cost;
mod down;
mod edges;
mod features;
mod leftward;
mod rightward;
mod room;

use super::LANES;
use crate::matching::backend::mve::rows::fill;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features as portable;
use crate::matching::backend::work::{CostWork, EdgeWork, Guide, PathWork};
use crate::matching::memory::slices::{part_mut, split_mut};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::Select;
use changes::changes;
use features::HeliumRows;
use leftward::Leftward;
use room::Room;

/// [`Isa::sgm_cost`](crate::matching::backend::Isa::sgm_cost) for each number of candidates.
#[inline(always)]
pub(super) fn cost<S: SgmParameters, const MOST: usize>(work: &mut PathWork<'_>, row: CostWork<'_>) {
    match work.stride {
        16 if MOST == 0 || MOST == 16 => enter::<S, 16>(work, row),
        32 if MOST == 0 || MOST == 32 => enter::<S, 32>(work, row),
        64 if MOST == 0 || MOST == 64 => enter::<S, 64>(work, row),
        48 if MOST == 0 => enter::<S, 48>(work, row),
        _ if MOST == 0 => enter::<S, 0>(work, row),
        _ => {}
    }
}

/// [`Isa::sgm_within_edges`](crate::matching::backend::Isa::sgm_within_edges).
#[inline(never)]
pub(super) fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
    edges::within_edges(work, edges);
}

/// [`Isa::sgm_select`](crate::matching::backend::Isa::sgm_select) for each number of candidates.
#[inline(always)]
pub(super) fn select<const MOST: usize>(work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
    match work.stride {
        16 if MOST == 0 || MOST == 16 => select_among::<16>(work, guide, select),
        32 if MOST == 0 || MOST == 32 => select_among::<32>(work, guide, select),
        64 if MOST == 0 || MOST == 64 => select_among::<64>(work, guide, select),
        48 if MOST == 0 => select_among::<48>(work, guide, select),
        _ if MOST == 0 => any::select(work, guide, select),
        _ => {}
    }
}

/// Adds a row; with code for so many candidates, or for any number if that is 0.
#[inline(never)]
fn enter<S: SgmParameters, const STRIDE: usize>(work: &mut PathWork<'_>, row: CostWork<'_>) {
    if row.is_first {
        fill(work.costs, 0);
    }
    let Some(features) = portable::of::<HeliumRows, S>(work, row.lines, row.workspace) else { return };
    if STRIDE > 0 {
        cost::enter::<S, STRIDE>(work, &features);
    } else {
        any::enter::<S>(work, &features);
    }
    work.close(work.stride, work.penalties.cost);
}

#[inline(never)]
fn select_among<const STRIDE: usize>(work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
    let Select { mut winners, unique, .. } = select;
    let (width, begin) = (work.width, work.min_disparity.min(work.width));
    let workspace = core::mem::take(&mut work.workspace);
    let (along, rest) = split_mut(view_mut::<u32, u16>(workspace), width + 1);
    let Some(mut room) = Room::<STRIDE>::new(view_mut::<u16, u8>(rest)) else { return };
    // There are no winners yet where the changes down to the row are.
    let down = part_mut(view_mut::<u8, u16>(winners.bytes()), ..width);
    changes(guide.here, guide.above.unwrap_or(guide.here), work.penalties, down);
    down::go(work, guide, down, STRIDE, |run| {
        // SAFETY: the columns are those of `go`, and the path is the room's own.
        unsafe { down::walk::<STRIDE>(run, room.path()) }
    });

    // Into a column from the one before it, from the right into that one from it. Nothing comes into the
    // first one nor into the last: what they pay is nothing whatever stands there.
    let places = part_mut(along, 1..width);
    changes(guide.here.get(1..).unwrap_or_default(), guide.here, work.penalties, places);
    room.begin();
    let mut least = 0;
    rightward::go(work, guide.row, along, STRIDE, |run| {
        // SAFETY: the columns are those of `go`, and the path is the room's own.
        unsafe { rightward::walk::<STRIDE>(run, &mut least, room.path()) }
    });
    if begin < width {
        let rows = winners.bytes();
        Leftward::<STRIDE> { work, begin, along, room, rows }.select(unique);
        let rows = winners.rows(begin);
        let rows = [rows.below, rows.costs, rows.above, rows.disparities];
        super::complete(rows, select.disparities);
    }
}
