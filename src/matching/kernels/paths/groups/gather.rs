//! The path from above and the path from the left, in one pass to the right.

use super::group::Group;
use super::{COLUMNS_OFF, Guide, Path, PathWork, Steps, split_first, split_first_mut, stride};

/// Moves the path from above down to the row and the path from the left through it, and adds the two up.
#[inline(always)]
pub(super) fn gather<G: Group, const CELLS: usize, const ALL: bool>(work: &mut PathWork<'_>, guide: Guide<'_>) {
    let (width, penalties) = (work.width, work.penalties);
    let steps = Steps::<G, CELLS, ALL>::new(work);
    let count = stride::<G, CELLS, ALL>(work) / G::LANES;
    let (mut costs, tops, mut sums) = (G::cells(work.costs), G::cells_mut(work.top), G::cells_mut(work.sums));
    let Some((first, _)) = split_first::<_, CELLS, ALL>(tops, count) else { return };
    // What stood above columns that are overwritten already: two before, one before. Before the first there is the first.
    let mut passed = [Path::<G, CELLS, ALL>::of(first); COLUMNS_OFF];
    let mut right = Path::of(split_first::<_, CELLS, ALL>(costs, count).map_or(&[], |(first, _)| first));
    let mut before = 0;
    // In the first row nothing is above.
    let line = guide.above.unwrap_or(guide.here);
    for (x, (&here, &there)) in guide.here.iter().zip(line).enumerate().take(width) {
        let Some((column, rest)) = split_first::<_, CELLS, ALL>(costs, count) else { return };
        costs = rest;
        if x > 0 {
            right = right.step(&steps, penalties.between(here, before), column);
        }
        before = here;
        steps.close(&mut right);
        let Some((_, tops)) = tops.split_at_mut_checked(x * count) else { return };
        let mut top = Path::of(column);
        if guide.above.is_some() {
            let ahead = tops.get(COLUMNS_OFF.min(width - 1 - x) * count..);
            let ahead = ahead.and_then(|ahead| split_first::<_, CELLS, ALL>(ahead, count));
            let (Some((above, _)), Some((ahead, _))) = (split_first::<_, CELLS, ALL>(tops, count), ahead) else {
                return;
            };
            let between = passed[0].average(ahead);
            passed = [passed[1], Path::of(above)];
            top = between.step(&steps, penalties.between(here, there), column);
        }
        steps.close(&mut top);
        let kept = split_first_mut::<_, CELLS, ALL>(tops, count);
        let (Some((kept, _)), Some((sum, rest))) = (kept, split_first_mut::<_, CELLS, ALL>(sums, count)) else {
            return;
        };
        sums = rest;
        for ((sum, kept), (&right, &top)) in sum.iter_mut().zip(kept).zip(right.0.iter().zip(&top.0)) {
            *sum = right.plus(top).cell();
            *kept = top.cell();
        }
    }
}
