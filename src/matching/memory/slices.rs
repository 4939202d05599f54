//! Parts of slices whose sizes the layout of the memory promises.
//!
//! A part that is not there is a mistake of this crate: an assertion in debug builds, and an empty slice in
//! others, for nothing here may panic.

pub(in crate::matching) use crate::imaging::{chunks, chunks_mut};
use core::ops::{Bound, RangeBounds};

/// A part of a slice, by a range.
#[inline(always)]
#[track_caller]
pub(in crate::matching) fn part<T>(slice: &[T], range: impl RangeBounds<usize>) -> &[T] {
    let (begin, end) = bounds(&range, slice.len());
    debug_assert!(begin <= end && end <= slice.len(), "a part that {} numbers do not have", slice.len());
    let slice = slice.get(..end).unwrap_or(slice);
    slice.get(begin.min(slice.len())..).unwrap_or_default()
}

/// Mutable access to a part of a slice, by a range.
#[inline(always)]
#[track_caller]
pub(in crate::matching) fn part_mut<T>(slice: &mut [T], range: impl RangeBounds<usize>) -> &mut [T] {
    let (begin, end) = bounds(&range, slice.len());
    debug_assert!(begin <= end && end <= slice.len(), "a part that {} numbers do not have", slice.len());
    let end = end.min(slice.len());
    let slice = slice.get_mut(..end).unwrap_or_default();
    slice.get_mut(begin.min(end)..).unwrap_or_default()
}

#[inline(always)]
fn bounds(range: &impl RangeBounds<usize>, length: usize) -> (usize, usize) {
    let begin = match range.start_bound() {
        Bound::Included(&begin) => begin,
        Bound::Excluded(&begin) => begin + 1,
        Bound::Unbounded => 0,
    };
    let end = match range.end_bound() {
        Bound::Included(&end) => end + 1,
        Bound::Excluded(&end) => end,
        Bound::Unbounded => length,
    };
    (begin, end)
}

/// Mutable access to the numbers before `place` and to those from it on.
#[inline(always)]
#[track_caller]
pub(in crate::matching) fn split_mut<T>(slice: &mut [T], place: usize) -> (&mut [T], &mut [T]) {
    debug_assert!(place <= slice.len(), "{} numbers have no place {place}", slice.len());
    slice.split_at_mut_checked(place.min(slice.len())).unwrap_or_default()
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
