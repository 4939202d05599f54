//! The kernel in safe Rust. Lanes run over the disparities of one pixel: `N` of them in an array of fixed size, which
//! the compiler keeps in vector registers where the target has them.
//!
//! A pixel's work, `d` over all lanes:
//!
//! ```text
//! column x + r:  column[d] += hamming(enter.left, enter.right[d]) - hamming(leave.left, leave.right[d])
//! window x:      sum[d]    += column[x + r][d] - column[x - r - 1][d]
//! winner x:      least of sum[d] | mask[d], then the first lane that equals it
//! ```
//!
//! The work is the same for every picture: no branch depends on a pixel.

use super::lane::{Lane, STEP};
use super::{RowCodes, RowWork, Select, Winner};
use crate::matching::scheme::Scheme;

/// Winners handed on at a time.
const BATCH: usize = 32;

/// A column outside the image adds nothing.
static NO_COLUMN: [u8; 256] = [0; 256];

/// [`super::Kernel::row`] for the compilation's own target.
#[inline(always)]
pub(super) fn row<S: Scheme>(work: RowWork<'_, S>, select: Option<Select>, found: impl FnMut(usize, &[Winner])) {
    row_in_groups::<S, STEP, 0>(work, select, found);
}

/// A row whose lanes are worked on in groups of `N`. `STRIDE` is the number of lanes where it is known when the crate
/// is compiled, which lets the compiler unroll the groups and keep them in registers; 0 where it is not.
#[inline(always)]
pub(super) fn row_in_groups<S: Scheme, const N: usize, const STRIDE: usize>(
    work: RowWork<'_, S>,
    select: Option<Select>,
    mut found: impl FnMut(usize, &[Winner]),
) {
    let RowWork { width, stride, enter, leave, columns, sums, masked } = work;
    let stride = if STRIDE > 0 { STRIDE } else { stride };
    let (Some(sums), Some(masked)) = (sums.get_mut(..stride), masked.get_mut(..stride)) else { return };
    let none = NO_COLUMN.get(..stride).unwrap_or(&[]);
    let mut batch = [Winner::default(); BATCH];
    sums.fill(S::Sum::ZERO);
    // Columns first, then windows: a processor that looks ahead finds more independent work in two short loops than in
    // a long one.
    for x in 0..width {
        if let Some(column) = columns.get_mut(x * stride..).and_then(|c| c.get_mut(..stride)) {
            update_column::<S, N>(column, candidates(enter, x, width, stride), candidates(leave, x, width, stride));
        }
    }
    let Some(select) = select else { return };
    for right in 0..width + S::RADIUS_X {
        let column = |x: usize| columns.get(x * stride..).and_then(|c| c.get(..stride)).unwrap_or(none);
        let enters = if right < width { column(right) } else { none };
        let leaves = if right > 2 * S::RADIUS_X { column(right - 2 * S::RADIUS_X - 1) } else { none };
        if right < S::RADIUS_X {
            slide::<S::Sum, N>(sums, enters, leaves, S::Sum::MASKS.get(..stride).unwrap_or(&[]), masked);
            continue;
        }
        let x = right - S::RADIUS_X;
        let candidates = select.candidates(x);
        let mask = S::Sum::MASKS.get(256 - candidates.min(256)..).and_then(|m| m.get(..stride)).unwrap_or(&[]);
        let least = slide::<S::Sum, N>(sums, enters, leaves, mask, masked);
        let place = x % BATCH;
        if let Some(slot) = batch.get_mut(place) {
            *slot = winner::<S::Sum, N>(least, candidates, select.second, masked);
        }
        if place + 1 == BATCH || x + 1 == width {
            found(x - place, batch.get(..=place).unwrap_or(&[]));
        }
    }
}

/// The code of column `x` and those it is compared with.
#[inline(always)]
fn candidates(codes: Option<RowCodes<'_>>, x: usize, width: usize, stride: usize) -> Option<(u8, &[u8])> {
    let codes = codes?;
    let left = *codes.left.get(x)?;
    let right = codes.right.get(width.checked_sub(x + 1)?..)?.get(..stride)?;
    Some((left, right))
}

/// Adds the costs that enter a column's sums and takes those that leave it.
#[inline(always)]
fn update_column<S: Scheme, const N: usize>(column: &mut [u8], enter: Option<(u8, &[u8])>, leave: Option<(u8, &[u8])>) {
    let column = column.as_chunks_mut::<N>().0;
    // Groups are taken and put as values, so that the compiler need not ask whether the slices overlap.
    match (enter, leave) {
        (Some((code, enter)), Some((old_code, leave))) => {
            let codes = enter.as_chunks::<N>().0.iter().zip(leave.as_chunks::<N>().0);
            for (sums, (&new, &old)) in column.iter_mut().zip(codes) {
                let mut group = *sums;
                for i in 0..N {
                    group[i] =
                        group[i].wrapping_add(S::hamming(code, new[i])).wrapping_sub(S::hamming(old_code, old[i]));
                }
                *sums = group;
            }
        }
        (Some((code, enter)), None) => {
            for (sums, &new) in column.iter_mut().zip(enter.as_chunks::<N>().0) {
                let mut group = *sums;
                for i in 0..N {
                    group[i] = group[i].wrapping_add(S::hamming(code, new[i]));
                }
                *sums = group;
            }
        }
        (None, Some((old_code, leave))) => {
            for (sums, &old) in column.iter_mut().zip(leave.as_chunks::<N>().0) {
                let mut group = *sums;
                for i in 0..N {
                    group[i] = group[i].wrapping_sub(S::hamming(old_code, old[i]));
                }
                *sums = group;
            }
        }
        (None, None) => {}
    }
}

/// Moves the window sums one column on, masks them and returns the least.
#[inline(always)]
fn slide<L: Lane, const N: usize>(sums: &mut [L], enters: &[u8], leaves: &[u8], mask: &[L], masked: &mut [L]) -> L {
    let mut least = [L::MAX; N];
    let columns = enters.as_chunks::<N>().0.iter().zip(leaves.as_chunks::<N>().0);
    let lanes = sums.as_chunks_mut::<N>().0.iter_mut().zip(masked.as_chunks_mut::<N>().0);
    for (((sums, masked), (&enters, &leaves)), &mask) in lanes.zip(columns).zip(mask.as_chunks::<N>().0) {
        let (mut group, mut raised) = (*sums, [L::MAX; N]);
        for i in 0..N {
            group[i] = group[i].add(L::widen(enters[i])).sub(L::widen(leaves[i]));
            raised[i] = group[i].or(mask[i]);
            least[i] = least[i].min(raised[i]);
        }
        (*sums, *masked) = (group, raised);
    }
    minimum(&least)
}

/// The least of all lanes, by halves.
#[inline(always)]
fn minimum<L: Lane, const N: usize>(lanes: &[L; N]) -> L {
    lanes.iter().fold(L::MAX, |least, &lane| least.min(lane))
}

/// The first lane with the least cost, its neighbours and the best of the rest.
#[inline(always)]
fn winner<L: Lane, const N: usize>(least: L, candidates: usize, second: bool, masked: &mut [L]) -> Winner {
    let mut first = [L::MAX; N];
    for (&lanes, &indices) in masked.as_chunks::<N>().0.iter().zip(L::INDICES.as_chunks::<N>().0) {
        for i in 0..N {
            first[i] = first[i].min(indices[i].or(lanes[i].differs(least)));
        }
    }
    let disparity = usize::from(minimum(&first).get());
    let cost = least.get();
    let beside = if disparity > 0 && disparity + 1 < candidates {
        let at = |d: usize| masked.get(d).map_or(cost, |c| c.get());
        (at(disparity - 1), at(disparity + 1))
    } else {
        (cost, cost)
    };
    let second = if second { best_of_the_rest::<L, N>(disparity, masked) } else { u16::MAX };
    Winner { candidates: candidates as u16, disparity: disparity as u16, cost, beside, second }
}

/// The least cost of the lanes over one px beside the winner. Their three lanes are overwritten.
#[inline(always)]
fn best_of_the_rest<L: Lane, const N: usize>(disparity: usize, masked: &mut [L]) -> u16 {
    for lane in masked.iter_mut().skip(disparity.saturating_sub(1)).take(if disparity > 0 { 3 } else { 2 }) {
        *lane = L::MAX;
    }
    let mut least = [L::MAX; N];
    for &lanes in masked.as_chunks::<N>().0 {
        for i in 0..N {
            least[i] = least[i].min(lanes[i]);
        }
    }
    let least = minimum(&least);
    if least < L::MAX { least.get() } else { u16::MAX }
}
