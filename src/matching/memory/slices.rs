//! Parts of slices whose sizes the layout of the memory promises.
//!
//! A part that is not there is a mistake of this crate: an assertion in debug builds, and an empty slice in
//! others, for nothing here may panic.

use core::slice::SliceIndex;

/// A part of a slice, by a range.
#[inline(always)]
#[track_caller]
pub(in crate::matching) fn part<T>(slice: &[T], range: impl SliceIndex<[T], Output = [T]>) -> &[T] {
    let part = slice.get(range);
    debug_assert!(part.is_some(), "a part that {} numbers do not have", slice.len());
    part.unwrap_or_default()
}

/// Mutable access to a part of a slice, by a range.
#[inline(always)]
#[track_caller]
pub(in crate::matching) fn part_mut<T>(
    slice: &mut [T],
    range: impl SliceIndex<[T], Output = [T]>,
) -> &mut [T] {
    let count = slice.len();
    let part = slice.get_mut(range);
    debug_assert!(part.is_some(), "a part that {count} numbers do not have");
    part.unwrap_or_default()
}

/// Mutable access to the numbers before `place` and to those from it on.
#[inline(always)]
#[track_caller]
pub(in crate::matching) fn split_mut<T>(slice: &mut [T], place: usize) -> (&mut [T], &mut [T]) {
    debug_assert!(place <= slice.len(), "{} numbers have no place {place}", slice.len());
    slice.split_at_mut_checked(place).unwrap_or_default()
}
