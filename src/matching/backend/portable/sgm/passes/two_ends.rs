//! The paths through a row from both of its ends at once, where a column is a few registers.
//!
//! Each step of a path waits for the one before, for longer than its instructions take. The path from the
//! left and the path from the right do not wait for each other: both advance by one column at a time, and
//! winners are selected once they have met in the middle, as each comes by where the other has been.

use super::selection::Selection;
use super::{COLUMNS_OFF, Guide, Path, PathWork, Steps};
use crate::matching::backend::portable::group::Group;
use crate::matching::memory::slices::{part, split_mut};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::{Found, Unique};

/// A column of a volume, in memory.
type Column<G, const CELLS: usize> = [<G as Group>::Cell; CELLS];

/// Selects the winner of every pixel that has a candidate, by the sum of its three paths.
#[inline(always)]
pub(super) fn select<G: Group, const CELLS: usize>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    unique: Unique<'_>,
    put: impl FnMut(usize, Found),
) {
    let steps = Steps::<G, CELLS, true>::new(work);
    let PathWork { width, disparities, min_disparity, .. } = *work;
    let (along, rest) = split_mut(view_mut::<u32, u8>(work.workspace), width);
    let (down, _) = split_mut(rest, width);
    let here = part(guide.here, ..width);
    steps.grade(part(here, 1.min(width)..), here, along);
    // In the first row there is nothing above, from which no path costs anything, whatever the change.
    steps.grade(here, guide.above.unwrap_or(here), down);

    let costs = G::cells(work.costs).as_chunks::<CELLS>().0;
    let tops = G::cells_mut(work.top).as_chunks_mut::<CELLS>().0;
    let sums = G::cells_mut(work.sums).as_chunks_mut::<CELLS>().0;
    let (Some(costs), Some(sums), Some(tops)) =
        (costs.get(..width), sums.get_mut(..width), tops.get_mut(..width + COLUMNS_OFF))
    else {
        return;
    };
    let (Some(along), Some(down)) = (along.get(..width), down.get(..width)) else { return };
    let Some(last) = width.checked_sub(1) else { return };
    // Behind the last column stands the same.
    let (inside, behind) = split_mut(tops, width);
    if let Some(&column) = inside.last() {
        behind.fill(column);
    }
    let mut right = Gather::new(tops);
    let mut left = Path::<G, CELLS, true>([G::splat(0); CELLS]);
    let stride = CELLS * G::LANES;
    let mut selection = Selection { stride, disparities, min_disparity, unique, put };
    for x in 0..width {
        let y = last - x;
        if y >= width {
            break;
        }
        // Between a column and the next one there is one change for both paths.
        let change = x.checked_sub(1).map_or(0, |before| along[before]);
        let gathered = right.next(&steps, (change, down[x]), &costs[x], tops, x);
        left = left.step(&steps, steps.change(along[y]), &costs[y]);
        if x < y {
            gathered.put(&mut sums[x]);
            left.put(&mut sums[y]);
            continue;
        }
        let meets = if x == y { left } else { Path::of(&sums[x]) };
        if x >= min_disparity {
            selection.select(x, gathered.plus_saturating(&meets));
        }
        if x > y && y >= min_disparity {
            selection.select(y, Path::of(&sums[y]).plus_saturating(&left));
        }
    }
}

/// The path from the left and the one from above, on their way to the right.
struct Gather<G: Group, const CELLS: usize> {
    right: Path<G, CELLS, true>,
    /// What stood above columns that are overwritten already: two before, one before. Before the first there
    /// is the first.
    passed: [Path<G, CELLS, true>; COLUMNS_OFF],
}

impl<G: Group, const CELLS: usize> Gather<G, CELLS> {
    /// Before the first column.
    #[inline(always)]
    fn new(tops: &[Column<G, CELLS>]) -> Self {
        let first = tops.first().map_or(Path([G::splat(0); CELLS]), |first| Path::of(first));
        Self { right: Path([G::splat(0); CELLS]), passed: [first; COLUMNS_OFF] }
    }

    /// Goes on to column `x`, which has these changes of brightness to the left and above and these costs,
    /// and adds the two up. In `tops` stand the paths from above: of the row above, and where the column is
    /// passed of this one.
    #[inline(always)]
    fn next(
        &mut self,
        steps: &Steps<G, CELLS, true>,
        (along, down): (u8, u8),
        costs: &Column<G, CELLS>,
        tops: &mut [Column<G, CELLS>],
        x: usize,
    ) -> Path<G, CELLS, true> {
        self.right = self.right.step(steps, steps.change(along), costs);
        let mut sum = self.right;
        if let Some([here, .., ahead]) = tops.get_mut(x..=x + COLUMNS_OFF) {
            let between = self.passed[0].average(&*ahead);
            self.passed = [self.passed[1], Path::of(&*here)];
            let top = between.step(steps, steps.change(down), costs);
            top.put(here);
            for (sum, &top) in sum.0.iter_mut().zip(&top.0) {
                *sum = sum.plus(top);
            }
        }
        sum
    }
}
