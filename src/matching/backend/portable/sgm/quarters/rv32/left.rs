//! The path from the right and the winners: all pixels at once, or one by one where more is asked of them.

use super::row::{Pixels, Row, has_eight};
use super::select::{Selected, select_eight, select_fours};
use crate::matching::backend::portable::sgm::quarters::columns::words;
use crate::matching::backend::portable::sgm::quarters::lanes::before;
use crate::matching::backend::portable::sgm::quarters::rounds;
use crate::matching::backend::portable::sgm::quarters::second::{close_sums, second};
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::{view, view_mut};
use crate::matching::memory::winners::{Found, Unique, Winner};

/// Takes the path from the right along the row, and selects the winner of every pixel that has a candidate,
/// by the sum of its three paths. What the path from the left has put in the workspace stands there.
pub(in super::super) fn left<const WORDS: usize, const ALL: bool>(
    row: &Row,
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    unique: &mut Unique<'_>,
    put: &mut impl FnMut(usize, Found),
) {
    let mut room = [[0; WORDS]; 2];
    one_by_one(row, (work, guide), room.each_mut().map(|room| &mut room[..]), unique, put);
}

/// [`left`] into words, where nothing is asked of the second best.
pub(in super::super) fn left_words<const WORDS: usize, const ALL: bool>(
    row: &Row,
    work: &mut PathWork<'_>,
    winners: &mut [Winner],
) {
    let count = words::<WORDS, ALL>(work);
    let (width, begin) = (work.width, work.min_disparity);
    let mut room = [[0; WORDS]; 2];
    let [costs, sums] = [&*work.costs, &*work.sums].map(view::<u8, u32>);
    let is_there = costs.len().min(sums.len()) >= width * count
        && 4 * work.workspace.len() >= width
        && winners.len() >= width
        && count <= WORDS;
    if begin >= width || !is_there {
        return;
    }
    let last = width - 1;
    let select = if has_eight::<WORDS, ALL>() { select_eight } else { select_fours };
    let pixels = Selected {
        kinds: view::<u32, u8>(work.workspace).as_ptr().wrapping_add(last),
        costs: costs.as_ptr().wrapping_add(last * count),
        sums: sums.as_ptr().wrapping_add(last * count),
        winners: winners.as_mut_ptr().wrapping_add(last),
        path: room.as_flattened_mut().as_mut_ptr(),
        disparities: work.disparities,
    };
    // SAFETY: there are as many pixels from the first one on that has a candidate, and their columns.
    unsafe { select(row, pixels, width - begin) };
}

/// [`left`] with room for the path's column and for what counts of it, both of zeros.
#[inline(never)]
fn one_by_one(
    row: &Row,
    (work, guide): (&mut PathWork<'_>, Guide<'_>),
    [paths, open]: [&mut [u32]; 2],
    unique: &mut Unique<'_>,
    put: &mut dyn FnMut(usize, Found),
) {
    let PathWork { width, disparities, min_disparity, .. } = *work;
    let count = words::<0, false>(work);
    let [paths, open] = [paths, open].map(|room| part_mut(room, ..count));
    let costs = view::<u8, u32>(work.costs);
    let sums = view_mut::<u8, u32>(work.sums);
    let kinds = &*view_mut::<u32, u8>(work.workspace);
    let mut least = 0;
    for x in (min_disparity..width).rev() {
        let places = x * count..(x + 1) * count;
        let (costs, sums) = (part(costs, places.clone()), part_mut(sums, places));
        let (Some(&here), Some(&kind)) = (guide.here.get(x), kinds.get(x)) else { return };
        if costs.len() != count || sums.len() != count || paths.len() != count {
            return;
        }
        // The kind of the change from the pixel behind.
        let mut after = 0u8;
        let pixels = Pixels {
            here: &here,
            kinds: &mut after,
            costs: costs.as_ptr(),
            from: paths.as_ptr(),
            to: paths.as_mut_ptr(),
            before: guide.here.get(x + 1).copied().unwrap_or(0),
            least,
        };
        // SAFETY: a pixel, and its columns.
        least = unsafe { (row.along)(row, pixels, 1) };
        let jump = |kind: u8| row.steps.changes[2usize.saturating_sub(usize::from(kind / 8))].jump;
        let more = row.more.wrapping_sub(jump(kind)).wrapping_sub(jump(after));
        // The first pixels have fewer candidates than are searched.
        let candidates = disparities.min(x + 1 - min_disparity);
        let closed = 4 * count - candidates;
        let mut columns = [&*paths, &*sums];
        if candidates < disparities {
            close_sums(paths, sums, open, before(closed, count));
            columns = [&*open, &*sums];
        }
        let found = winner(columns, candidates, more);
        put(x, found);
        unique.check(x, found.cost, || {
            let winner_lane = 4 * count - 1 - usize::from(found.disparity);
            second(paths, sums, open, (closed, winner_lane), |columns| winner(columns, 1, more).cost)
        });
    }
}

/// `rounds::plain::winner`, once: it is rarely asked for.
#[inline(never)]
fn winner(columns: [&[u32]; 2], candidates: usize, more: u32) -> Found {
    rounds::winner(columns, candidates, more)
}
