//! The kernel in bit planes, for cores without vectors: 32 candidates are the bits of a word, and a number of each of them
//! is as many words as it has bits. Additions are chains of full adders, bit by bit; comparisons go from the highest plane
//! down. Safe Rust; the arithmetic is that of plain words.
//!
//! ```text
//! right codes    one word for each bit of the code: bit d is that of the column d to the left
//! column x + r   += bits in which the entering codes differ, and those in which the leaving ones are equal; the number of
//!                bits is taken off again
//! window x       the complement of the sum, so that the best candidate has the highest number
//! winner x       of all candidates those with the highest bit set, if any, of these those with the next: what is left
//!                are the best, and the lowest bit is the first of them
//! ```
//!
//! The work is the same for every picture, but for an instruction or two.

use super::plane::{Plane, add_pair, of_bit, two_bits};
use super::{OUTSIDE, RowCodes, RowWork, Select, Winner};
use crate::matching::scheme::Scheme;
use core::cell::Cell;
use core::sync::atomic::{Ordering, compiler_fence};

/// Winners handed on at a time.
const BATCH: usize = 16;

/// Planes of a column's sums: a place for each eighth of its bytes.
const COLUMN: usize = 8;
/// Bits from one of three sums in a word to the next.
const FIELD: u32 = 11;
/// The most groups that there are: of half-words, 256 candidates.
const MOST_GROUPS: usize = 16;
/// One of three sums in a word.
const COST: u32 = (1 << WINDOW) - 1;
/// Planes of a window's sum.
const WINDOW: usize = 10;

/// [`super::Kernel::row`] in planes.
#[inline(always)]
pub(in crate::matching) fn row<S: Scheme>(work: RowWork<'_>, select: Option<Select>, found: impl FnMut(&[Winner])) {
    // Where a half-word of candidates is left over, half-words are taken.
    if work.stride == 32 {
        row_of::<S, u32, 1>(work, select, found);
    } else if work.stride == 64 {
        row_of::<S, u32, 2>(work, select, found);
    } else if work.stride.is_multiple_of(32) {
        row_of::<S, u32, 0>(work, select, found);
    } else {
        row_of::<S, u16, 0>(work, select, found);
    }
}

type Column<P> = [P; COLUMN];
type Window<P> = [P; WINDOW];

#[inline(always)]
fn row_of<S: Scheme, P: Plane, const GROUPS: usize>(work: RowWork<'_>, select: Option<Select>, mut found: impl FnMut(&[Winner])) {
    let RowWork { width, stride, min_disparity, enter, leave, columns, scratch } = work;
    // At least one, for the compiler to see that no column is empty.
    let groups = if GROUPS > 0 { GROUPS } else { (stride / P::CANDIDATES).max(1) };
    let columns = P::of_bytes(columns).as_chunks_mut::<COLUMN>().0;
    let scratch = P::of_words(scratch);
    if let Some(inside) = columns.get_mut(OUTSIDE * groups..) {
        update_columns::<S, P, GROUPS>(width, groups, min_disparity, [enter, leave], scratch, inside);
    }
    let Some(select) = select else { return };

    let Some(windows) = scratch.as_chunks_mut::<WINDOW>().0.get_mut(..groups) else { return };
    windows.fill([P::ALL; WINDOW]);
    // Left of here no pixel has a candidate.
    let begin = select.min_disparity.min(width);
    let mut batch = [Winner::default(); BATCH];
    for first in (0..begin).step_by(BATCH) {
        found(batch.get(..BATCH.min(begin - first)).unwrap_or(&[]));
    }
    for column in columns.chunks_exact(groups).take(OUTSIDE + begin + S::RADIUS_X).skip(OUTSIDE + begin.saturating_sub(S::RADIUS_X)) {
        slide::<S, P>(windows, column, columns);
    }
    let from = |column: usize| columns.get((OUTSIDE + begin + column) * groups..).unwrap_or(&[]).chunks(BATCH * groups);
    let (entering, leaving) = (from(S::RADIUS_X), from(0usize.wrapping_sub(S::RADIUS_X + 1)));
    let mut windows = Windows { windows, groups, candidates: 0, second: select.second };
    for (first, (entering, leaving)) in (begin..width).step_by(BATCH).zip(entering.zip(leaving)) {
        let batch = batch.get_mut(..BATCH.min(width - first)).unwrap_or_default();
        if GROUPS > 0 {
            windows.winners::<S, GROUPS>(entering, leaving, select.disparities, batch);
        } else {
            windows.winners_of_many::<S>(entering, leaving, select.disparities, batch);
        }
        found(batch);
    }
}

/// The windows of one pixel, for all groups of candidates.
struct Windows<'a, P> {
    windows: &'a mut [Window<P>],
    groups: usize,
    /// How many candidates the pixel before has inside the right image.
    candidates: usize,
    /// Whether second bests are wanted.
    second: bool,
}

impl<P: Plane> Windows<'_, P> {
    /// The winners of the next pixels among so many `disparities`, with the columns that enter and leave at each.
    #[inline(never)]
    fn winners<S: Scheme, const GROUPS: usize>(
        &mut self,
        entering: &[Column<P>],
        leaving: &[Column<P>],
        disparities: usize,
        out: &mut [Winner],
    ) {
        let of = |candidates: usize| -> [P; GROUPS] {
            core::array::from_fn(|group| P::first(candidates.saturating_sub(group * P::CANDIDATES)))
        };
        let (mut candidates, all) = (of(self.candidates), of(disparities));
        // In registers, as far as there are some.
        let Some(kept) = self.windows.first_chunk_mut::<GROUPS>() else { return };
        let mut windows = *kept;
        let columns = entering.as_chunks::<GROUPS>().0.iter().zip(leaving.as_chunks::<GROUPS>().0);
        for (slot, (enters, leaves)) in out.iter_mut().zip(columns) {
            let mut one_more = P::one(0);
            for group in 0..GROUPS {
                slide_one::<S, P>(&mut windows[group], &enters[group], &leaves[group]);
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
            if self.second {
                let windows = windows;
                slot.second = best_of_the_rest::<S, P>(&windows, disparity, &candidates);
            }
        }
        *kept = windows;
        self.candidates = disparities.min(self.candidates + out.len());
    }

    /// [`Self::winners`] among any number of candidates.
    #[inline(never)]
    fn winners_of_many<S: Scheme>(
        &mut self,
        entering: &[Column<P>],
        leaving: &[Column<P>],
        disparities: usize,
        out: &mut [Winner],
    ) {
        let groups = self.groups.max(1);
        for (slot, (enters, leaves)) in out.iter_mut().zip(entering.chunks_exact(groups).zip(leaving.chunks_exact(groups))) {
            self.candidates = disparities.min(self.candidates + 1);
            let among = |group: usize| P::first(self.candidates.saturating_sub(group * P::CANDIDATES));
            let mut least = (u32::MAX, 0, 0);
            for (group, (window, (enters, leaves))) in self.windows.iter_mut().zip(enters.iter().zip(leaves)).enumerate() {
                slide_one::<S, P>(window, enters, leaves);
                let [best] = best::<S, P, 1>(core::array::from_ref(window), [among(group)]);
                let cost = cost_of::<S, P>(window, best);
                if cost < least.0 {
                    least = (cost, group, best.lowest());
                }
            }
            let (_, group, lane) = least;
            winner::<S, P>(self.windows, group, lane, among(group), slot);
            let disparity = group * P::CANDIDATES + lane;
            look_beyond::<S, P>(self.windows, disparity, disparity + 1 < self.candidates, slot);
            if self.second {
                let candidates: [P; MOST_GROUPS] = core::array::from_fn(among);
                slot.second = best_of_the_rest::<S, P>(self.windows, disparity, &candidates);
            }
        }
    }
}

/// The winner in a lane of a group that has the `candidates`.
#[inline(always)]
fn winner<S: Scheme, P: Plane>(windows: &[Window<P>], group: usize, lane: usize, candidates: P, out: &mut Winner) {
    let Some(window) = windows.get(group) else { return };
    let costs = three::<S, P>(window, lane.max(1) - 1);
    let disparity = (group * P::CANDIDATES + lane) as u32;
    let is_above = candidates.bits() >> (lane % 32) > 1;
    if lane > 0 && is_above {
        out.set(costs >> FIELD & COST, disparity, (costs & COST, costs >> (2 * FIELD)));
    } else {
        winner_at_an_end(costs, disparity, lane, is_above, out);
    }
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

/// A winner of which the word lacks the candidate below, or that above, or both.
#[inline(never)]
fn winner_at_an_end(costs: u32, disparity: u32, lane: usize, is_above: bool, out: &mut Winner) {
    let [first, second] = [costs & COST, costs >> FIELD & COST];
    let (here, beside) = if lane > 0 { (second, first) } else { (first, if is_above { second } else { first }) };
    out.set(here, disparity, (beside, beside));
}

/// Moves windows one column on.
#[inline(never)]
fn slide<S: Scheme, P: Plane>(windows: &mut [Window<P>], enters: &[Column<P>], leaves: &[Column<P>]) {
    for (window, (enters, leaves)) in windows.iter_mut().zip(enters.iter().zip(leaves)) {
        slide_one::<S, P>(window, enters, leaves);
    }
}

#[inline(always)]
fn slide_one<S: Scheme, P: Plane>(window: &mut Window<P>, enters: &Column<P>, leaves: &Column<P>) {
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
fn best<S: Scheme, P: Plane, const GROUPS: usize>(windows: &[Window<P>; GROUPS], candidates: [P; GROUPS]) -> [P; GROUPS] {
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
    let lowest = (1 | 1 << half) * (1 | 1 << FIELD | 1 << (2 * FIELD));
    let mut fields = 0;
    for i in (0..half).rev() {
        let bits = |i: usize| window[i].bits() >> (first % 32) & 7;
        let two = bits(i) | bits(i + half) << half;
        fields = fields << 1 | (two * (1 | 1 << (FIELD - 1) | 1 << (2 * FIELD - 2)) & lowest);
    }
    // The windows are complements.
    let sum = (1 << S::WINDOW_BITS) - 1;
    fields ^ (sum | sum << FIELD | sum << (2 * FIELD))
}

/// Where the bits of the row that enters begin in a column's word, and those of the row that leaves: two for each bit of
/// the code, as [`prepare`] leaves them.
const NEW: usize = 0;
const OLD: usize = 16;

/// Makes of the codes of a row what the columns are moved with: for each bit whether it is another one than in the column
/// before, and whether it is another one than in the partner of the first candidate. The two stand side by side, those of
/// the code's first four bits in place of the left code, the others in place of the right one.
#[inline(never)]
pub(in crate::matching) fn prepare<'a>(left: &'a mut [u8], right: &'a mut [u8], min_disparity: usize, begin: usize) {
    let first = right.first().copied().unwrap_or(0);
    let left = Cell::from_mut(left).as_slice_of_cells();
    let right = Cell::from_mut(right).as_slice_of_cells();
    let from = |codes: &'a [Cell<u8>], x: usize| codes.get(x..).unwrap_or(&[]);
    let put = |left: &Cell<u8>, right: &Cell<u8>, partner: u8, before: u8| {
        let pairs = interleaved(left.get() ^ partner, left.get() ^ before);
        let [low, high, ..] = pairs.to_le_bytes();
        left.set(low);
        right.set(high);
    };
    // From the last column on: what stands left of a column is still a code when it is needed.
    let columns = |x: usize| from(left, x).iter().zip(from(right, x)).zip(from(left, x.wrapping_sub(1)));
    let inside = min_disparity.max(begin + 1);
    for (((left, right), before), partner) in columns(inside).zip(from(right, inside - min_disparity)).rev() {
        put(left, right, partner.get(), before.get());
    }
    for ((left, right), before) in columns(begin + 1).take(inside - begin - 1).rev() {
        put(left, right, first, before.get());
    }
    if let (Some(left), Some(right)) = (left.get(begin), right.get(begin)) {
        put(left, right, first, left.get());
    }
}

/// The bits of the first byte at the even places of a half-word, those of the second at the odd ones.
#[inline(always)]
fn interleaved(even: u8, odd: u8) -> u32 {
    let mut bytes = u32::from(even) | u32::from(odd) << 16;
    for (by, mask) in [(4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)] {
        bytes = (bytes | bytes << by) & mask;
    }
    bytes | bytes >> 15
}

/// The first column that a window with a candidate has.
pub(in crate::matching) fn first_column<S: Scheme>(min_disparity: usize) -> usize {
    min_disparity.saturating_sub(S::RADIUS_X)
}

/// Moves the sums of all columns one row down.
#[inline(never)]
fn update_columns<'a, S: Scheme, P: Plane, const GROUPS: usize>(
    width: usize,
    groups: usize,
    min_disparity: usize,
    [enter, leave]: [Option<RowCodes<'a>>; 2],
    room: &mut [P],
    columns: &mut [Column<P>],
) {
    // A row that is not there has no bit that is another one. Of the row that leaves the bits that are equal are counted.
    let Some(any) = enter.or(leave) else { return };
    let present = if enter.is_some() { 0xffff } else { 0 } | if leave.is_some() { 0xffff_0000 } else { 0 };
    let (enter, leave) = (enter.unwrap_or(any), leave.unwrap_or(any));
    // In a box: the compiler otherwise takes the bits apart again.
    let equal = core::hint::black_box(0x5555_0000);
    let codes = |bytes: [u8; 4]| u32::from_le_bytes(bytes) & present ^ equal;

    let begin = first_column::<S>(min_disparity);
    let row = |row: RowCodes<'a>| (row.left.get(begin..width).unwrap_or(&[]), row.right.get(begin..width).unwrap_or(&[]));
    let (new, old) = (row(enter), row(leave));
    let all = || new.0.iter().zip(new.1).zip(old.0.iter().zip(old.1)).map(|((&a, &b), (&c, &d))| codes([a, b, c, d]));
    let Some(first) = all().next() else { return };
    let Some(words) = room.as_chunks_mut::<2>().0.as_chunks_mut::<8>().0.get_mut(..groups) else { return };
    // The first column has one partner for all candidates.
    let start = core::array::from_fn(|i| [of_bit(first, NEW + 2 * i), of_bit(first, OLD + 2 * i)]);
    words.fill(start);
    // One group's words are in registers, as far as there are some.
    let mut here = start.map(|words| words.map(P::doubled));
    let columns = columns.get_mut(begin * groups..).unwrap_or_default().chunks_exact_mut(groups);
    for (column, codes) in columns.zip(all()) {
        if GROUPS == 1 {
            let Some(sums) = column.first_mut() else { return };
            update::<S, P>(sums, &mut here, |i, doubled| {
                let word = *doubled ^ two_bits::<P>(codes, i);
                *doubled = word.doubled();
                word
            });
            continue;
        }
        // From the last group on, each takes over the last bit of the one before.
        let mut groups = words.iter_mut().zip(column).rev().peekable();
        while let Some((words, sums)) = groups.next() {
            if let Some((before, _)) = groups.peek() {
                update::<S, P>(sums, words, |i, word| {
                    let before = before[i % 16 / 2][i / 16];
                    *word = (word.doubled() | before.highest()) ^ of_bit(codes, i + 1);
                    *word
                });
            } else {
                update::<S, P>(sums, words, |i, word| {
                    *word = word.doubled() ^ two_bits::<P>(codes, i);
                    *word
                });
            }
        }
    }
}

/// Moves the words of both rows one column on and counts them into the sums. `moved` gets a word's place among [`NEW`] and
/// [`OLD`].
#[inline(always)]
fn update<S: Scheme, P: Plane>(sums: &mut Column<P>, words: &mut [[P; 2]; 8], moved: impl Fn(usize, &mut P) -> P) {
    let mut here = *sums;
    count_into::<S, P>(&mut here, |i| {
        let [new, old] = &mut words[i];
        (moved(NEW + 2 * i, new), moved(OLD + 2 * i, old))
    });
    for i in 0..S::COLUMN_BITS {
        sums[i] = here[i];
    }
}

/// Adds `2 BITS` bits for every candidate, two by two, and takes `BITS` off.
#[inline(always)]
fn count_into<S: Scheme, P: Plane>(sums: &mut Column<P>, mut bits: impl FnMut(usize) -> (P, P)) {
    let levels = S::BITS.ilog2() as usize;
    // Carries that wait for another of their weight.
    let mut waiting = [P::NONE; 4];
    for i in 0..S::BITS {
        // Half of it at a time: the compiler for ARM otherwise keeps all bits for later, in more than its registers.
        if cfg!(target_arch = "arm") && i == S::BITS / 2 {
            compiler_fence(Ordering::SeqCst);
        }
        let mut pair = bits(i);
        for level in 0..levels {
            let carry = add_pair(&mut sums[level], pair.0, pair.1);
            if i >> level & 1 == 0 {
                waiting[level] = carry;
                break;
            }
            pair = (waiting[level], carry);
        }
        if i + 1 == S::BITS {
            // The two carries left, and one taken off.
            let mut over = add_pair(&mut sums[levels], pair.0, pair.1);
            let digit = sums[levels];
            sums[levels] = !digit;
            let below = !(over | digit);
            over = !(over ^ digit);
            for (n, sum) in sums.iter_mut().enumerate().take(S::COLUMN_BITS).skip(levels + 1) {
                let before = *sum;
                if n == levels + 1 {
                    *sum = before ^ over;
                    over = before & over;
                } else {
                    let half = before ^ below;
                    *sum = half ^ over;
                    over = below ^ (half & (below ^ over));
                }
            }
        }
    }
}
