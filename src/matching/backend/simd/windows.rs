//! Costs summed over windows, and their winners, for groups of bytes whose lanes run over the disparities of
//! one pixel, the largest first: so a pixel's candidates stand in memory as they do in the right image.
//!
//! A pixel's work, `d` over all lanes:
//!
//! ```text
//! column x + r:  column[d] += apart(enter.left, enter.right[d]) - apart(leave.left, leave.right[d])
//! window x:      sum[d]    += digits(column[x + r][d]) - digits(column[x - r - 1][d])
//! winner x:      the least sum[d] | mask[d], and the last lane that holds it
//! ```
//!
//! The work is the same for every picture, but for a few instructions where a winner is at an end of the
//! search.

use super::row_codes::with_more_before;
use super::{Vector, columns};
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::portable::group::Group;
use crate::matching::backend::work::{MASKS, STEP, WindowWork};
use crate::matching::memory::layout::OUTSIDE;
use crate::matching::memory::slices::part;
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::{Select, WinnerRows, beside};

/// [`Isa::window`](crate::matching::backend::Isa::window) in vectors of the compilation's own target.
pub(super) fn in_vectors<S: WindowParameters>(work: WindowWork<'_>, select: Option<Select<'_>>) {
    match work.stride {
        32 => whole::<S, { 32 / Vector::LANES }>(work, select),
        64 => whole::<S, { 64 / Vector::LANES }>(work, select),
        128 => whole::<S, { 128 / Vector::LANES }>(work, select),
        _ => row::<S, Vector, { 256 / Vector::LANES }, false>(work, select),
    }
}

/// Each number of groups in a function of its own: the compiler's passes take far longer over one function of
/// all of them.
#[inline(never)]
fn whole<S: WindowParameters, const CELLS: usize>(work: WindowWork<'_>, select: Option<Select<'_>>) {
    row::<S, Vector, CELLS, true>(work, select);
}

/// [`Isa::window`](crate::matching::backend::Isa::window) in columns of up to `CELLS` groups, all of them in
/// use if `ALL`: then the compiler knows how many.
#[inline(always)]
pub(super) fn row<S: WindowParameters, G: Group, const CELLS: usize, const ALL: bool>(
    work: WindowWork<'_>,
    select: Option<Select<'_>>,
) {
    const { assert!(S::RADIUS_X < OUTSIDE) };
    let WindowWork { width, stride, min_disparity, enter, leave, columns, workspace } = work;
    let stride = if ALL { CELLS * G::LANES } else { stride.max(STEP) };
    let count = stride / G::LANES;
    let codes = view_mut::<u32, u8>(workspace);
    let Some((new, old)) = codes.split_at_mut_checked(codes.len() / 2) else { return };
    let enter = enter.map(|row| with_more_before(row, min_disparity, stride, new));
    let leave = leave.map(|row| with_more_before(row, min_disparity, stride, old));
    if let Some(inside) = columns.get_mut(OUTSIDE * stride..) {
        let columns = G::cells_mut(inside);
        // A single group is read as fast as it is moved.
        if ALL && CELLS > 1 {
            columns::update::<S, G, CELLS, true>(stride, enter, leave, columns);
        } else {
            columns::update::<S, G, CELLS, false>(stride, enter, leave, columns);
        }
    }
    let Some(Select { disparities, winners, mut unique }) = select else { return };

    // Left of here no pixel has a candidate.
    let begin = min_disparity.min(width);
    let WinnerRows { below, costs, above, disparities: found } = winners.rows(begin);
    let cells = G::cells(columns);
    let from = |column: usize| part(cells, column * count..).chunks_exact(count);
    let mut sums = Sums::<G, CELLS, ALL>([G::splat(0); CELLS]);
    // The column that leaves at the first pixel is among them.
    let before = begin.saturating_sub(S::RADIUS_X + 1);
    let none = [G::splat(0).cell(); CELLS];
    for column in from(OUTSIDE + before).take(begin + S::RADIUS_X - before) {
        sums.slide::<S>(column, &none);
    }
    let pixels = below.iter_mut().zip(costs).zip(above.iter_mut().zip(found));
    let ends = from(OUTSIDE + begin + S::RADIUS_X).zip(from(OUTSIDE + begin - S::RADIUS_X - 1));
    for (x, (((below, cost), (above, disparity)), (enters, leaves))) in pixels.zip(ends).enumerate() {
        sums.slide::<S>(enters, leaves);
        let mut masked = sums;
        // The first pixels have fewer candidates than there are lanes; where there are more lanes than
        // candidates, all have.
        let candidates = disparities.min(x + 1);
        if candidates < stride {
            let mask = part(part(MASKS, 256 - (stride - candidates)..), ..stride);
            for (sum, &mask) in masked.0.iter_mut().zip(G::groups(mask)) {
                *sum = sum.or(G::of_bytes(mask));
            }
        }
        let (least, lane) = G::last_least_by_keys(masked.cells(stride));
        (*cost, *disparity) = (least, (stride - 1).wrapping_sub(lane) as u8);
        let is_inside = *disparity > 0 && usize::from(*disparity) + 1 < candidates;
        (*below, *above) = match masked.0.as_slice() {
            // Not read from memory, where it is written at this moment.
            [cell] if G::IS_A_LINE && is_inside => cell.lanes([lane + 1, lane.wrapping_sub(1)]).into(),
            _ => beside(stride, *disparity, candidates, |lane| G::lane(&masked.0, lane)),
        };
        unique.check(
            begin + x,
            least,
            #[inline(always)]
            || {
                G::raise_around(&mut masked.0, lane);
                G::last_least(masked.cells(stride)).0
            },
        );
    }
}

/// The sums of the window of a pixel.
#[derive(Clone, Copy)]
struct Sums<G, const CELLS: usize, const ALL: bool>([G; CELLS]);

impl<G: Group, const CELLS: usize, const ALL: bool> Sums<G, CELLS, ALL> {
    /// The cells in use.
    #[inline(always)]
    fn cells(&self, stride: usize) -> &[G] {
        if ALL { &self.0 } else { part(&self.0, ..stride / G::LANES) }
    }

    /// Moves on a column.
    #[inline(always)]
    fn slide<S: WindowParameters>(&mut self, enters: &[G::Cell], leaves: &[G::Cell]) {
        for (sum, (&enters, &leaves)) in self.0.iter_mut().zip(enters.iter().zip(leaves)) {
            *sum = sum
                .minus(columns::digits::<S, G>(G::of(leaves)))
                .plus(columns::digits::<S, G>(G::of(enters)));
        }
    }
}
