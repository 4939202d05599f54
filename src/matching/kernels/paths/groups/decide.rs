//! The path from the right, and the winners, in one pass to the left.

use super::group::Group;
use super::{Guide, Path, PathWork, Steps, mask, split_last, stride};
use crate::matching::kernels::BESIDE;
use crate::matching::kernels::winner::{Found, Unique};

/// Adds the path from the right to the other two and selects the winner of every pixel that has a candidate.
#[inline(always)]
pub(super) fn decide<G: Group, const CELLS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    mut unique: Unique<'_>,
    mut put: impl FnMut(usize, Found),
) {
    let stride = stride::<G, CELLS, ALL>(work);
    let (width, count, penalties) = (work.width, stride / G::LANES, work.penalties);
    let steps = Steps::<G, CELLS, ALL>::new(work);
    let volume = |bytes| G::cells(bytes).get(..width * count).unwrap_or(&[]);
    let (mut costs, mut sums) = (volume(work.costs), volume(work.sums));
    let mut left = Path::<G, CELLS, ALL>::of(split_last::<_, CELLS, ALL>(costs, count).map_or(&[], |(_, last)| last));
    let mut before = 0;
    for x in (work.min_disparity..width).rev() {
        let Some((rest, column)) = split_last::<_, CELLS, ALL>(costs, count) else { return };
        costs = rest;
        let here = guide.here.get(x).copied().unwrap_or(0);
        if x + 1 < width {
            left = left.step(&steps, penalties.between(here, before), column);
        }
        before = here;
        steps.close(&mut left);
        let Some((rest, column)) = split_last::<_, CELLS, ALL>(sums, count) else { return };
        sums = rest;
        let mut total = left;
        for (total, &sum) in total.0.iter_mut().zip(column) {
            *total = G::of(sum).plus_saturating(*total);
        }
        // The first pixels have fewer candidates than there are lanes.
        let candidates = work.disparities.min(x + 1 - work.min_disparity);
        let masked = candidates < stride;
        if masked {
            for (total, &mask) in total.0.iter_mut().zip(G::groups(mask(stride, candidates))) {
                *total = total.or(G::of_bytes(mask));
            }
        }
        let (cost, lane) = G::last_least(total.cells(count));
        let disparity = (stride - 1).wrapping_sub(lane);
        let at = |lane: usize| G::lane(&total.0, lane);
        let beside = if disparity > 0 && disparity + 1 < candidates {
            (at(lane + 1), at(lane.wrapping_sub(1)))
        } else {
            // At an end the one beside it that there is; beside an only candidate, itself.
            let one = at(if disparity > 0 { lane + 1 } else { lane.wrapping_sub(usize::from(candidates > 1)) });
            (one, one)
        };
        put(x, Found { disparity: disparity as u8, cost, beside });
        unique.judge(
            x,
            cost,
            #[inline(always)]
            || {
                for lane in lane.saturating_sub(BESIDE)..lane + BESIDE + 1 {
                    G::raise(&mut total.0, lane);
                }
                G::last_least(total.cells(count)).0
            },
        );
    }
}
