//! The path from the right, from column to column to the left, and the winners.

use super::{Path, Steps, mask};
use crate::matching::backend::portable::group::Group;
use crate::matching::memory::winners::{Found, Unique, beside};

/// The path from the right, at a column.
pub(super) struct LeftwardPath<G: Group, const CELLS: usize, const ALL: bool> {
    left: Path<G, CELLS, ALL>,
    /// The brightness of the column after, if there is one.
    after: Option<u8>,
}

impl<G: Group, const CELLS: usize, const ALL: bool> LeftwardPath<G, CELLS, ALL> {
    /// Before the last column, whose costs these are.
    #[inline(always)]
    pub(super) fn new(last: &[G::Cell]) -> Self {
        Self { left: Path::of(last), after: None }
    }

    /// Advances the path by one column, which has this brightness and these costs, and returns its aggregated
    /// costs.
    #[inline(always)]
    pub(super) fn next(
        &mut self,
        steps: &Steps<G, CELLS, ALL>,
        here: u8,
        costs: &[G::Cell],
    ) -> Path<G, CELLS, ALL> {
        if let Some(after) = self.after {
            self.left = self.left.step(steps, steps.between(here, after), costs);
        }
        self.after = Some(here);
        self.left
    }
}

/// Selects winners by the sums of three paths.
pub(super) struct Selection<'a, P> {
    pub stride: usize,
    pub disparities: usize,
    pub min_disparity: usize,
    pub unique: Unique<'a>,
    pub put: P,
}

impl<P: FnMut(usize, Found)> Selection<'_, P> {
    /// Selects the winner of a pixel, which has a candidate, by the sums of its paths.
    #[inline(always)]
    pub(super) fn select<G: Group, const CELLS: usize, const ALL: bool>(
        &mut self,
        x: usize,
        mut total: Path<G, CELLS, ALL>,
    ) {
        self.select_in_place(x, &mut total);
    }

    /// Selects as [`Self::select`] does, with sums that may be overwritten.
    #[inline(always)]
    pub(super) fn select_in_place<G: Group, const CELLS: usize, const ALL: bool>(
        &mut self,
        x: usize,
        total: &mut Path<G, CELLS, ALL>,
    ) {
        let Self { stride, disparities, min_disparity, ref mut unique, ref mut put } = *self;
        // The first pixels have fewer candidates than there are lanes.
        let candidates = disparities.min(x + 1 - min_disparity);
        if candidates < stride {
            for (total, &mask) in total.0.iter_mut().zip(G::groups(mask(stride, candidates))) {
                *total = total.or(G::of_bytes(mask));
            }
        }
        let count = stride / G::LANES;
        let (cost, lane) = G::last_least(total.cells(count));
        let disparity = (stride - 1).wrapping_sub(lane);
        let beside = beside(stride, disparity as u8, candidates, |lane| G::lane(&total.0, lane));
        put(x, Found { disparity: disparity as u8, cost, beside });
        unique.check(
            x,
            cost,
            #[inline(always)]
            || {
                G::raise_around(&mut total.0, lane);
                G::last_least(total.cells(count)).0
            },
        );
    }
}
