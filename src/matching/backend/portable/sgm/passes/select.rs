//! The paths through a row, one after the other: each step of a path waits for the step before, and one path
//! at a time stays in registers.

use super::gather::Gather;
use super::selection::{LeftwardPath, Selection};
use super::{Guide, Path, PathWork, Steps, column, stride};
use crate::matching::backend::portable::group::Group;
use crate::matching::memory::slices::{chunks, chunks_mut, part, part_mut};
use crate::matching::memory::winners::{Found, Unique};

/// Selects the winner of every pixel that has a candidate, by the sum of its three paths.
#[inline(always)]
pub(super) fn select<G: Group, const CELLS: usize, const ALL: bool>(
    work: &mut PathWork<'_>,
    guide: Guide<'_>,
    unique: Unique<'_>,
    put: impl FnMut(usize, Found),
) {
    let stride = stride::<G, CELLS, ALL>(work);
    let steps = Steps::<G, CELLS, ALL>::new(work);
    let PathWork { width, disparities, min_disparity, .. } = *work;
    let (count, last) = (stride / G::LANES, width.saturating_sub(1));
    let costs = part(G::cells(work.costs), ..width * count);
    let sums = part_mut(G::cells_mut(work.sums), ..width * count);
    let end = |x| column::<_, CELLS, ALL>(costs, x, count);
    let here = part(guide.here, ..width);

    let mut right = Gather::<G, CELLS, ALL>::new(last, count, G::cells_mut(work.top), end(0));
    let pixels = here.iter().zip(chunks(costs, count)).zip(chunks_mut(sums, count));
    for (x, ((&here, costs), sum)) in pixels.enumerate() {
        let above = guide.above.map(|line| line.get(x).copied().unwrap_or(0));
        right.next(&steps, (here, above), costs).put(sum);
    }

    let mut left = LeftwardPath::<G, CELLS, ALL>::new(end(last));
    let mut selection = Selection { stride, disparities, min_disparity, unique, put };
    for (x, &here) in here.iter().enumerate().skip(min_disparity).rev() {
        let [costs, sum] = [costs, &*sums].map(|volume| column::<_, CELLS, ALL>(volume, x, count));
        selection.select(x, Path::of(sum).plus_saturating(&left.next(&steps, here, costs)));
    }
}
