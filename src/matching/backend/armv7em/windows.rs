//! Columns into windows, windows into winners.
//!
//! ```text
//! window x   sum[d] += digits(column[x + r][d]) - digits(column[x - r - 1][d])
//! winner x   of every lane the least sum and the first word that has it; of the lanes the least, and the
//!            first of equal ones
//! ```

use super::Rows;
use super::rows;
use crate::dsp::{ONE, min, min_halves, take_less};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::work::STEP;
use crate::matching::memory::layout::OUTSIDE;
use crate::matching::memory::slices::{part, part_mut, split_mut};
use crate::matching::memory::views::{view, view_mut};
use crate::matching::memory::winners::{BESIDE, Select, Winner};

/// The winners of a row. `STRIDE` is the number of candidates where that is known when the crate is compiled,
/// which lets the compiler unroll the work on them; 0 where it is not.
#[inline(never)]
pub(super) fn select<S: WindowParameters, const STRIDE: usize>(
    row: &Rows<'_>,
    workspace: &mut [u32],
    columns: &[u32],
    select: Select<'_>,
) {
    const { assert!(2 * S::RADIUS_X + 1 == rows::ACROSS) };
    let Select { disparities, winners, unique } = select;
    // Never none.
    let words = if STRIDE > 0 { STRIDE / 4 } else { (row.stride / 4).max(1) };
    // Before and after the sums stand those that are no candidate's.
    let Some(room) = workspace.get_mut(..words + 2) else { return };
    // Left of here no pixel has a candidate.
    let begin = row.min_disparity.min(row.width);
    let from = |column: usize| part(columns, (column * words).min(columns.len())..);
    let first = OUTSIDE + begin - S::RADIUS_X - 1;
    // All columns have the same sum too many, those outside nothing else, and a window as many columns.
    let bias = if S::BITS > 4 { 0 } else { from(first).first().copied().unwrap_or(0) & 0xff };
    let none = (0u32.wrapping_sub(rows::ACROSS as u32 * bias) & 0xff) * ONE;
    let in_assembly = STRIDE > 0 && disparities == row.stride;
    let is_checked = unique.is_asked();
    let mut check = unique.checks_from(begin);
    let mut winners = part_mut(winners.words(), begin..);
    // Of how many candidates there are sums: while pixels have few, of no more than fifteen others.
    let (mut x, mut sums) = (0, 0);
    while !winners.is_empty() {
        let candidates = disparities.min(x + 1);
        // Of the window before this one, but for the first.
        let columns = from(first + x.max(1));
        let to = if in_assembly { candidates } else { 4 * words };
        while sums < to {
            keep_loop();
            let Some(sixteen) = room.get_mut(1 + sums / 4..).and_then(|sums| sums.first_chunk_mut()) else {
                return;
            };
            let begin = if S::COLUMN_SHIFT == 0 { rows::begin_fast } else { rows::begin_block };
            begin(none, part(columns, sums / 4..), words, sixteen);
            sums += 16;
        }
        // One by one where they are judged, for their sums are looked at.
        let many = match x {
            _ if x == 0 || is_checked => 1,
            _ if STRIDE == 0 && x >= disparities => winners.len(),
            _ if !in_assembly => 1,
            _ if x < disparities => sums - x,
            _ => winners.len(),
        };
        let next;
        (next, winners) = split_mut(winners, winners.len().min(many));
        let few = (x < disparities).then_some(candidates);
        x += next.len();
        if in_assembly && candidates > 1 {
            run::<S, STRIDE>(few, room, columns, next);
        } else if STRIDE == 0 && candidates > 1 {
            each_among::<S>(candidates, columns, room, next);
        } else if let Some(winner) = next.first_mut() {
            *winner = match candidates {
                1 => at_an_end(room.get(1).map_or(0, |sum| sum << 8 & 0xff00), 1, view::<u32, u8>(room)),
                _ => next_among::<S>(
                    candidates,
                    part(columns, (rows::ACROSS * words).min(columns.len())..),
                    columns,
                    room,
                ),
            };
        }
        if is_checked && let Some(winner) = next.first() {
            check(winner.cost(), &mut || second_of(winner.disparity() as usize, candidates, room));
        }
    }
}

/// The winners of pixels of which the first has so many candidates, each one more than the one before it, of
/// which there are sums; or if it is `None`, of pixels for which all are candidates.
#[inline(always)]
fn run<S: WindowParameters, const STRIDE: usize>(
    few: Option<usize>,
    room: &mut [u32],
    columns: &[u32],
    winners: &mut [Winner],
) {
    if let Some(first) = few {
        let few = if S::COLUMN_SHIFT == 0 { rows::fast_few } else { rows::block_few };
        return few(room, columns, STRIDE / 4, winners, first);
    }
    macro_rules! run {
        ($all:ident) => {
            if let Some(sums) = room.first_chunk_mut() {
                rows::$all(sums, columns.as_chunks().0, winners);
            }
        };
    }
    match (S::COLUMN_SHIFT, STRIDE) {
        (0, 16) => run!(fast_16),
        (0, 32) => run!(fast_32),
        (0, 48) => run!(fast_48),
        (0, 64) => run!(fast_64),
        (2, 16) => run!(block_16),
        (2, 32) => run!(block_32),
        (2, 48) => run!(block_48),
        (2, 64) => run!(block_64),
        _ => {}
    }
}

/// Moves the window on, a column for each of the winners, which are among so many candidates.
#[inline(never)]
fn each_among<S: WindowParameters>(
    candidates: usize,
    mut columns: &[u32],
    room: &mut [u32],
    winners: &mut [Winner],
) {
    let words = room.len() - 2;
    for winner in winners {
        keep_loop();
        let enters = part(columns, (rows::ACROSS * words).min(columns.len())..);
        *winner = if candidates == 4 * words {
            let sums = part_mut(room, 1..=words);
            let (least, places) = rows::slide::<S>(sums, enters, columns, candidates / STEP);
            winner_of(of_lanes(least, places), candidates, room)
        } else {
            next_among::<S>(candidates, enters, columns, room)
        };
        columns = part(columns, words..);
    }
}

/// Moves the window one column on; the winner of so many candidates.
#[inline(never)]
fn next_among<S: WindowParameters>(
    candidates: usize,
    enters: &[u32],
    leaves: &[u32],
    room: &mut [u32],
) -> Winner {
    let words = room.len() - 2;
    let sums = part_mut(room, 1..=words);
    let rounds = candidates / STEP;
    let (mut least, mut places) = rows::slide::<S>(sums, enters, leaves, rounds);
    // Of the next round some lanes are no candidate's, of later ones all.
    let from = rounds * STEP / 4;
    if let Some((sums, (enters, leaves))) =
        sums.get_mut(from..).zip(enters.get(from..).zip(leaves.get(from..)))
    {
        rows::slide::<S>(sums, enters, leaves, sums.len() / (STEP / 4));
        for (word, sum) in (from..).zip(sums.iter().take(STEP / 4)) {
            let lanes = candidates.saturating_sub(4 * word).min(4) as u32;
            let others = u32::MAX.checked_shl(8 * lanes).unwrap_or(0);
            take_less(&mut least, &mut places, *sum | others, (4 * word as u32).wrapping_mul(ONE));
        }
    }
    winner_of(of_lanes(least, places), candidates, room)
}

/// The least of the lanes above 8 bits of its place.
#[inline(always)]
fn of_lanes(least: u32, places: u32) -> u32 {
    let places = places + rows::LANES;
    let even = (least & 0x00ff_00ff) << 8 | places & 0x00ff_00ff;
    let odd = least & 0xff00_ff00 | places >> 8 & 0x00ff_00ff;
    let two = min_halves(even, odd);
    (two & 0xffff).min(two >> 16)
}

/// The winner of a key among so many candidates.
#[inline(always)]
fn winner_of(key: u32, candidates: usize, room: &[u32]) -> Winner {
    let disparity = (key & 0xff) as usize;
    let bytes = view::<u32, u8>(room);
    if disparity == 0 || disparity + 1 == candidates {
        return at_an_end(key, candidates, bytes);
    }
    let around = bytes.get(3 + disparity..).and_then(|bytes| bytes.first_chunk()).copied().unwrap_or([0; 4]);
    Winner::of_costs(u32::from_le_bytes(around), disparity as u8)
}

/// The winner that is the first or the last candidate: where there is none beside it the one on its other
/// side stands for it, beside an only one itself.
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
    // The winner and those beside it are raised while the others are looked at. Of the room's words the first
    // is no sum.
    let nearest = 4 + disparity.saturating_sub(BESIDE)..5 + disparity + BESIDE;
    let mut kept = [u8::MAX; 2 * BESIDE + 1];
    for (kept, sum) in kept.iter_mut().zip(part_mut(view_mut::<u32, u8>(room), nearest.clone())) {
        *kept = core::mem::replace(sum, u8::MAX);
    }
    let sums = part(room, 1..);
    let others = sums.get(candidates / 4).map_or(u32::MAX, |last| last | u32::MAX << (candidates % 4 * 8));
    let least = sums.iter().take(candidates / 4).fold(others, |least, &sum| min(least, sum));
    for (kept, sum) in kept.iter().zip(part_mut(view_mut::<u32, u8>(room), nearest)) {
        // Not the compiler's routine for copies, which would be there for this alone.
        keep_loop();
        *sum = *kept;
    }
    (of_lanes(least, 0) >> 8) as u8
}
