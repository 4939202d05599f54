//! Parts of slices whose sizes the layout of the memory promises.
//!
//! A part that is not there is a mistake of this crate: an assertion in debug builds, and less than was asked
//! for in others, for nothing here may panic.

pub(in crate::matching) use crate::imaging::{chunks, chunks_mut};
use core::ops::{Bound, RangeBounds};

/// A part of a slice, by a range.
#[inline(always)]
#[track_caller]
pub(in crate::matching) fn part<T>(slice: &[T], range: impl RangeBounds<usize>) -> &[T] {
    let (begin, end) = bounds(&range, slice.len());
    slice.get(begin..end).unwrap_or_default()
}

/// Mutable access to a part of a slice, by a range.
#[inline(always)]
#[track_caller]
pub(in crate::matching) fn part_mut<T>(slice: &mut [T], range: impl RangeBounds<usize>) -> &mut [T] {
    let (begin, end) = bounds(&range, slice.len());
    slice.get_mut(begin..end).unwrap_or_default()
}

/// Mutable access to the numbers before `place` and to those from it on.
#[inline(always)]
#[track_caller]
pub(in crate::matching) fn split_mut<T>(slice: &mut [T], place: usize) -> (&mut [T], &mut [T]) {
    let (_, place) = bounds(&..place, slice.len());
    slice.split_at_mut_checked(place).unwrap_or_default()
}

/// Where a range of so many numbers begins and ends. On microcontrollers both are cut to what there is:
/// fewer instructions than an empty part in place of one that is not there.
#[inline(always)]
#[track_caller]
fn bounds(range: &impl RangeBounds<usize>, count: usize) -> (usize, usize) {
    let begin = match range.start_bound() {
        Bound::Included(&begin) => begin,
        Bound::Excluded(&before) => before + 1,
        Bound::Unbounded => 0,
    };
    let end = match range.end_bound() {
        Bound::Included(&last) => last + 1,
        Bound::Excluded(&end) => end,
        Bound::Unbounded => count,
    };
    debug_assert!(begin <= end && end <= count, "{count} numbers have no part {begin}..{end}");
    if cfg!(stereopsis_simd) {
        return (begin, end);
    }
    let end = end.min(count);
    (begin.min(end), end)
}

/// The least multiple of `TO` that is not less.
#[inline(always)]
pub(in crate::matching) const fn multiple_of<const TO: usize>(number: usize) -> usize {
    const { assert!(TO > 0) };
    number.saturating_add(TO - 1) / TO * TO
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_up_to_a_multiple() {
        let next = |number: usize, to: usize| (number..).find(|next| next % to == 0);
        for number in 0..200 {
            assert_eq!(Some(multiple_of::<1>(number)), next(number, 1));
            assert_eq!(Some(multiple_of::<4>(number)), next(number, 4));
            assert_eq!(Some(multiple_of::<31>(number)), next(number, 31));
            assert_eq!(Some(multiple_of::<32>(number)), next(number, 32));
        }
    }

    #[test]
    fn parts_are_those_that_are_asked_for() {
        let mut numbers = [1, 2, 3, 4, 5];
        assert_eq!(part(&numbers, 1..3), [2, 3]);
        part_mut(&mut numbers, 3..).fill(9);
        let (first, rest) = split_mut(&mut numbers, 2);
        assert_eq!((&*first, &*rest), (&[1, 2][..], &[3, 9, 9][..]));
    }
}
