//! The kernel in vectors. Lanes run over the disparities of one pixel, `N` of them in an array of fixed size,
//! which the compiler keeps in the target's vector registers. The largest disparity has the first lane: so a
//! pixel's candidates stand in memory as they do in the right image.
//!
//! A pixel's work, `d` over all lanes:
//!
//! ```text
//! column x + r:  column[d] += hamming(enter.left, enter.right[d]) - hamming(leave.left, leave.right[d])
//! window x:      sum[d]    += digits(column[x + r][d]) - digits(column[x - r - 1][d])
//! winner x:      least of sum[d] | mask[d], and the last lane that holds it
//! ```
//!
//! The work is the same for every picture, but for a few instructions where a winner is at an end of the
//! search.

mod columns;

use super::helium;
use super::row_codes::with_more_before;
use super::scratch::bytes_mut;
use super::winner::Found;
use super::{BESIDE, MASKS, OUTSIDE, RowWork, STEP, Select, WinnerRows};
use crate::matching::window::Windowed;

/// The disparities of so many lanes.
const fn disparities<const STRIDE: usize>() -> [u8; STRIDE] {
    let mut disparities = [0; STRIDE];
    let mut i = 0;
    while i < STRIDE {
        disparities[i] = (STRIDE - 1 - i) as u8;
        i += 1;
    }
    disparities
}

/// [`super::Kernel::row`] for the compilation's own target.
#[inline(always)]
pub(in crate::matching) fn row<S: Windowed>(work: RowWork<'_>, select: Option<Select<'_>>) {
    match work.stride {
        32 => helium::row::<S, 32>(work, select),
        64 => helium::row::<S, 64>(work, select),
        _ => row_in_groups::<S, STEP, 0>(work, select, nearest_with::<0>),
    }
}

/// A row whose lanes are worked on in groups of `N`. `STRIDE` is the number of lanes where it is known when
/// the crate is compiled, which lets the compiler unroll the groups and keep them in registers; 0 where it is
/// not. `nearest` is [`nearest_with`] or does the same.
#[inline(always)]
pub(in crate::matching) fn row_in_groups<S: Windowed, const N: usize, const STRIDE: usize>(
    work: RowWork<'_>,
    select: Option<Select<'_>>,
    nearest: impl Fn(u8, &[u8]) -> usize,
) {
    const { assert!(S::RADIUS_X < OUTSIDE) };
    let RowWork { width, stride, min_disparity, enter, leave, columns, scratch } = work;
    // At least one group, for the compiler to see that no column is empty.
    let stride = if STRIDE > 0 { STRIDE } else { stride.max(STEP) };
    let Some((sums, codes)) = bytes_mut(scratch).split_at_mut_checked(stride) else { return };
    let Some((new, old)) = codes.split_at_mut_checked(codes.len() / 2) else { return };
    let enter = enter.map(|row| with_more_before(row, min_disparity, stride, new));
    let leave = leave.map(|row| with_more_before(row, min_disparity, stride, old));
    // Columns first, then windows: a processor that looks ahead finds more independent work in two short
    // loops than in a long one.
    if let Some(inside) = columns.get_mut(OUTSIDE * stride..) {
        columns::update::<S, N>(stride, enter, leave, inside);
    }
    let Some(Select { disparities, winners, unique }) = select else { return };

    // Left of here no pixel has a candidate.
    let begin = min_disparity.min(width);
    let WinnerRows { below, costs, above, disparities: found } = WinnerRows::of(winners, begin);
    let mut winners = below.iter_mut().zip(costs).zip(above.iter_mut().zip(found)).map(
        |((below, cost), (above, disparity))| {
            move |winner: Found| {
                (*below, *cost, *above, *disparity) =
                    (winner.beside.0, winner.cost, winner.beside.1, winner.disparity);
            }
        },
    );
    let judged = unique.is_asked();
    let mut judge = unique.starting_at(begin);
    sums.fill(0);
    // The column that leaves at the first pixel is among them.
    let before = OUTSIDE + begin.saturating_sub(S::RADIUS_X + 1);
    for column in columns.chunks_exact(stride).take(OUTSIDE + begin + S::RADIUS_X).skip(before) {
        slide::<S, N>(sums, column, columns);
    }
    let from = |column: usize| columns.get(column * stride..).unwrap_or(&[]).chunks_exact(stride);
    let mut columns = from(OUTSIDE + begin + S::RADIUS_X).zip(from(OUTSIDE + begin - S::RADIUS_X - 1));
    // The first pixels have fewer candidates than there are lanes; where there are more lanes than
    // candidates, all have.
    let few = if disparities < stride { width } else { stride - 1 };
    for (x, (enters, leaves)) in columns.by_ref().take(few).enumerate() {
        let Some(mut put) = winners.next() else { return };
        let candidates = (x + 1).min(disparities);
        let mask = MASKS.get(256 - (stride - candidates)..).and_then(|m| m.get(..stride)).unwrap_or(&[]);
        let winner = slide_to_winner::<S, N, true>(sums, enters, leaves, candidates, mask, &nearest);
        put(winner);
        judge(winner.cost, &mut || best_of_the_rest::<N>(usize::from(winner.disparity), mask, sums));
    }
    let mask = MASKS.get(256..256 + stride).unwrap_or(&[]);
    let next = |enters: &[u8], leaves: &[u8], sums: &mut [u8]| {
        slide_to_winner::<S, N, false>(sums, enters, leaves, stride, mask, &nearest)
    };
    // A loop of its own: most rows are not judged, and the other one keeps what judges them in registers.
    if !judged {
        for (mut put, (enters, leaves)) in winners.zip(columns) {
            put(next(enters, leaves, sums));
        }
        return;
    }
    for (mut put, (enters, leaves)) in winners.zip(columns) {
        let winner = next(enters, leaves, sums);
        put(winner);
        judge(winner.cost, &mut || best_of_the_rest::<N>(usize::from(winner.disparity), mask, sums));
    }
}

/// Moves the window sums one column on.
#[inline(always)]
fn slide<S: Windowed, const N: usize>(sums: &mut [u8], enters: &[u8], leaves: &[u8]) {
    let columns = enters.as_chunks::<N>().0.iter().zip(leaves.as_chunks::<N>().0);
    for (sums, (enters, leaves)) in sums.as_chunks_mut::<N>().0.iter_mut().zip(columns) {
        *sums = moved::<S, N>(sums, enters, leaves);
    }
}

/// A group of sums, one column on.
#[inline(always)]
fn moved<S: Windowed, const N: usize>(sums: &[u8; N], enters: &[u8; N], leaves: &[u8; N]) -> [u8; N] {
    let mut group = *sums;
    for i in 0..N {
        let digits = |column: u8| column >> S::COLUMN_SHIFT;
        group[i] = group[i].wrapping_add(digits(enters[i])).wrapping_sub(digits(leaves[i]));
    }
    group
}

/// [`slide`], then the smallest disparity that has the least sum.
#[inline(always)]
fn slide_to_winner<S: Windowed, const N: usize, const MASKED: bool>(
    sums: &mut [u8],
    enters: &[u8],
    leaves: &[u8],
    candidates: usize,
    mask: &[u8],
    nearest: impl Fn(u8, &[u8]) -> usize,
) -> Found {
    let mut least = [u8::MAX; N];
    let columns = enters.as_chunks::<N>().0.iter().zip(leaves.as_chunks::<N>().0);
    let lanes = sums.as_chunks_mut::<N>().0.iter_mut().zip(mask.as_chunks::<N>().0);
    for ((sums, mask), (enters, leaves)) in lanes.zip(columns) {
        let group = moved::<S, N>(sums, enters, leaves);
        for i in 0..N {
            least[i] = least[i].min(if MASKED { group[i] | mask[i] } else { group[i] });
        }
        *sums = group;
    }
    let least = minimum(&least);
    let disparity = nearest(least, sums);
    let lane = (sums.len() - 1).wrapping_sub(disparity);
    let at = |lane: usize| sums.get(lane).copied().unwrap_or(0);
    let beside = if disparity > 0 && disparity + 1 < candidates {
        (at(lane + 1), at(lane.wrapping_sub(1)))
    } else {
        // At an end the one beside it that there is; beside an only candidate, itself.
        let one = at(if disparity > 0 { lane + 1 } else { lane.wrapping_sub(usize::from(candidates > 1)) });
        (one, one)
    };
    Found { disparity: disparity as u8, cost: least, beside }
}

/// The smallest disparity with the least sum. Masked lanes may have it too, but are of larger ones.
// Helium: of groups of lanes beside other work the compiler makes single ones, of a function of its own one
// vector loop.
#[inline(never)]
pub(in crate::matching) fn nearest_with<const STRIDE: usize>(least: u8, sums: &[u8]) -> usize {
    match sums.first_chunk::<STRIDE>() {
        Some(sums) if STRIDE > 0 => nearest_among(least, sums, const { &disparities::<STRIDE>() }),
        _ => {
            nearest_among(least, sums, const { &disparities::<256>() }.get(256 - sums.len()..).unwrap_or(&[]))
        }
    }
}

#[inline(always)]
fn nearest_among(least: u8, sums: &[u8], disparities: &[u8]) -> usize {
    let mut nearest = u8::MAX;
    for (&sum, &disparity) in sums.iter().zip(disparities) {
        nearest = nearest.min(if sum == least { disparity } else { u8::MAX });
    }
    usize::from(nearest)
}

/// The least of all lanes.
#[inline(always)]
fn minimum<const N: usize>(lanes: &[u8; N]) -> u8 {
    lanes.iter().fold(u8::MAX, |least, &lane| least.min(lane))
}

/// The least cost of the candidates over [`BESIDE`] px beside the winner; `u8::MAX` where there is none.
#[inline(never)]
pub(super) fn best_of_the_rest<const N: usize>(disparity: usize, mask: &[u8], sums: &mut [u8]) -> u8 {
    // The winner and those beside it are raised while the others are looked at.
    let lane = (sums.len() - 1).saturating_sub(disparity);
    let nearest = lane.saturating_sub(BESIDE)..sums.len().min(lane + BESIDE + 1);
    let mut kept = [u8::MAX; 2 * BESIDE + 1];
    for (kept, sum) in kept.iter_mut().zip(sums.get_mut(nearest.clone()).unwrap_or_default()) {
        *kept = core::mem::replace(sum, u8::MAX);
    }
    let mut least = [u8::MAX; N];
    for (sums, mask) in sums.as_chunks::<N>().0.iter().zip(mask.as_chunks::<N>().0) {
        for i in 0..N {
            least[i] = least[i].min(sums[i] | mask[i]);
        }
    }
    for (kept, sum) in kept.iter().zip(sums.get_mut(nearest).unwrap_or_default()) {
        *sum = *kept;
    }
    minimum(&least)
}
