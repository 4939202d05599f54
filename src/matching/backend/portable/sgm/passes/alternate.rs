//! The paths through a row where registers hold a few cells only: one cell after the other, and a path's
//! costs in memory. A loop does at once all that there is to do with a cell, and finds the least cost for the
//! path's next step on its way.

use super::selection::Selection;
use super::{COLUMNS_OFF, Guide, Path, PathWork, Steps, stride};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::group::Group;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::winners::{Found, Unique};
use core::cell::Cell;

/// Selects the winner of every pixel that has a candidate, by the sum of its three paths. There is room for
/// one cell more than a column has.
#[inline(always)]
pub(super) fn select<G: Group, const CELLS: usize>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    unique: Unique<'_>,
    put: impl FnMut(usize, Found),
) {
    let stride = stride::<G, CELLS, false>(work);
    let steps = Steps::<G, CELLS, false>::new(work);
    let PathWork { width, disparities, min_disparity, .. } = *work;
    let (count, last) = (stride / G::LANES, width.saturating_sub(1));
    let costs = part(G::cells(work.costs), ..width * count);
    let sums = part_mut(G::cells_mut(work.sums), ..width * count);
    let tops = G::cells_mut(work.top);
    let here = part(guide.here, ..width);

    let mut right = Walk::new(&steps);
    right.begin(count);
    let mut between = Walk::new(&steps);
    between.begin(count);
    // What stood above the last two columns, which is overwritten already. Before the first there is the
    // first.
    let mut passed = [[steps.far; CELLS]; COLUMNS_OFF];
    for passed in &mut passed {
        for (passed, &first) in passed.iter_mut().zip(part(tops, ..count)) {
            keep_loop();
            *passed = G::of(first);
        }
    }
    let mut before = 0;
    for (x, &here) in here.iter().enumerate() {
        let (Some(costs), Some(sums)) = (whole(costs, x, count), whole_mut(sums, x, count)) else { return };
        right.advance(&steps, steps.between(here, before), costs, costs.iter(), |_, _| ());
        before = here;
        let mut change = steps.between(here, here);
        if let Some(line) = guide.above {
            let (Some(ahead), Some(under)) =
                (whole(tops, (x + COLUMNS_OFF).min(last), count), whole(tops, x, count))
            else {
                return;
            };
            let mut least = steps.far;
            let [even, odd] = &mut passed;
            let passed = if x.is_multiple_of(COLUMNS_OFF) { even } else { odd };
            let columns = ahead.iter().zip(under);
            for ((between, passed), (&ahead, &under)) in between.cells.iter_mut().zip(passed).zip(columns) {
                keep_loop();
                *between = passed.average_down(G::of(ahead));
                least = least.min(*between);
                *passed = G::of(under);
            }
            between.least = least.least();
            change = steps.between(here, line.get(x).copied().unwrap_or(0));
        }
        let Some(kept) = whole_mut(tops, x, count) else { return };
        let least = between.least;
        let both = kept.iter_mut().zip(&right.cells).zip(sums);
        step(
            between.cells(count),
            least,
            (steps.far, change),
            costs,
            both,
            |_, ((kept, right), sum), top| {
                *kept = top.cell();
                *sum = right.plus(top).cell();
            },
        );
    }

    let mut left = Walk::new(&steps);
    left.begin(count);
    let mut total = Path::<G, CELLS, false>([G::splat(0); CELLS]);
    let mut after = 0;
    let mut selection = Selection { stride, disparities, min_disparity, unique, put };
    for (x, &here) in here.iter().enumerate().skip(min_disparity).rev() {
        let (Some(costs), Some(sums)) = (whole(costs, x, count), whole(sums, x, count)) else { return };
        let both = total.0.iter_mut().zip(sums);
        left.advance(&steps, steps.between(here, after), costs, both, |(total, &sum), left| {
            *total = G::of(sum).plus_saturating(left);
        });
        after = here;
        selection.select_in_place(x, &mut total);
    }
}

/// A column of a volume, whole, so that the compiler knows its length; none where it is not there.
#[inline(always)]
fn whole<C>(volume: &[C], x: usize, count: usize) -> Option<&[C]> {
    volume.get(x * count..)?.get(..count)
}

/// Mutable access to what [`whole`] gives.
#[inline(always)]
fn whole_mut<C>(volume: &mut [C], x: usize, count: usize) -> Option<&mut [C]> {
    volume.get_mut(x * count..)?.get_mut(..count)
}

/// A path at a pixel: its costs, and behind them a cell that no path comes from.
struct Walk<G, const CELLS: usize> {
    cells: [G; CELLS],
    /// The least of them, in all lanes.
    least: G,
}

impl<G: Group, const CELLS: usize> Walk<G, CELLS> {
    /// Cells that no path comes from.
    #[inline(always)]
    fn new(steps: &Steps<G, CELLS, false>) -> Self {
        Self { cells: [steps.far; CELLS], least: G::splat(0) }
    }

    /// Before the first pixel so many cost nothing.
    #[inline(always)]
    fn begin(&mut self, count: usize) {
        for cell in self.cells.iter_mut().take(count) {
            keep_loop();
            *cell = G::splat(0);
        }
    }

    /// The costs, and the cell behind them.
    #[inline(always)]
    fn cells(&mut self, count: usize) -> &[Cell<G>] {
        Cell::from_mut(part_mut(&mut self.cells, ..=count)).as_slice_of_cells()
    }

    /// Advances the path by one pixel, which has these `costs`, and gives `put` each cell of its aggregated
    /// costs, beside an item of `with`.
    #[inline(always)]
    fn advance<T>(
        &mut self,
        steps: &Steps<G, CELLS, false>,
        change: &[G::Cell; 2],
        costs: &[G::Cell],
        with: impl Iterator<Item = T>,
        mut put: impl FnMut(T, G),
    ) {
        let (before, mut least) = (self.least, steps.far);
        step(self.cells(costs.len()), before, (steps.far, change), costs, with, |cell, with, cost| {
            cell.set(cost);
            least = least.min(cost);
            put(with, cost);
        });
        self.least = least.least();
    }
}

/// What a path costs at the next pixel, cell by cell: `far` is a cost that no path comes from, `change` what
/// a step and a jump cost.
#[inline(always)]
fn step<G: Group, T>(
    path: &[Cell<G>],
    least: G,
    (far, change): (G, &[G::Cell; 2]),
    costs: &[G::Cell],
    with: impl Iterator<Item = T>,
    mut put: impl FnMut(&Cell<G>, T, G),
) {
    let (step, jump) = (G::of(change[0]), G::of(change[1]));
    let from_least = least.plus(jump);
    let (mut before, mut here) = (far, path.first().map_or(far, Cell::get));
    // Slices, which are asked for their ends once.
    let cells = path.iter().zip(part(path, 1..)).zip(costs);
    for (((cell, next), &cost), with) in cells.zip(with) {
        keep_loop();
        let next = next.get();
        let beside = here.after(before).min(here.before(next)).plus(step);
        // From the least, by as much less as it is to come from near: the lesser of both, less the least.
        let saved = from_least.minus_saturating(here.min(beside));
        put(cell, with, G::of(cost).plus(jump).minus(saved));
        (before, here) = (here, next);
    }
}
