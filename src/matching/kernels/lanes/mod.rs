//! The kernel in vectors. Lanes run over the disparities of one pixel: `N` of them in an array of fixed size, which
//! the compiler keeps in the target's vector registers.
//!
//! A pixel's work, `d` over all lanes:
//!
//! ```text
//! column x + r:  column[d] += hamming(enter.left, enter.right[d]) - hamming(leave.left, leave.right[d])
//! window x:      sum[d]    += column[x + r][d] - column[x - r - 1][d]
//! winner x:      least of sum[d] | mask[d], and the first lane that holds it
//! ```
//!
//! The work is the same for every picture: no branch depends on a pixel.

mod columns;
mod lane;

use super::scratch::bytes_mut;
use super::{Found, OUTSIDE, RowWork, STEP, Select, Winner};
use crate::matching::scheme::Scheme;

pub use lane::Lane;

/// Winners handed on at a time.
const BATCH: usize = 32;

/// [`super::Kernel::row`] for the compilation's own target.
#[inline(always)]
pub(in crate::matching) fn row<S: Scheme>(work: RowWork<'_>, select: Option<Select>, found: Found<'_>) {
    // Knowing the number pays where a group of sums takes several registers.
    let wide = size_of::<S::Sum>() > 1 || !cfg!(stereopsis_vectors);
    match work.stride {
        32 if wide => row_in_groups::<S, STEP, 32>(work, select, found),
        64 if wide => row_in_groups::<S, STEP, 64>(work, select, found),
        _ => row_in_groups::<S, STEP, 0>(work, select, found),
    }
}

/// A row whose lanes are worked on in groups of `N`. `STRIDE` is the number of lanes where it is known when the crate
/// is compiled, which lets the compiler unroll the groups and keep them in registers; 0 where it is not.
#[inline(always)]
pub(in crate::matching) fn row_in_groups<S: Scheme, const N: usize, const STRIDE: usize>(
    work: RowWork<'_>,
    select: Option<Select>,
    found: Found<'_>,
) {
    const { assert!(S::RADIUS_X < OUTSIDE) };
    let RowWork { width, stride, min_disparity, enter, leave, columns, scratch } = work;
    // At least one group, for the compiler to see that no column is empty.
    let stride = if STRIDE > 0 { STRIDE } else { stride.max(STEP) };
    let Some((sums, codes)) = scratch.split_at_mut_checked(stride / 2) else { return };
    let Some(sums) = S::Sum::of_words(sums).get_mut(..stride) else { return };
    let codes = bytes_mut(codes);
    let Some((new, old)) = codes.split_at_mut_checked(codes.len() / 2) else { return };
    let enter = enter.map(|row| columns::reversed(row, min_disparity, width + stride, new));
    let leave = leave.map(|row| columns::reversed(row, min_disparity, width + stride, old));
    // Columns first, then windows: a processor that looks ahead finds more independent work in two short loops than in
    // a long one.
    if let Some(inside) = columns.get_mut(OUTSIDE * stride..) {
        columns::update::<S, N>(width, stride, enter, leave, inside);
    }
    let Some(select) = select else { return };

    for (sum, &start) in sums.iter_mut().zip(S::Sum::INDICES) {
        *sum = if S::Sum::NUMBER_BITS > 0 { start } else { S::Sum::INDICES[0] };
    }
    // Left of here no pixel has a candidate.
    let begin = min_disparity.min(width);
    let mut batch = [Winner::default(); BATCH];
    for first in (0..begin).step_by(BATCH) {
        found(batch.get(..BATCH.min(begin - first)).unwrap_or(&[]));
    }
    // The column that leaves at the first pixel is among them.
    let before = OUTSIDE + begin.saturating_sub(S::RADIUS_X + 1);
    for column in columns.chunks_exact(stride).take(OUTSIDE + begin + S::RADIUS_X).skip(before) {
        slide::<S::Sum, N>(sums, column, columns);
    }
    // At least one, for the compiler to see that it is not zero.
    let size = (BATCH * stride).max(1);
    let from = |column: usize| columns.get(column * stride..).unwrap_or(&[]).chunks(size);
    let columns = from(OUTSIDE + begin + S::RADIUS_X).zip(from(OUTSIDE + begin - S::RADIUS_X - 1));
    for (first, (entering, leaving)) in (begin..width).step_by(BATCH).zip(columns) {
        let batch = batch.get_mut(..BATCH.min(width - first)).unwrap_or_default();
        let columns = entering.chunks_exact(stride).zip(leaving.chunks_exact(stride));
        // The first pixels have fewer candidates than there are lanes. Without a mask is another code of the same size,
        // which is spared where sums are wide and their number is an unusual one.
        if (STRIDE > 0 || size_of::<S::Sum>() == 1) && candidates(first - min_disparity, select) == stride {
            winners::<S, N, false>(first - min_disparity, select, columns, sums, batch);
        } else {
            winners::<S, N, true>(first - min_disparity, select, columns, sums, batch);
        }
        found(batch);
    }
}

/// The winners of pixels, the first of which is `first` right of the smallest disparity, with the columns that enter and
/// leave at each.
#[inline(always)]
fn winners<'a, S: Scheme, const N: usize, const MASKED: bool>(
    first: usize,
    select: Select,
    columns: impl Iterator<Item = (&'a [u8], &'a [u8])>,
    sums: &mut [S::Sum],
    out: &mut [Winner],
) {
    for ((x, slot), (enters, leaves)) in (first..).zip(out).zip(columns) {
        let candidates = if MASKED { candidates(x, select) } else { sums.len() };
        let mask = S::Sum::MASKS.get(256 - candidates.min(256)..).and_then(|m| m.get(..sums.len())).unwrap_or(&[]);
        let (cost, disparity) = slide_to_least::<S::Sum, N, MASKED>(sums, enters, leaves, mask);
        slot.set(cost, disparity as u32, beside::<S::Sum>(cost, disparity, candidates, sums));
        if select.second {
            slot.second = best_of_the_rest::<S::Sum, N>(disparity, mask, sums);
        }
    }
}

/// How many candidates a pixel so far right of the smallest disparity has inside the right image.
#[inline(always)]
fn candidates(x: usize, select: Select) -> usize {
    (x + 1).min(select.disparities)
}

/// Moves the window sums one column on.
#[inline(always)]
fn slide<L: Lane, const N: usize>(sums: &mut [L], enters: &[u8], leaves: &[u8]) {
    let columns = enters.as_chunks::<N>().0.iter().zip(leaves.as_chunks::<N>().0);
    for (sums, (&enters, &leaves)) in sums.as_chunks_mut::<N>().0.iter_mut().zip(columns) {
        let mut group = *sums;
        for i in 0..N {
            group[i] = group[i].moved(enters[i], leaves[i]);
        }
        *sums = group;
    }
}

/// [`slide`], then the least cost and the first candidate that has it.
#[inline(always)]
fn slide_to_least<L: Lane, const N: usize, const MASKED: bool>(
    sums: &mut [L],
    enters: &[u8],
    leaves: &[u8],
    mask: &[L],
) -> (u32, usize) {
    let room = if L::NUMBER_BITS > 0 { 1 << L::NUMBER_BITS } else { 256 };
    let mut best = (u32::MAX, 0);
    let columns = enters.chunks(room).zip(leaves.chunks(room));
    for (n, ((sums, mask), (enters, leaves))) in sums.chunks_mut(room).zip(mask.chunks(room)).zip(columns).enumerate() {
        let mut least = [L::MAX; N];
        let columns = enters.as_chunks::<N>().0.iter().zip(leaves.as_chunks::<N>().0);
        let lanes = sums.as_chunks_mut::<N>().0.iter_mut().zip(mask.as_chunks::<N>().0);
        for ((sums, &mask), (&enters, &leaves)) in lanes.zip(columns) {
            let mut group = *sums;
            for i in 0..N {
                group[i] = group[i].moved(enters[i], leaves[i]);
                least[i] = least[i].min(if MASKED { group[i].or(mask[i]) } else { group[i] });
            }
            *sums = group;
        }
        let least = minimum(&least);
        if L::NUMBER_BITS > 0 {
            if least.cost() < best.0 {
                best = (least.cost(), n * room + least.number() as usize);
            }
        } else {
            best = (least.cost(), first::<L, N, MASKED>(least, sums, mask));
        }
    }
    best
}

/// The first candidate with the least sum, where lanes have no numbers.
#[inline(always)]
fn first<L: Lane, const N: usize, const MASKED: bool>(least: L, sums: &[L], mask: &[L]) -> usize {
    let mut first = [L::MAX; N];
    let lanes = sums.as_chunks::<N>().0.iter().zip(mask.as_chunks::<N>().0);
    for ((&lanes, &mask), &indices) in lanes.zip(L::INDICES.as_chunks::<N>().0) {
        for i in 0..N {
            let lane = if MASKED { lanes[i].or(mask[i]) } else { lanes[i] };
            first[i] = first[i].min(indices[i].or(lane.differs(least)));
        }
    }
    minimum(&first).cost() as usize
}

/// The least of all lanes.
#[inline(always)]
fn minimum<L: Lane, const N: usize>(lanes: &[L; N]) -> L {
    lanes.iter().fold(L::MAX, |least, &lane| least.min(lane))
}

/// The costs beside the winner.
#[inline(always)]
fn beside<L: Lane>(cost: u32, disparity: usize, candidates: usize, sums: &[L]) -> (u32, u32) {
    let at = |candidate: usize| sums.get(candidate).map_or(0, |sum| sum.cost());
    if disparity > 0 && disparity + 1 < candidates {
        (at(disparity - 1), at(disparity + 1))
    } else {
        beside_at_the_end(disparity, candidates, at, cost)
    }
}

/// The costs beside a winner that lacks a candidate on one side or both, for [`Winner::set`].
#[inline(never)]
fn beside_at_the_end(disparity: usize, candidates: usize, cost: impl Fn(usize) -> u32, least: u32) -> (u32, u32) {
    let one = if disparity > 0 {
        cost(disparity - 1)
    } else if candidates > 1 {
        cost(1)
    } else {
        least
    };
    (one, one)
}

/// The least cost of the candidates over one px beside the winner; `u32::MAX` where there is none.
#[cfg_attr(stereopsis_vectors, inline(never))]
#[cfg_attr(not(stereopsis_vectors), inline(always))]
fn best_of_the_rest<L: Lane, const N: usize>(disparity: usize, mask: &[L], sums: &mut [L]) -> u32 {
    // The winner and those beside it are raised while the others are looked at.
    let first = disparity.saturating_sub(1);
    let nearest = first..sums.len().min(disparity + 2);
    let mut kept = [L::MAX; 3];
    for (kept, sum) in kept.iter_mut().zip(sums.get_mut(nearest.clone()).unwrap_or_default()) {
        *kept = core::mem::replace(sum, L::MAX);
    }
    let mut least = [L::MAX; N];
    for (&lanes, &mask) in sums.as_chunks::<N>().0.iter().zip(mask.as_chunks::<N>().0) {
        for i in 0..N {
            least[i] = least[i].min(lanes[i].or(mask[i]));
        }
    }
    for (kept, sum) in kept.iter().zip(sums.get_mut(nearest).unwrap_or_default()) {
        *sum = *kept;
    }
    let least = minimum(&least);
    if least < L::MAX { least.cost() } else { u32::MAX }
}
