//! The path from the right, from column to column to the left, and the winners.

use super::{Path, Steps, mask};
use crate::matching::backend::portable::group::Group;
use crate::matching::memory::winners::{Found, Unique, beside};

/// The path on its way.
pub(super) struct Decide<G: Group, const CELLS: usize, const ALL: bool> {
    left: Path<G, CELLS, ALL>,
    /// The brightness of the column after, if there is one.
    after: Option<u8>,
}

impl<G: Group, const CELLS: usize, const ALL: bool> Decide<G, CELLS, ALL> {
    /// Before the last column, whose costs these are.
    #[inline(always)]
    pub(super) fn new(last: &[G::Cell]) -> Self {
        Self { left: Path::of(last), after: None }
    }

    /// Goes on to the next column, which has this brightness and these costs.
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
        steps.close(&mut self.left);
        self.left
    }
}

/// What is asked of the sums of three paths.
pub(super) struct Judge<'a, P> {
    pub stride: usize,
    pub disparities: usize,
    pub min_disparity: usize,
    pub unique: Unique<'a>,
    pub put: P,
}

impl<P: FnMut(usize, Found)> Judge<'_, P> {
    /// Selects the winner of a pixel, which has a candidate, by the sums of its paths.
    #[inline(always)]
    pub(super) fn decide<G: Group, const CELLS: usize, const ALL: bool>(
        &mut self,
        x: usize,
        mut total: Path<G, CELLS, ALL>,
    ) {
        self.decide_of(x, &mut total);
    }

    /// Decides as [`Self::decide`] does, with sums that may be overwritten.
    #[inline(always)]
    pub(super) fn decide_of<G: Group, const CELLS: usize, const ALL: bool>(
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
        unique.judge(
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
