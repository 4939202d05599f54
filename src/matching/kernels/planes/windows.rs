//! Columns into windows, windows into winners.
//!
//! ```text
//! window x   the complement of its sum, so that the best candidate has the highest number
//! winner x   of all candidates those with the highest bit set, if any; of these those with the next; what is left in the
//!            end are the best, and the lowest bit is the first of them
//! ```

use super::Column;
use super::plane::Plane;
use crate::matching::kernels::{Select, Winner};
use crate::matching::scheme::Scheme;

/// Planes of a window's sum.
pub(super) const WINDOW: usize = 10;
/// The complement of a window's sums, lowest plane first.
type Window<P> = [P; WINDOW];

/// Bits from one of three sums in a word to the next.
const FIELD: u32 = 11;
/// One of three sums in a word.
const COST: u32 = (1 << WINDOW) - 1;
/// The most groups that there are: of half-words, 256 candidates.
const MOST_GROUPS: usize = 16;

/// The window of a pixel, in groups of candidates.
pub(super) struct Windows<'a, P> {
    groups: &'a mut [Window<P>],
    /// How many candidates the pixel before has inside the right image.
    candidates: usize,
    select: Select,
}

impl<'a, P: Plane> Windows<'a, P> {
    /// A window without a column.
    pub(super) fn new(groups: &'a mut [Window<P>], select: Select) -> Self {
        groups.fill([P::ALL; WINDOW]);
        Self { groups, candidates: 0, select }
    }

    /// Moves the window one column on.
    #[inline(never)]
    pub(super) fn slide<S: Scheme>(&mut self, enters: &[Column<P>], leaves: &[Column<P>]) {
        for (window, (enters, leaves)) in self.groups.iter_mut().zip(enters.iter().zip(leaves)) {
            slide::<S, P>(window, enters, leaves);
        }
    }

    /// The winners of the next pixels, with the columns that enter and leave at each.
    #[inline(never)]
    pub(super) fn winners<S: Scheme, const GROUPS: usize>(
        &mut self,
        entering: &[Column<P>],
        leaving: &[Column<P>],
        out: &mut [Winner],
    ) {
        let of = |candidates: usize| -> [P; GROUPS] {
            core::array::from_fn(|group| P::first(candidates.saturating_sub(group * P::CANDIDATES)))
        };
        let (mut candidates, all) = (of(self.candidates), of(self.select.disparities));
        // In registers, as far as there are some.
        let Some(kept) = self.groups.first_chunk_mut::<GROUPS>() else { return };
        let mut windows = *kept;
        let columns = entering.as_chunks::<GROUPS>().0.iter().zip(leaving.as_chunks::<GROUPS>().0);
        for (slot, (enters, leaves)) in out.iter_mut().zip(columns) {
            let mut one_more = P::one(0);
            for group in 0..GROUPS {
                slide::<S, P>(&mut windows[group], &enters[group], &leaves[group]);
                let before = candidates[group];
                candidates[group] = (before.doubled() | one_more) & all[group];
                one_more = before.highest();
            }
            let best = best::<S, P, GROUPS>(&windows, candidates);
            // The first group with one of them.
            let group = best.iter().position(|&best| best != P::NONE).unwrap_or(0);
            let lane = best[group].lowest();
            winner::<S, P>(&windows, group, lane, candidates[group], slot);
            let disparity = group * P::CANDIDATES + lane;
            if GROUPS > 1 {
                let last = lane + 1 == P::CANDIDATES;
                let above = if last { candidates[(group + 1) % GROUPS] } else { candidates[group] & !P::one(0) };
                let is_above = above != P::NONE && (!last || group + 1 < GROUPS);
                look_beyond::<S, P>(&windows, disparity, is_above, slot);
            }
            if self.select.second {
                let windows = windows;
                slot.second = best_of_the_rest::<S, P>(&windows, disparity, &candidates);
            }
        }
        *kept = windows;
        self.candidates = self.select.disparities.min(self.candidates + out.len());
    }

    /// [`Self::winners`] of any number of groups.
    #[inline(never)]
    pub(super) fn winners_of_many<S: Scheme>(
        &mut self,
        entering: &[Column<P>],
        leaving: &[Column<P>],
        out: &mut [Winner],
    ) {
        let groups = self.groups.len().max(1);
        let (mut entering, mut leaving) = (entering.chunks_exact(groups), leaving.chunks_exact(groups));
        for slot in out {
            let (Some(enters), Some(leaves)) = (entering.next(), leaving.next()) else { return };
            self.candidates = self.select.disparities.min(self.candidates + 1);
            let among = |group: usize| P::first(self.candidates.saturating_sub(group * P::CANDIDATES));
            let mut least = (u32::MAX, 0, 0);
            for (group, (window, (enters, leaves))) in self.groups.iter_mut().zip(enters.iter().zip(leaves)).enumerate()
            {
                slide::<S, P>(window, enters, leaves);
                let [best] = best::<S, P, 1>(core::array::from_ref(window), [among(group)]);
                let cost = cost_of::<S, P>(window, best);
                if cost < least.0 {
                    least = (cost, group, best.lowest());
                }
            }
            let (_, group, lane) = least;
            winner::<S, P>(self.groups, group, lane, among(group), slot);
            let disparity = group * P::CANDIDATES + lane;
            look_beyond::<S, P>(self.groups, disparity, disparity + 1 < self.candidates, slot);
            if self.select.second {
                let candidates: [P; MOST_GROUPS] = core::array::from_fn(among);
                slot.second = best_of_the_rest::<S, P>(self.groups, disparity, &candidates);
            }
        }
    }
}

/// The winner in a lane of a group that has the `candidates`.
#[inline(always)]
fn winner<S: Scheme, P: Plane>(windows: &[Window<P>], group: usize, lane: usize, candidates: P, out: &mut Winner) {
    let Some(window) = windows.get(group) else { return };
    let costs = three::<S, P>(window, lane.max(1) - 1);
    // The lane above is a candidate too.
    let is_above = candidates.bits() >> (lane % 32) > 1;
    let costs = if lane > 0 && is_above { costs } else { at_an_end(costs, lane, is_above) };
    let disparity = (group * P::CANDIDATES + lane) as u32;
    out.set(costs >> FIELD & COST, disparity, (costs & COST, costs >> (2 * FIELD)));
}

/// The sums around a winner of which the word lacks the candidate below, or that above, or both: of a word's first two or
/// last three.
#[inline(always)]
fn at_an_end(costs: u32, lane: usize, is_above: bool) -> u32 {
    let [first, second] = [costs & COST, costs >> FIELD & COST];
    let (here, beside) = if lane > 0 { (second, first) } else { (first, if is_above { second } else { first }) };
    beside | here << FIELD | beside << (2 * FIELD)
}

/// Takes the cost of a winner's neighbour from the group before or after, if it is there.
#[inline(always)]
fn look_beyond<S: Scheme, P: Plane>(windows: &[Window<P>], disparity: usize, is_above: bool, winner: &mut Winner) {
    let lane = disparity % P::CANDIDATES;
    if lane == 0 && disparity > 0 {
        let below = cost::<S, P>(windows, disparity - 1);
        winner.set(winner.cost(), disparity as u32, (below, if is_above { winner.beside >> 16 } else { below }));
    } else if lane + 1 == P::CANDIDATES && is_above {
        let above = cost::<S, P>(windows, disparity + 1);
        winner.set(winner.cost(), disparity as u32, (winner.beside & 0xffff, above));
    }
}

/// The cost of a candidate.
#[inline(never)]
fn cost<S: Scheme, P: Plane>(windows: &[Window<P>], disparity: usize) -> u32 {
    let lane = P::one(disparity % P::CANDIDATES);
    windows.get(disparity / P::CANDIDATES).map_or(0, |window| cost_of::<S, P>(window, lane))
}

/// The least cost of the candidates over one px beside the winner; `u32::MAX` where there is none.
#[inline(never)]
fn best_of_the_rest<S: Scheme, P: Plane>(windows: &[Window<P>], disparity: usize, candidates: &[P]) -> u32 {
    let mut least = u32::MAX;
    for (group, (window, &candidates)) in windows.iter().zip(candidates).enumerate() {
        let before = |candidate: usize| P::first(candidate.saturating_sub(group * P::CANDIDATES));
        let nearest = before(disparity + 2) & !before(disparity.saturating_sub(1));
        let others = candidates & !nearest;
        if others != P::NONE {
            let [best] = best::<S, P, 1>(core::array::from_ref(window), [others]);
            least = least.min(cost_of::<S, P>(window, best));
        }
    }
    least
}

/// Moves a group one column on.
#[inline(always)]
fn slide<S: Scheme, P: Plane>(window: &mut Window<P>, enters: &Column<P>, leaves: &Column<P>) {
    // The window is a complement: what leaves is added. The difference is a number with a sign, of one plane more.
    let (mut borrow, mut carry) = (P::NONE, P::NONE);
    for i in 0..S::WINDOW_BITS {
        let difference = if i < S::COLUMN_BITS {
            let (enters, leaves) = (enters[i], leaves[i]);
            let differ = enters ^ leaves;
            let difference = differ ^ borrow;
            borrow = borrow ^ (differ & (borrow ^ enters));
            difference
        } else {
            borrow
        };
        let half = window[i] ^ difference;
        let up = difference ^ (half & (difference ^ carry));
        window[i] = half ^ carry;
        carry = up;
    }
}

/// Those of the `candidates` that have the least sum.
#[inline(always)]
fn best<S: Scheme, P: Plane, const GROUPS: usize>(
    windows: &[Window<P>; GROUPS],
    candidates: [P; GROUPS],
) -> [P; GROUPS] {
    let mut best = candidates;
    for i in (0..S::WINDOW_BITS).rev() {
        let better: [P; GROUPS] = core::array::from_fn(|group| best[group] & windows[group][i]);
        if better.iter().fold(P::NONE, |any, &better| any | better) != P::NONE {
            best = better;
        }
    }
    best
}

/// The sum that all of the `candidates` have.
#[inline(always)]
fn cost_of<S: Scheme, P: Plane>(window: &Window<P>, candidates: P) -> u32 {
    let mut cost = 0;
    for i in (0..S::WINDOW_BITS).rev() {
        cost = cost << 1 | u32::from(window[i] & candidates == P::NONE);
    }
    cost
}

/// The sums of three candidates in a word, from the `first` on: a field for each.
#[inline(always)]
fn three<S: Scheme, P: Plane>(window: &Window<P>, first: usize) -> u32 {
    const { assert!(S::WINDOW_BITS < FIELD as usize && S::WINDOW_BITS.is_multiple_of(2)) };
    // Two planes at a time, half a sum apart. The product has their bits three times, each time in place for one field.
    let half = S::WINDOW_BITS / 2;
    let apart = 1 | 1 << (FIELD - 1) | 1 << (2 * FIELD - 2);
    let lowest = (1 | 1 << half) * (1 | 1 << FIELD | 1 << (2 * FIELD));
    let mut fields = 0;
    for i in (0..half).rev() {
        let bits = |i: usize| window[i].bits() >> (first % 32) & 7;
        let two = bits(i) | bits(i + half) << half;
        fields = fields << 1 | ((two * apart) & lowest);
    }
    // The windows are complements.
    let sum = (1 << S::WINDOW_BITS) - 1;
    fields ^ (sum | sum << FIELD | sum << (2 * FIELD))
}
