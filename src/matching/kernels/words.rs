//! The kernel in 32-bit words, for cores without vectors: four candidates' costs in the bytes of a word, two
//! candidates' window sums in its halves. Safe Rust; the arithmetic is that of plain words.
//!
//! ```text
//! right codes    one word for each column, of its code and those of the three columns left of it: the candidates
//!                4k .. 4k + 3 of column x are the word of column x - 4k
//! column x + r   four sums a word. Both rows are counted at once: the bits in which the entering codes differ, and those
//!                in which the leaving ones are equal, so that the sum never goes below zero; then the constant is taken off
//! window x       two sums a word: the even candidates' and the odd ones'. A sum stands above the candidate's number,
//!                so that one comparison finds the least sum, and of equal ones the first
//! ```
//!
//! The work is the same for every picture: no branch depends on a pixel.

use super::keys::{Best, GROUP, Keys, NUMBER_BITS};
use super::scratch::words_mut;
use super::{OUTSIDE, RowCodes, RowWork, Select, Winner, beside_at_the_end};
use crate::matching::scheme::Scheme;

/// Winners handed on at a time.
const BATCH: usize = 16;

/// One in every byte.
const BYTES: u32 = 0x0101_0101;

/// [`super::Kernel::row`] in words.
#[inline(always)]
pub(in crate::matching) fn row<S: Scheme>(work: RowWork<'_>, select: Option<Select>, mut found: impl FnMut(&[Winner])) {
    const { assert!(S::BITS * (2 * S::RADIUS_X + 1) * (2 * S::RADIUS_Y + 1) < 1 << (15 - NUMBER_BITS)) };
    const { assert!(S::RADIUS_X < OUTSIDE) };
    let RowWork { width, stride, min_disparity, enter, leave, columns, scratch } = work;
    // At least one, for the compiler to see that no column is empty.
    let groups = (stride / 16).max(1);
    let Some((sums, codes)) = scratch.split_at_mut_checked(stride / 2) else { return };
    let columns = words_mut(columns).as_chunks_mut::<4>().0;
    if let Some(inside) = columns.get_mut(OUTSIDE * groups..) {
        update_columns::<S>(width, groups, min_disparity, [enter, leave], codes, inside);
    }
    let Some(select) = select else { return };

    let Some(mut keys) = Keys::new(sums, groups) else { return };
    let (outside, inside) = columns.split_at_checked(OUTSIDE * groups).unwrap_or_default();
    let mut entering = inside.chunks_exact(groups).chain(outside.chunks_exact(groups));
    let none = outside.get(..groups).unwrap_or(&[]);
    for _ in 0..S::RADIUS_X {
        keys.slide(entering.next().unwrap_or(none), none);
    }
    let leaving = columns.chunks_exact(groups).skip(OUTSIDE - 1 - S::RADIUS_X);
    let mut pairs = (0..width).zip(leaving).zip(entering);
    let mut batch = [Winner::default(); BATCH];
    for _ in 0..width.div_ceil(BATCH) {
        let mut count = 0;
        for (slot, ((x, leaves), enters)) in batch.iter_mut().zip(&mut pairs) {
            let candidates = select.candidates(x);
            *slot = if candidates == stride && groups <= GROUP / 4 {
                winner(keys.slide_to_best(enters, leaves), candidates, &keys)
            } else {
                keys.slide(enters, leaves);
                winner(keys.best(candidates), candidates, &keys)
            };
            if select.second {
                slot.second = best_of_the_rest(slot.disparity() as usize, candidates, &mut keys);
            }
            count += 1;
        }
        found(batch.get(..count).unwrap_or(&[]));
    }
}

/// The best candidate with the costs beside it.
#[inline(always)]
fn winner((cost, disparity): Best, candidates: usize, keys: &Keys<'_>) -> Winner {
    let beside = if disparity > 0 && disparity + 1 < candidates {
        keys.beside(disparity)
    } else {
        beside_at_the_end(disparity, candidates, |candidate| keys.cost(candidate), cost)
    };
    Winner::new(cost, disparity as u32, beside)
}

/// The least cost of the candidates over one px beside the winner; `u32::MAX` where there is none.
#[inline(never)]
fn best_of_the_rest(disparity: usize, candidates: usize, keys: &mut Keys<'_>) -> u32 {
    // The winner and those beside it are raised while the others are looked at.
    let nearest = disparity.saturating_sub(1)..disparity + 2;
    let mut kept = [0; 3];
    for (kept, candidate) in kept.iter_mut().zip(nearest.clone()) {
        if let Some((word, key)) = keys.place(candidate) {
            *kept = *word & key;
            *word |= key;
        }
    }
    let (least, _) = keys.best(candidates);
    for (kept, candidate) in kept.iter().zip(nearest) {
        if let Some((word, key)) = keys.place(candidate) {
            *word = *word & !key | kept;
        }
    }
    // No sum reaches what stands for none.
    if least < 0x7fff >> NUMBER_BITS { least } else { u32::MAX }
}

/// Moves the sums of all columns one row down.
#[inline(always)]
fn update_columns<S: Scheme>(
    width: usize,
    groups: usize,
    min_disparity: usize,
    [enter, leave]: [Option<RowCodes<'_>>; 2],
    codes: &mut [u32],
    columns: &mut [[u32; 4]],
) {
    // A row that is not there has all codes equal: zero in both images, or with its left codes inverted, all ones in the
    // right one.
    let Some(any) = enter.or(leave) else { return };
    let nothing = RowCodes { left: any.left, right: &[] };
    let bytes = |row: Option<RowCodes<'_>>| if row.is_some() { BYTES } else { 0 };
    let (new_bytes, old_bytes) = (bytes(enter), bytes(leave));
    let (enter, leave) = (enter.unwrap_or(nothing), leave.unwrap_or(nothing));
    // As many columns at a time as there is room for their words in two rows.
    let Some((new, old)) = codes.split_at_mut_checked(codes.len() / 2) else { return };
    let stride = 16 * groups;
    let block = new.len().saturating_sub(stride).max(1);
    for first in (0..width).step_by(block) {
        let begin = first.wrapping_sub(min_disparity + stride - 4);
        spread(enter.right, begin, 0, new);
        spread(leave.right, begin, u32::MAX, old);
        let end = width.min(first + block);
        for group in 0..groups {
            // Left of here no window has one of these candidates.
            let x = first.max((16 * group + min_disparity).saturating_sub(S::RADIUS_X));
            let place = stride - 16 * (group + 1) + x - first;
            let words = new.get(place..).unwrap_or(&[]).windows(16).zip(old.get(place..).unwrap_or(&[]).windows(16));
            let codes = enter.left.get(x..end).unwrap_or(&[]).iter().zip(leave.left.get(x..end).unwrap_or(&[]));
            let columns = columns.get_mut(x * groups + group..).unwrap_or_default().iter_mut().step_by(groups);
            for (sums, ((new, old), (&new_code, &old_code))) in columns.zip(words.zip(codes)) {
                let (Some(new), Some(old)) = (new.first_chunk::<16>(), old.first_chunk::<16>()) else { return };
                let (new_code, old_code) = (u32::from(new_code) * new_bytes, u32::from(!old_code) * old_bytes);
                for k in 0..4 {
                    let changed = S::bits_of_two(new_code ^ new[12 - 4 * k], old_code ^ old[12 - 4 * k]);
                    sums[k] = sums[k].wrapping_add(changed).wrapping_sub(S::BITS as u32 * BYTES);
                }
            }
        }
    }
}

/// Writes the words of the columns from `begin` on, which may lie left of the image: there the first code is
/// repeated. Without codes every word is `without`.
#[inline(always)]
fn spread(codes: &[u8], begin: usize, without: u32, words: &mut [u32]) {
    let Some(&first) = codes.first() else {
        words.fill(without);
        return;
    };
    let before = (begin as isize).min(0).unsigned_abs().min(words.len());
    let (outside, inside) = words.split_at_mut_checked(before).unwrap_or_default();
    outside.fill(u32::from(first) * BYTES);
    let begin = (begin as isize).max(0) as usize;
    let mut word = 0;
    for k in (1..4).rev() {
        let code = codes.get(begin.saturating_sub(k)).copied().unwrap_or(0);
        word = word << 8 | u32::from(code);
    }
    for (out, &code) in inside.iter_mut().zip(codes.get(begin..).unwrap_or(&[])) {
        word = word << 8 | u32::from(code);
        *out = word;
    }
}
