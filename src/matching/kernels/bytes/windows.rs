//! Columns into windows, windows into winners.
//!
//! ```text
//! window x   sum[d] += digits(column[x + r][d]) - digits(column[x - r - 1][d])
//! winner x   of every lane the least sum and the first word that has it; of the lanes the least, and the first of equal ones
//! ```

use super::rows;
use super::word::{ONE, add, min, min_halves, sub, take_less};
use super::{Rows, bytes_of};
use crate::matching::kernels::scratch::bytes_mut;
use crate::matching::kernels::{BESIDE, OUTSIDE, Select, Winner};
use crate::matching::window::Windowed;

/// The lane numbers.
const LANES: u32 = 0x0302_0100;

/// The winners of a row. `STRIDE` is the number of candidates where that is known when the crate is compiled, which lets the
/// compiler unroll the work on them; 0 where it is not.
#[inline(never)]
pub(super) fn select<S: Windowed, const STRIDE: usize>(
    row: &Rows<'_>,
    scratch: &mut [u32],
    columns: &[u32],
    select: Select<'_>,
) {
    let Select { disparities, winners, unique } = select;
    // Never none.
    let words = if STRIDE > 0 { STRIDE / 4 } else { (row.stride / 4).max(1) };
    // Before and after the sums stand those that are no candidate's.
    let Some(room) = scratch.get_mut(..words + 2) else { return };
    // Left of here no pixel has a candidate.
    let begin = row.min_disparity.min(row.width);
    let from = |column: usize| columns.get(column * words..).unwrap_or(&[]);
    let first = OUTSIDE + begin - S::RADIUS_X - 1;
    // All columns have the same sum too many, and a window as many columns.
    let bias = if S::BITS > 4 { 0 } else { from(first).first().copied().unwrap_or(0) };
    let diameter = 2 * S::RADIUS_X + 1;
    let inside = room.get_mut(1..=words).unwrap_or_default();
    inside.fill(0);
    // Nothing differs in the columns outside.
    let outside = OUTSIDE - first.min(OUTSIDE);
    for column in from(first).chunks_exact(words).take(diameter).skip(outside) {
        for (sum, &column) in inside.iter_mut().zip(column) {
            *sum = add(*sum, sub(digits::<S>(column), bias));
        }
    }
    let judged = unique.is_asked();
    let mut judge = unique.starting_at(begin);
    let winners = winners.get_mut(begin..).unwrap_or_default();
    let mut x = 0;
    while let Some(rest) = winners.get_mut(x..).filter(|rest| !rest.is_empty()) {
        let candidates = disparities.min(x + 1);
        // The first pixels have fewer candidates than there are lanes.
        let growing = candidates < disparities;
        let alike = if judged || STRIDE == 0 || disparities < row.stride || candidates == 1 {
            // One by one where they are judged, for their sums are looked at.
            1
        } else if growing {
            rest.len().min(disparities - candidates)
        } else {
            rest.len()
        };
        let next = rest.get_mut(..alike).unwrap_or_default();
        let by_words = STRIDE == 0 || disparities < row.stride || candidates == 1;
        if by_words || !in_assembly::<S, STRIDE>(growing.then_some(candidates), room, from(first + x), next) {
            for (winner, x) in next.iter_mut().zip(x..) {
                let candidates = disparities.min(x + 1);
                *winner = next_among::<S>(candidates, from(first + x + diameter), from(first + x), room);
            }
        }
        if let ([winner], true) = (next, judged) {
            judge(winner.cost(), &mut || second_of(winner.disparity() as usize, candidates, room));
        }
        x += alike;
    }
}

/// The winners of pixels of which the first has `first` candidates, each one more than the one before it; or if it is `None`,
/// of pixels for which all are candidates. Whether this core and this number of candidates have such a loop.
#[inline(always)]
fn in_assembly<S: Windowed, const STRIDE: usize>(
    first: Option<usize>,
    room: &mut [u32],
    columns: &[u32],
    winners: &mut [Winner],
) -> bool {
    const { assert!(2 * S::RADIUS_X + 1 == rows::ACROSS) };
    macro_rules! run {
        ($all:ident, $few:ident) => {{
            let Some(sums) = room.first_chunk_mut() else { return false };
            match first {
                None => rows::$all(sums, columns.as_chunks().0, winners),
                Some(first) => rows::$few(sums, columns.as_chunks().0, winners, first),
            }
            true
        }};
    }
    match (S::COLUMN_SHIFT, STRIDE) {
        (0, 16) => run!(fast_16, fast_few_of_16),
        (0, 32) => run!(fast_32, fast_few_of_32),
        (0, 48) => run!(fast_48, fast_few_of_48),
        (0, 64) => run!(fast_64, fast_few_of_64),
        (2, 16) => run!(block_16, block_few_of_16),
        (2, 32) => run!(block_32, block_few_of_32),
        (2, 48) => run!(block_48, block_few_of_48),
        (2, 64) => run!(block_64, block_few_of_64),
        _ => false,
    }
}

/// Moves the window one column on; the winner of so many candidates.
#[inline(never)]
fn next_among<S: Windowed>(candidates: usize, enters: &[u32], leaves: &[u32], room: &mut [u32]) -> Winner {
    let words = room.len() - 2;
    for (sum, (&enters, &leaves)) in room.iter_mut().skip(1).take(words).zip(enters.iter().zip(leaves)) {
        *sum = sub(add(*sum, digits::<S>(enters)), digits::<S>(leaves));
    }
    winner_of(least_of(room.get(1..).unwrap_or(&[]), candidates), candidates, room)
}

/// The digits of columns' sums that windows are made of.
#[inline(always)]
fn digits<S: Windowed>(column: u32) -> u32 {
    (column >> S::COLUMN_SHIFT) & ((0xff >> S::COLUMN_SHIFT) * ONE)
}

/// The least sum of so many candidates.
#[inline(always)]
fn least_of(sums: &[u32], candidates: usize) -> u32 {
    let (mut least, mut places, mut place) = (u32::MAX, 0, 0u32);
    for &sum in sums.iter().take(candidates / 4) {
        take_less(&mut least, &mut places, sum, place);
        place = place.wrapping_add(4 * ONE);
    }
    // Of the last word the first lanes.
    if let Some(&last) = sums.get(candidates / 4) {
        let others = u32::MAX << (candidates % 4 * 8);
        take_less(&mut least, &mut places, last | others, place);
    }
    of_lanes(least, places)
}

/// The least of the lanes above 8 bits of its place.
#[inline(always)]
fn of_lanes(least: u32, places: u32) -> u32 {
    let places = places + LANES;
    let even = (least & 0x00ff_00ff) << 8 | places & 0x00ff_00ff;
    let odd = least & 0xff00_ff00 | places >> 8 & 0x00ff_00ff;
    let two = min_halves(even, odd);
    (two & 0xffff).min(two >> 16)
}

/// The winner of a key among so many candidates.
#[inline(always)]
fn winner_of(key: u32, candidates: usize, room: &[u32]) -> Winner {
    let disparity = (key & 0xff) as usize;
    let bytes = bytes_of(room);
    if disparity == 0 || disparity + 1 == candidates {
        return at_an_end(key, candidates, bytes);
    }
    let around = bytes.get(3 + disparity..).and_then(|bytes| bytes.first_chunk()).copied().unwrap_or([0; 4]);
    Winner::of_costs(u32::from_le_bytes(around), disparity as u8)
}

/// The winner that is the first or the last candidate: where there is none beside it the one on its other side stands for it,
/// beside an only one itself.
#[inline(never)]
fn at_an_end(key: u32, candidates: usize, bytes: &[u8]) -> Winner {
    let (disparity, cost) = ((key & 0xff) as usize, (key >> 8) as u8);
    let beside = match disparity {
        0 if candidates > 1 => 1,
        _ => disparity.saturating_sub(1),
    };
    let beside = bytes.get(4 + beside).copied().unwrap_or(0);
    Winner::new(cost, disparity as u8, (beside, beside))
}

/// The least sum of the candidates over [`BESIDE`] px beside the winner; `u8::MAX` where there is none.
#[inline(never)]
fn second_of(disparity: usize, candidates: usize, room: &mut [u32]) -> u8 {
    // The winner and those beside it are raised while the others are looked at. Of the room's words the first is no sum.
    let nearest = 4 + disparity.saturating_sub(BESIDE)..5 + disparity + BESIDE;
    let mut kept = [u8::MAX; 2 * BESIDE + 1];
    for (kept, sum) in kept.iter_mut().zip(bytes_mut(room).get_mut(nearest.clone()).unwrap_or_default()) {
        *kept = core::mem::replace(sum, u8::MAX);
    }
    let sums = room.get(1..).unwrap_or(&[]);
    let others = sums.get(candidates / 4).map_or(u32::MAX, |last| last | u32::MAX << (candidates % 4 * 8));
    let least = sums.iter().take(candidates / 4).fold(others, |least, &sum| min(least, sum));
    for (kept, sum) in kept.iter().zip(bytes_mut(room).get_mut(nearest).unwrap_or_default()) {
        *sum = *kept;
    }
    (of_lanes(least, 0) >> 8) as u8
}
