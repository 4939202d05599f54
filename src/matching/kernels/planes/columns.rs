//! The bits in which codes differ, counted into the columns under the window.
//!
//! ```text
//! word of bit i  bit d: whether the left code of column x and the right one of column x - d differ in their bit i. From column
//!                to column the word moves on by one candidate, and is turned over where the left bit is another one
//! column x       += the bits of the entering row that differ, and those of the leaving row that are equal; the number of
//!                bits in a code is taken off again
//! ```

use super::Column;
use super::plane::{Plane, add_pair, of_bit, two_bits};
use crate::matching::kernels::RowCodes;
use crate::matching::scheme::Scheme;
use core::cell::Cell;
use core::sync::atomic::{Ordering, compiler_fence};

/// Where the bits of the row that enters begin in a column's word, and those of the row that leaves: two for each bit of
/// the code, as [`prepare`] leaves them.
const NEW: usize = 0;
const OLD: usize = 16;

/// Makes of the codes of a row what the columns are moved with: for each bit whether it is another one than in the column
/// before, and whether it is another one than in the partner of the first candidate. The two stand side by side, those of
/// the code's first four bits in place of the left code, the others in place of the right one.
#[inline(never)]
pub(in crate::matching::kernels) fn prepare<'a, S: Scheme>(
    left: &'a mut [u8],
    right: &'a mut [u8],
    min_disparity: usize,
) {
    let begin = first_column::<S>(min_disparity);
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
fn first_column<S: Scheme>(min_disparity: usize) -> usize {
    min_disparity.saturating_sub(S::RADIUS_X)
}

/// Moves the sums of all columns one row down.
#[inline(never)]
pub(super) fn update<'a, S: Scheme, P: Plane, const GROUPS: usize>(
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
    let row =
        |row: RowCodes<'a>| (row.left.get(begin..width).unwrap_or(&[]), row.right.get(begin..width).unwrap_or(&[]));
    let (new, old) = (row(enter), row(leave));
    let all = || new.0.iter().zip(new.1).zip(old.0.iter().zip(old.1)).map(|((&a, &b), (&c, &d))| codes([a, b, c, d]));
    let Some(first) = all().next() else { return };
    let Some(words) = room.as_chunks_mut::<2>().0.as_chunks_mut::<8>().0.get_mut(..groups) else { return };
    // The first column has one partner for all candidates.
    let start = core::array::from_fn(|i| [of_bit(first, NEW + 2 * i), of_bit(first, OLD + 2 * i)]);
    words.fill(start);
    // One group's words are in registers, as far as there are some.
    let mut here = start.map(|words| words.map(P::doubled));
    let mut columns = columns.get_mut(begin * groups..).unwrap_or_default().chunks_exact_mut(groups);
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

/// Moves the words of both rows one column on and counts them into the sums. `moved` gets a word's place among [`NEW`] and
/// [`OLD`].
#[inline(always)]
fn move_on<S: Scheme, P: Plane>(sums: &mut Column<P>, words: &mut [[P; 2]; 8], moved: impl Fn(usize, &mut P) -> P) {
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
