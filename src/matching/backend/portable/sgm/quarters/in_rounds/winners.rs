//! The path from the right, and the winners of the paths' sums.

use super::along::Along;
use crate::matching::backend::portable::sgm::quarters::columns::words;
use crate::matching::backend::portable::sgm::quarters::lanes::before;
use crate::matching::backend::portable::sgm::quarters::rounds;
use crate::matching::backend::portable::sgm::quarters::second::{close_sums, second};
use crate::matching::backend::portable::sgm::quarters::steps::most;
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::{view, view_mut};
use crate::matching::memory::winners::{Found, Unique};
use core::cell::Cell;

/// Takes the path from the right along the row, and selects the winner of every pixel that has a candidate,
/// by the sum of its three paths.
#[inline(always)]
pub(super) fn left<const WORDS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    unique: &mut Unique<'_>,
    put: &mut impl FnMut(usize, Found),
) {
    let PathWork { width, disparities, min_disparity, .. } = *work;
    let count = words::<WORDS, ALL>(work);
    // What the sums of two paths along the row have more than their costs, and twice what jumps cost.
    let more = 2 * (128 - u32::from(most(work.penalties)));
    let mut path = Along::new(work, count);
    let mut room = [[0; WORDS]; 2];
    let [paths, open] = room.each_mut().map(|room| part_mut(room, ..count));
    let costs = part(view::<u8, u32>(work.costs), ..width * count);
    let sums = part_mut(view_mut::<u8, u32>(work.sums), ..width * count);
    let jumps = &*view_mut::<u32, u8>(work.workspace);
    let mut after = 0;
    let mut columns = rchunks(costs, count).zip(rchunks_mut(sums, count));
    let pixels = part(guide.here, ..width).iter().zip(jumps).enumerate();
    for (x, (&here, &jump)) in pixels.skip(min_disparity).rev() {
        let Some((costs, sums)) = columns.next() else { return };
        let cells = Cell::from_mut(&mut *paths).as_slice_of_cells();
        let jumps = u32::from(jump) + path.advance(here.abs_diff(after), costs, cells, cells);
        after = here;
        let more = more.wrapping_sub(jumps);
        // The first pixels have fewer candidates than are searched.
        let candidates = disparities.min(x + 1 - min_disparity);
        let closed = 4 * count - candidates;
        let mut columns = [&*paths, &*sums];
        if candidates < disparities {
            close_sums(paths, sums, open, before(closed, count));
            columns = [open, sums];
        }
        let found = rounds::winner(columns, candidates, more);
        put(x, found);
        unique.check(
            x,
            found.cost,
            #[inline(always)]
            || {
                let winner = 4 * count - 1 - usize::from(found.disparity);
                let least = |columns: [&[u32]; 2]| rounds::winner(columns, 1, more).cost;
                second(paths, sums, open, (closed, winner), least)
            },
        );
    }
}

/// The columns of a volume, the last first.
#[inline(always)]
fn rchunks<T>(slice: &[T], count: usize) -> impl Iterator<Item = &[T]> {
    let mut rest = slice;
    core::iter::from_fn(move || {
        let (before, chunk) = rest.split_at_checked(rest.len().wrapping_sub(count))?;
        rest = before;
        Some(chunk)
    })
}

/// Mutable access to what [`rchunks`] gives.
#[inline(always)]
fn rchunks_mut<T>(slice: &mut [T], count: usize) -> impl Iterator<Item = &mut [T]> {
    let mut rest = slice;
    core::iter::from_fn(move || {
        let place = rest.len().wrapping_sub(count);
        let (before, chunk) = core::mem::take(&mut rest).split_at_mut_checked(place)?;
        rest = before;
        Some(chunk)
    })
}
