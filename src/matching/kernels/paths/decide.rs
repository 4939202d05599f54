//! The path from the right, and the winners, in one pass to the left.

use super::group::Group;
use super::{Guide, Path, PathWork, Steps, cells, mask, stride};
use crate::matching::kernels::winner::{Found, Unique};

/// Adds the path from the right to the other two and selects the winner of every pixel that has a candidate.
#[inline(always)]
pub(super) fn decide<G: Group, const CELLS: usize, const ALL: bool>(
    work: &PathWork<'_>,
    guide: Guide<'_>,
    mut unique: Unique<'_>,
    mut put: impl FnMut(usize, Found),
) {
    let stride = stride::<G, CELLS, ALL>(work);
    let (width, penalties) = (work.width, work.penalties);
    let steps = Steps::<G, CELLS, ALL>::new(work);
    let bright = |x: usize| guide.here.get(x).copied().unwrap_or(0);
    let mut left = Path::<G, CELLS, ALL>::of(cells::<G>(work.costs, width - 1, stride));
    let mut total = left;
    for x in (work.min_disparity..width).rev() {
        let costs = cells::<G>(work.costs, x, stride);
        if x + 1 < width {
            left.step(&steps, penalties.jump_between(bright(x), bright(x + 1)), costs);
        }
        steps.close(&mut left);
        let sums = cells::<G>(work.sums, x, stride);
        for (total, (&sum, &left)) in total.cells_mut().iter_mut().zip(sums.iter().zip(left.cells())) {
            *total = G::of(sum).plus_saturating(left);
        }
        // The first pixels have fewer candidates than there are lanes.
        let candidates = work.disparities.min(x - work.min_disparity + 1);
        let masked = candidates < stride;
        if masked {
            for (total, &mask) in total.cells_mut().iter_mut().zip(G::groups(mask(stride, candidates))) {
                *total = total.or(G::of_bytes(mask));
            }
        }
        let (cost, lane) = G::last_least(total.cells());
        let disparity = (stride - 1).wrapping_sub(lane);
        let at = |lane: usize| G::lane(total.cells(), lane);
        let beside = if disparity > 0 && disparity + 1 < candidates {
            (at(lane + 1), at(lane.wrapping_sub(1)))
        } else {
            // At an end the one beside it that there is; beside an only candidate, itself.
            let one = at(if disparity > 0 { lane + 1 } else { lane.wrapping_sub(usize::from(candidates > 1)) });
            (one, one)
        };
        put(x, Found { disparity: disparity as u8, cost, beside });
        unique.judge(x, cost, || {
            for lane in [lane.wrapping_sub(1), lane, lane + 1] {
                G::raise(total.cells_mut(), lane);
            }
            G::last_least(total.cells()).0
        });
    }
}
