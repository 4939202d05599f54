//! The bits in which codes differ, counted into the columns under the window.
//!
//! ```text
//! word of bit i  bit d: whether the left code of column x and the right one of column x - d differ in their
//!                bit i. From column to column the word moves on by one candidate, and is turned over where
//!                the left bit is another one
//! column x       += the bits of the entering row that differ, and those of the leaving row that are equal;
//!                the number of bits in a code is taken off again
//! ```

use super::Column;
use super::plane::{Plane, add_pair, of_bit, two_bits};
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::memory::slices::{chunks_mut, part, part_mut};
use core::sync::atomic::{Ordering, compiler_fence};

/// Where the bits of the row that enters begin in a column's word, and those of the row that leaves: two for
/// each bit of the code, as [`prepare`] gives them.
const NEW: usize = 0;
const OLD: usize = 16;

/// Makes of the codes of a row what the columns are moved with, a half-word a pixel: for each bit of the left
/// code whether it is another one than in the column before, and beside it whether it is another one than in
/// the partner of the first candidate.
#[inline(never)]
pub(super) fn prepare<S: WindowParameters>(left: &[u8], right: &[u8], min_disparity: usize, out: &mut [u16]) {
    let min_disparity = min_disparity.min(left.len());
    let begin = first_column::<S>(min_disparity);
    let codes = part(left, begin..);
    let out = part_mut(out, begin..);
    let mut before = codes.first().copied().unwrap_or(0);
    let mut changes = |code: u8, partner: u8| {
        let changes = interleaved(code ^ partner, code ^ before);
        before = code;
        changes
    };
    // As long as there is no partner the first right column stands for it.
    let waiting = min_disparity - begin;
    let first = right.first().copied().unwrap_or(0);
    for (out, &code) in out.iter_mut().zip(codes).take(waiting) {
        *out = changes(code, first);
    }
    let inside = (part_mut(out, waiting..), part(codes, waiting..));
    for ((out, &code), &partner) in inside.0.iter_mut().zip(inside.1).zip(right) {
        *out = changes(code, partner);
    }
}

/// The bits of the first byte at the even places of a half-word, those of the second at the odd ones.
#[inline(always)]
fn interleaved(even: u8, odd: u8) -> u16 {
    let mut bytes = u32::from(even) | u32::from(odd) << 16;
    for (by, mask) in [(4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)] {
        bytes = (bytes | bytes << by) & mask;
    }
    (bytes | bytes >> 15) as u16
}

/// The first column that a window with a candidate has.
fn first_column<S: WindowParameters>(min_disparity: usize) -> usize {
    min_disparity.saturating_sub(S::RADIUS_X)
}

/// Moves the sums of all columns one row down.
#[inline(never)]
pub(super) fn update<'a, S: WindowParameters, P: Plane, const GROUPS: usize>(
    groups: usize,
    min_disparity: usize,
    [enter, leave]: [Option<&'a [u16]>; 2],
    room: &mut [P],
    columns: &mut [Column<P>],
) {
    // A row that is not there has no bit that is another one. Of the row that leaves the bits that are equal
    // are counted.
    let Some(any) = enter.or(leave) else { return };
    let present = if enter.is_some() { 0xffff } else { 0 } | if leave.is_some() { 0xffff_0000 } else { 0 };
    let (enter, leave) = (enter.unwrap_or(any), leave.unwrap_or(any));
    // In a box: the compiler otherwise takes the bits apart again.
    let equal = core::hint::black_box(0x5555_0000);
    let codes = |enter: u16, leave: u16| (u32::from(enter) | u32::from(leave) << 16) & present ^ equal;

    let begin = first_column::<S>(min_disparity.min(enter.len()));
    let from = |row: &'a [u16]| part(row, begin..);
    let all = || from(enter).iter().zip(from(leave)).map(|(&enter, &leave)| codes(enter, leave));
    let Some(first) = all().next() else { return };
    let Some(words) = room.as_chunks_mut::<2>().0.as_chunks_mut::<8>().0.get_mut(..groups) else { return };
    // The first column has one partner for all candidates.
    let start = core::array::from_fn(|i| [of_bit(first, NEW + 2 * i), of_bit(first, OLD + 2 * i)]);
    words.fill(start);
    // One group's words are in registers, as far as there are some.
    let mut here = start.map(|words| words.map(P::doubled));
    let mut columns = chunks_mut(part_mut(columns, begin * groups..), groups);
    for codes in all() {
        let Some(column) = columns.next() else { return };
        if GROUPS == 1 {
            let Some(sums) = column.first_mut() else { return };
            move_on::<S, P>(sums, &mut here, |i, doubled| {
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
                move_on::<S, P>(sums, words, |i, word| {
                    let before = before[i % 16 / 2][i / 16];
                    *word = (word.doubled() | before.highest()) ^ of_bit(codes, i + 1);
                    *word
                });
            } else {
                move_on::<S, P>(sums, words, |i, word| {
                    *word = word.doubled() ^ two_bits::<P>(codes, i);
                    *word
                });
            }
        }
    }
}

/// Moves the words of both rows one column on and counts them into the sums. `moved` gets a word's place
/// among [`NEW`] and [`OLD`].
#[inline(always)]
fn move_on<S: WindowParameters, P: Plane>(
    sums: &mut Column<P>,
    words: &mut [[P; 2]; 8],
    moved: impl Fn(usize, &mut P) -> P,
) {
    let mut here = *sums;
    count_into::<S, P>(&mut here, |i| {
        let [new, old] = &mut words[i];
        (moved(NEW + 2 * i, new), moved(OLD + 2 * i, old))
    });
    for (sum, here) in sums.iter_mut().zip(here).take(S::COLUMN_BITS) {
        *sum = here;
    }
}

/// Adds `2 BITS` bits for every candidate, two by two, and takes `BITS` off.
#[inline(always)]
fn count_into<S: WindowParameters, P: Plane>(sums: &mut Column<P>, mut bits: impl FnMut(usize) -> (P, P)) {
    let levels = S::BITS.ilog2() as usize;
    // Carries that wait for another of their weight.
    let mut waiting = [P::NONE; 4];
    for i in 0..S::BITS {
        // Half of it at a time: the compiler for ARM otherwise keeps all bits for later, in more than its
        // registers.
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
