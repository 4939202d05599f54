//! One memory looked at as numbers of another width.
//!
//! A stage's workspace is lent as words; rows of bytes, half-words and winners stand in it. All of these are
//! integers without padding, any value of which is valid, so that each is a view of the others.
#![allow(unsafe_code)]

use super::notes::Note;
use super::record::WinnerRecord;
use super::winner::Winner;
use crate::units::PixelFlags;
use core::slice;

/// A type that is nothing but an integer: without padding, and valid whatever its bits are.
///
/// # Safety
///
/// Every bit pattern of the type's size is a value of the type, and every value has all of its bytes set.
pub(in crate::matching) unsafe trait Plain: Copy + 'static {}

// SAFETY: an integer.
unsafe impl Plain for u8 {}
// SAFETY: an integer.
unsafe impl Plain for u16 {}
// SAFETY: an integer.
unsafe impl Plain for u32 {}
// SAFETY: a `u32` (`repr(transparent)`).
unsafe impl Plain for Winner {}
// SAFETY: a `u8` (`repr(transparent)`), any of whose values `PixelFlags::from_bits` takes.
unsafe impl Plain for PixelFlags {}
// SAFETY: a `u8` (`repr(transparent)`).
unsafe impl Plain for Note {}
// SAFETY: eight `u8` (`repr(transparent)`).
unsafe impl Plain for WinnerRecord {}

/// The bytes before the first place where a `To` may stand, and how many whole ones there are from it on.
///
/// [`slice::align_to`] gives the same, with panics inside that an optimiser for size leaves in.
#[inline(always)]
fn whole<From: Plain, To: Plain>(numbers: &[From]) -> (usize, usize) {
    let (bytes, align) = (size_of_val(numbers), align_of::<To>());
    let skip =
        if align > align_of::<From>() { numbers.as_ptr().addr().wrapping_neg() & (align - 1) } else { 0 };
    if skip <= bytes { (skip, (bytes - skip) / size_of::<To>()) } else { (0, 0) }
}

/// The part of `numbers` that stands at places of `To` and is a whole number of them: all of it where the
/// slice begins at such a place and has whole ones.
#[inline(always)]
pub(in crate::matching) fn view<From: Plain, To: Plain>(numbers: &[From]) -> &[To] {
    let (skip, count) = whole::<From, To>(numbers);
    // SAFETY: the places are inside of `numbers` and where a `To` may stand. Both types are plain: every
    // value of the one's bytes is a value of the other.
    unsafe { slice::from_raw_parts(numbers.as_ptr().byte_add(skip).cast(), count) }
}

/// Mutable access to what [`view`] shows.
#[inline(always)]
pub(in crate::matching) fn view_mut<From: Plain, To: Plain>(numbers: &mut [From]) -> &mut [To] {
    let (skip, count) = whole::<From, To>(numbers);
    // SAFETY: as in `view`, and the other way round.
    unsafe { slice::from_raw_parts_mut(numbers.as_mut_ptr().byte_add(skip).cast(), count) }
}
