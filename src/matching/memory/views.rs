//! One memory looked at as numbers of another width.
//!
//! A stage's workspace is lent as words; rows of bytes, half-words and winners stand in it. All of these are
//! integers without padding, any value of which is valid, so that each is a view of the others.
#![allow(unsafe_code)]

use super::notes::Note;
use super::record::WinnerRecord;
use super::winner::Winner;
use crate::units::{Disparity, PixelFlags};
use core::slice;

/// A type that is nothing but an integer: without padding, and valid whatever its bits are.
///
/// # Safety
///
/// Every bit pattern is a valid value, and the type has no padding: all of its bytes are initialised.
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
// SAFETY: a `u16` (`repr(transparent)`).
unsafe impl Plain for Disparity {}
// SAFETY: a `u8` (`repr(transparent)`).
unsafe impl Plain for Note {}
// SAFETY: eight `u8` (`repr(transparent)`).
unsafe impl Plain for WinnerRecord {}

/// The bytes before the first place where a `To` may stand, and how many whole ones there are from it on.
/// That place may be beyond the end; then there is none.
///
/// [`slice::align_to`] gives the same, with panics inside that an optimiser for size leaves in.
#[inline(always)]
fn whole<From: Plain, To: Plain>(numbers: &[From]) -> (usize, usize) {
    let (bytes, align) = (size_of_val(numbers), align_of::<To>());
    let skip =
        if align > align_of::<From>() { numbers.as_ptr().addr().wrapping_neg() & (align - 1) } else { 0 };
    (skip, bytes.saturating_sub(skip) / size_of::<To>())
}

/// The part of `numbers` that stands at places of `To` and is a whole number of them: all of it where the
/// slice begins at such a place and has whole ones.
#[inline(always)]
pub(in crate::matching) fn view<From: Plain, To: Plain>(numbers: &[From]) -> &[To] {
    let (skip, count) = whole::<From, To>(numbers);
    // SAFETY: the places are where a `To` may stand, and inside of `numbers`: of none the slice is empty.
    // Both types are plain: every value of the one's bytes is a value of the other.
    unsafe { slice::from_raw_parts(numbers.as_ptr().wrapping_byte_add(skip).cast(), count) }
}

/// Mutable access to what [`view`] shows.
#[inline(always)]
pub(in crate::matching) fn view_mut<From: Plain, To: Plain>(numbers: &mut [From]) -> &mut [To] {
    let (skip, count) = whole::<From, To>(numbers);
    // SAFETY: as in `view`, and the other way round.
    unsafe { slice::from_raw_parts_mut(numbers.as_mut_ptr().wrapping_byte_add(skip).cast(), count) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_begins_where_a_number_may_stand_and_ends_with_the_last_whole_one() {
        let mut words = [0u32; 6];
        let bytes = view_mut::<u32, u8>(&mut words);
        assert_eq!(bytes.len(), 24);
        for (place, byte) in bytes.iter_mut().enumerate() {
            *byte = place as u8;
        }
        for (begin, end) in (0..=24usize).flat_map(|begin| (begin..=24).map(move |end| (begin, end))) {
            let first = begin.next_multiple_of(4);
            let number = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|byte| (at + byte) as u8));
            let whole = (first..).step_by(4).take_while(|at| at + 4 <= end).map(number);
            let part = &mut bytes[begin..end];
            assert!(whole.clone().eq(view::<u8, u32>(part).iter().copied()), "{begin}..{end}");
            assert!(whole.eq(view_mut::<u8, u32>(part).iter().copied()), "{begin}..{end}");
        }
        let halves = view::<u32, u16>(&words);
        assert_eq!(halves.len(), 12);
        assert_eq!(view::<u16, u32>(&halves[1..10]).len(), 4, "from the second word up to the fifth");
    }
}
