//! The path from above and the path from the left, from column to column to the right.

use super::{COLUMNS_OFF, Path, Steps, column, column_mut};
use crate::matching::backend::portable::group::Group;

/// The two paths on their way.
pub(super) struct Gather<'a, G: Group, const CELLS: usize, const ALL: bool> {
    count: usize,
    /// The last column.
    last: usize,
    /// The next one.
    x: usize,
    /// The paths from above: of the row above, and where the column is passed of this one.
    tops: &'a mut [G::Cell],
    /// What stood above columns that are overwritten already: two before, one before. Before the first there
    /// is the first.
    passed: [Path<G, CELLS, ALL>; COLUMNS_OFF],
    right: Path<G, CELLS, ALL>,
    before: u8,
}

impl<'a, G: Group, const CELLS: usize, const ALL: bool> Gather<'a, G, CELLS, ALL> {
    /// Before the first column, whose costs these are.
    #[inline(always)]
    pub(super) fn new(last: usize, count: usize, tops: &'a mut [G::Cell], first: &[G::Cell]) -> Self {
        let passed = [Path::of(column::<_, CELLS, ALL>(tops, 0, count)); COLUMNS_OFF];
        Self { count, last, x: 0, tops, passed, right: Path::of(first), before: 0 }
    }

    /// Goes on to the next column, which has this brightness, the one above it (none in the first row) that
    /// one, and these costs; and adds the two up.
    #[inline(always)]
    pub(super) fn next(
        &mut self,
        steps: &Steps<G, CELLS, ALL>,
        (here, above): (u8, Option<u8>),
        costs: &[G::Cell],
    ) -> Path<G, CELLS, ALL> {
        let x = self.x;
        self.x += 1;
        if x > 0 {
            self.right = self.right.step(steps, steps.between(here, self.before), costs);
        }
        self.before = here;
        let mut top = Path::of(costs);
        if let Some(above) = above {
            let ahead = column::<_, CELLS, ALL>(self.tops, (x + COLUMNS_OFF).min(self.last), self.count);
            let between = self.passed[0].average(ahead);
            self.passed = [self.passed[1], Path::of(column::<_, CELLS, ALL>(self.tops, x, self.count))];
            top = between.step(steps, steps.between(here, above), costs);
        }
        let kept = column_mut::<_, CELLS, ALL>(self.tops, x, self.count);
        let mut sum = self.right;
        for (kept, (sum, &top)) in kept.iter_mut().zip(sum.0.iter_mut().zip(&top.0)) {
            *kept = top.cell();
            *sum = sum.plus(top);
        }
        sum
    }
}
