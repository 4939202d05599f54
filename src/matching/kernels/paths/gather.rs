//! The path from above and the path from the left, in one pass to the right.

use super::group::Group;
use super::{Guide, Path, PathWork, Steps, cells, cells_mut, stride};
use crate::matching::paths::Along;

/// How many columns to each side the path from above comes from.
const BESIDE: usize = 2;

/// Moves the path from above down to the row and the path from the left through it, and adds the two up.
#[inline(always)]
pub(super) fn gather<G: Group, S: Along, const CELLS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
) {
    let stride = stride::<G, CELLS, ALL>(work);
    let (width, penalties) = (work.width, work.penalties);
    let steps = Steps::<G, CELLS, ALL>::new(work);
    let bright = |line: &[u8], x: usize| line.get(x).copied().unwrap_or(0);
    let at = Path::<G, CELLS, ALL>::at;
    let mut right = at(work.costs, 0, stride);
    // What stood above columns that are overwritten already: two before, one before. Before the first there is the first.
    let mut passed = [at(work.top, 0, stride); BESIDE];
    for x in 0..width {
        let here = bright(guide.here, x);
        let costs = cells::<G>(work.costs, x, stride);
        if x > 0 {
            right.step(&steps, penalties.jump_between(here, bright(guide.here, x - 1)), costs);
        }
        let above = at(work.top, x, stride);
        let [before, last] = passed;
        passed = [last, above];
        let mut top = match guide.above {
            None => Path::of(costs),
            Some(line) if S::TWO_FROM_ABOVE => {
                // Of two messages the average, where there are two.
                let message = |from: Option<Path<G, CELLS, ALL>>, x: usize| {
                    from.map(|path| path.message(&steps, penalties.jump_between(here, bright(line, x))))
                };
                let before = message((x >= BESIDE).then_some(before), x.wrapping_sub(BESIDE));
                let next = (x + BESIDE < width).then(|| at(work.top, x + BESIDE, stride));
                let next = message(next, x + BESIDE);
                match (before, next) {
                    (Some(before), Some(next)) => before.average(&next).plus(costs),
                    (Some(one), None) | (None, Some(one)) => one.plus(costs),
                    (None, None) => Path::of(costs),
                }
            }
            Some(line) => {
                let next = at(work.top, (x + BESIDE).min(width - 1), stride);
                let mut top = before.average(&next);
                top.step(&steps, penalties.jump_between(here, bright(line, x)), costs);
                top
            }
        };
        steps.close(&mut right);
        steps.close(&mut top);
        let sums = cells_mut::<G>(work.sums, x, stride).iter_mut().zip(cells_mut::<G>(work.top, x, stride));
        for ((sum, kept), (&right, &top)) in sums.zip(right.cells().iter().zip(top.cells())) {
            *sum = right.plus(top).cell();
            *kept = top.cell();
        }
    }
}
