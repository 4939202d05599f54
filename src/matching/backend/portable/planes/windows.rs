//! Columns into windows, windows into winners.
//!
//! ```text
//! window x   the complement of its sum, so that the best candidate has the highest number
//! winner x   of all candidates those with the highest bit set, if any; of these those with the next; what is
//!            left in the end are the best, and the lowest bit is the first of them
//! ```

use super::Column;
use super::plane::Plane;
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::memory::slices::chunks;
use crate::matching::memory::winners::{BESIDE, Winner};

/// Planes of a window's sum.
pub(super) const WINDOW: usize = 8;
/// The complement of a window's sums, lowest plane first.
type Window<P> = [P; WINDOW];

/// The most groups that there are: of half-words, 256 candidates.
const MOST_GROUPS: usize = 16;

/// Takes the cost of a winner and that of its second best.
pub(super) type Check<'a> = dyn FnMut(u8, u8) + 'a;

/// The window of a pixel, in groups of candidates.
pub(super) struct Windows<'a, P> {
    groups: &'a mut [Window<P>],
    disparities: usize,
}

impl<'a, P: Plane> Windows<'a, P> {
    /// A window without a column.
    pub(super) fn new(groups: &'a mut [Window<P>], disparities: usize) -> Self {
        groups.fill([P::ALL; WINDOW]);
        Self { groups, disparities }
    }

    /// Moves the window one column on.
    #[inline(never)]
    pub(super) fn slide<S: WindowParameters>(&mut self, enters: &[Column<P>], leaves: &[Column<P>]) {
        for (window, (enters, leaves)) in self.groups.iter_mut().zip(enters.iter().zip(leaves)) {
            slide::<S, P>(window, enters, leaves);
        }
    }

    /// The winners of the pixels from the first that has a candidate, with the columns that enter and leave
    /// at each.
    #[inline(never)]
    pub(super) fn winners<S: WindowParameters, const GROUPS: usize>(
        self,
        entering: &[Column<P>],
        leaving: &[Column<P>],
        winners: &mut [Winner],
        mut check: Option<&mut Check<'_>>,
    ) {
        let of = |candidates: usize| -> [P; GROUPS] {
            core::array::from_fn(|group| P::first(candidates.saturating_sub(group * P::CANDIDATES)))
        };
        let (mut candidates, all) = (of(0), of(self.disparities));
        // In registers, as far as there are some.
        let Some(&(mut windows)) = self.groups.first_chunk::<GROUPS>() else { return };
        let columns = entering.as_chunks::<GROUPS>().0.iter().zip(leaving.as_chunks::<GROUPS>().0);
        for (winner, (enters, leaves)) in winners.iter_mut().zip(columns) {
            let mut one_more = P::one(0);
            let places = windows.iter_mut().zip(enters.iter().zip(leaves));
            for ((window, (enters, leaves)), (candidates, &all)) in
                places.zip(candidates.iter_mut().zip(&all))
            {
                slide::<S, P>(window, enters, leaves);
                let before = *candidates;
                *candidates = (before.doubled() | one_more) & all;
                one_more = before.highest();
            }
            let best = best(&windows, candidates);
            // The first group with one of them.
            let first = best.iter().enumerate().find(|&(_, &best)| best != P::NONE);
            let (group, lane) = first.map_or((0, 0), |(group, best)| (group, best.lowest()));
            let candidates_of = |group: usize| candidates.get(group).copied().unwrap_or(P::NONE);
            *winner = winner_of(&windows, group, lane, candidates_of(group));
            let disparity = group * P::CANDIDATES + lane;
            if GROUPS > 1 {
                let last = lane + 1 == P::CANDIDATES;
                let above = if last { candidates_of(group + 1) } else { candidates_of(group) & !P::one(0) };
                look_beyond(&windows, disparity, above != P::NONE, winner);
            }
            if let Some(check) = &mut check {
                let (windows, candidates) = (windows, candidates);
                check(winner.cost(), best_of_the_rest(&windows, disparity, &candidates));
            }
        }
    }

    /// [`Self::winners`] of any number of groups.
    #[inline(never)]
    pub(super) fn winners_of_many<S: WindowParameters>(
        self,
        entering: &[Column<P>],
        leaving: &[Column<P>],
        winners: &mut [Winner],
        mut check: Option<&mut Check<'_>>,
    ) {
        let groups = self.groups.len();
        let (mut entering, mut leaving) = (chunks(entering, groups), chunks(leaving, groups));
        for (x, winner) in winners.iter_mut().enumerate() {
            let (Some(enters), Some(leaves)) = (entering.next(), leaving.next()) else { return };
            let candidates = self.disparities.min(x + 1);
            let among = |group: usize| P::first(candidates.saturating_sub(group * P::CANDIDATES));
            let mut least = (u32::MAX, 0, 0);
            for (group, (window, (enters, leaves))) in
                self.groups.iter_mut().zip(enters.iter().zip(leaves)).enumerate()
            {
                slide::<S, P>(window, enters, leaves);
                let [best] = best(core::array::from_ref(window), [among(group)]);
                let cost = u32::from(cost_of(window, best));
                if cost < least.0 {
                    least = (cost, group, best.lowest());
                }
            }
            let (_, group, lane) = least;
            *winner = winner_of(self.groups, group, lane, among(group));
            let disparity = group * P::CANDIDATES + lane;
            look_beyond(self.groups, disparity, disparity + 1 < candidates, winner);
            if let Some(check) = &mut check {
                let candidates: [P; MOST_GROUPS] = core::array::from_fn(among);
                check(winner.cost(), best_of_the_rest(self.groups, disparity, &candidates));
            }
        }
    }
}

/// The winner in a lane of a group that has the `candidates`.
#[inline(always)]
fn winner_of<P: Plane>(windows: &[Window<P>], group: usize, lane: usize, candidates: P) -> Winner {
    let Some(window) = windows.get(group) else { return Winner::NONE };
    let costs = three(window, lane.max(1) - 1);
    // The lane above is a candidate too.
    let is_above = candidates.bits() >> (lane % 32) > 1;
    let costs = if lane > 0 && is_above { costs } else { at_an_end(costs, lane, is_above) };
    let [below, cost, above, _] = costs.to_le_bytes();
    Winner::new(cost, (group * P::CANDIDATES + lane) as u8, (below, above))
}

/// The sums around a winner of which the word lacks the candidate below, or that above, or both: of a word's
/// first two or last three.
#[inline(always)]
fn at_an_end(costs: u32, lane: usize, is_above: bool) -> u32 {
    let [first, second, ..] = costs.to_le_bytes();
    let (here, beside) =
        if lane > 0 { (second, first) } else { (first, if is_above { second } else { first }) };
    u32::from_le_bytes([beside, here, beside, 0])
}

/// Takes the cost of a winner's neighbour from the group before or after, if it is there.
#[inline(always)]
fn look_beyond<P: Plane>(windows: &[Window<P>], disparity: usize, is_above: bool, winner: &mut Winner) {
    let lane = disparity % P::CANDIDATES;
    let (below, above) = winner.beside();
    if lane == 0 && disparity > 0 {
        let below = cost(windows, disparity - 1);
        *winner = winner.with_beside((below, if is_above { above } else { below }));
    } else if lane + 1 == P::CANDIDATES && is_above {
        *winner = winner.with_beside((below, cost(windows, disparity + 1)));
    }
}

/// The cost of a candidate.
#[inline(never)]
fn cost<P: Plane>(windows: &[Window<P>], disparity: usize) -> u8 {
    let lane = P::one(disparity % P::CANDIDATES);
    windows.get(disparity / P::CANDIDATES).map_or(0, |window| cost_of(window, lane))
}

/// The least cost of the candidates over [`BESIDE`] px beside the winner; `u8::MAX` where there is none.
#[inline(never)]
fn best_of_the_rest<P: Plane>(windows: &[Window<P>], disparity: usize, candidates: &[P]) -> u8 {
    let mut least = u8::MAX;
    for (group, (window, &candidates)) in windows.iter().zip(candidates).enumerate() {
        let before = |candidate: usize| P::first(candidate.saturating_sub(group * P::CANDIDATES));
        let nearest = before(disparity + BESIDE + 1) & !before(disparity.saturating_sub(BESIDE));
        let others = candidates & !nearest;
        if others != P::NONE {
            let [best] = best(core::array::from_ref(window), [others]);
            least = least.min(cost_of(window, best));
        }
    }
    least
}

/// Moves a group one column on.
#[inline(always)]
fn slide<S: WindowParameters, P: Plane>(window: &mut Window<P>, enters: &Column<P>, leaves: &Column<P>) {
    // The window is a complement: what leaves is added. The difference is a number with a sign, of one plane
    // more.
    let (mut borrow, mut carry) = (P::NONE, P::NONE);
    for (i, sum) in window.iter_mut().enumerate() {
        let digit = i + S::COLUMN_SHIFT;
        let digits = enters.get(digit).zip(leaves.get(digit)).filter(|_| digit < S::COLUMN_BITS);
        let difference = if let Some((&enters, &leaves)) = digits {
            let differ = enters ^ leaves;
            let difference = differ ^ borrow;
            borrow = borrow ^ (differ & (borrow ^ enters));
            difference
        } else {
            borrow
        };
        let half = *sum ^ difference;
        let up = difference ^ (half & (difference ^ carry));
        *sum = half ^ carry;
        carry = up;
    }
}

/// Mask of the candidates that have the least sum.
#[inline(always)]
fn best<P: Plane, const GROUPS: usize>(
    windows: &[Window<P>; GROUPS],
    candidates: [P; GROUPS],
) -> [P; GROUPS] {
    let mut best = candidates;
    for i in (0..WINDOW).rev() {
        let mut better = best;
        for (better, window) in better.iter_mut().zip(windows) {
            *better = *better & window.get(i).copied().unwrap_or(P::NONE);
        }
        if better.iter().fold(P::NONE, |any, &better| any | better) != P::NONE {
            best = better;
        }
    }
    best
}

/// The sum that all of the `candidates` have.
#[inline(always)]
fn cost_of<P: Plane>(window: &Window<P>, candidates: P) -> u8 {
    window.iter().rev().fold(0, |cost, &plane| cost << 1 | u8::from(plane & candidates == P::NONE))
}

/// The sums of three candidates in a word, from the `first` on: a byte for each, the lowest first.
#[inline(always)]
fn three<P: Plane>(window: &Window<P>, first: usize) -> u32 {
    // Two planes at a time, half a sum apart. The product has their bits three times, each time in place for
    // one byte.
    const HALF: usize = WINDOW / 2;
    let [low, high] = window.as_chunks::<HALF>().0 else { return 0 };
    let bits = |plane: &P| plane.bits() >> (first % 32) & 7;
    let mut bytes = 0;
    for (low, high) in low.iter().zip(high).rev() {
        let two = bits(low) | bits(high) << HALF;
        bytes = bytes << 1 | ((two * (1 | 1 << 7 | 1 << 14)) & 0x11_1111);
    }
    // The windows are complements.
    bytes ^ 0xff_ffff
}
