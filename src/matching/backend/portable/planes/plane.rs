//! Words whose bits are candidates.

use crate::matching::memory::views::view_mut;
use core::ops::{BitAnd, BitOr, BitXor, Not};

/// One bit of a number for each of several candidates, the first candidate's lowest.
pub trait Plane:
    Copy
    + Eq
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Not<Output = Self>
    + 'static
{
    /// How many candidates.
    const CANDIDATES: usize;
    /// No bit.
    const NONE: Self;
    /// Every bit.
    const ALL: Self;
    /// Bytes, where a word may stand, as planes.
    fn of_bytes(bytes: &mut [u8]) -> &mut [Self];
    /// Words as planes.
    fn of_words(words: &mut [u32]) -> &mut [Self];
    /// One candidate.
    fn one(candidate: usize) -> Self;
    /// Mask of the first `candidates` candidates; of all if there are not so many.
    fn first(candidates: usize) -> Self;
    /// All or none.
    fn all_if(bit: bool) -> Self;
    /// Every candidate's bit one candidate on.
    fn doubled(self) -> Self;
    /// The last candidate's bit for the first.
    fn highest(self) -> Self;
    /// The low bits.
    fn of_signed(word: i32) -> Self;
    /// Place of the lowest bit; the last if there is none.
    fn lowest(self) -> usize;
    /// In a word.
    fn bits(self) -> u32;
}

macro_rules! plane {
    ($plane:ty, $of_words:expr, $of_bytes:expr) => {
        impl Plane for $plane {
            const CANDIDATES: usize = <$plane>::BITS as usize;
            const NONE: Self = 0;
            const ALL: Self = <$plane>::MAX;

            #[inline(always)]
            fn of_bytes(bytes: &mut [u8]) -> &mut [Self] {
                $of_bytes(bytes)
            }

            #[inline(always)]
            fn of_words(words: &mut [u32]) -> &mut [Self] {
                $of_words(words)
            }

            #[inline(always)]
            fn one(candidate: usize) -> Self {
                1 << (candidate % Self::CANDIDATES)
            }

            #[inline(always)]
            fn first(candidates: usize) -> Self {
                if candidates < Self::CANDIDATES { (1 << candidates) - 1 } else { Self::ALL }
            }

            #[inline(always)]
            fn all_if(bit: bool) -> Self {
                Self::from(bit).wrapping_neg()
            }

            #[inline(always)]
            fn doubled(self) -> Self {
                self << 1
            }

            #[inline(always)]
            fn highest(self) -> Self {
                self >> (Self::BITS - 1)
            }

            #[inline(always)]
            fn of_signed(word: i32) -> Self {
                word as Self
            }

            #[inline(always)]
            fn lowest(self) -> usize {
                (self | 1 << (Self::BITS - 1)).trailing_zeros() as usize
            }

            #[inline(always)]
            fn bits(self) -> u32 {
                u32::from(self)
            }
        }
    };
}

plane!(u32, |words| words, view_mut::<u8, u32>);
plane!(u16, view_mut::<u32, u16>, |bytes| view_mut::<u32, u16>(view_mut::<u8, u32>(bytes)));

/// Bit `i` of a word for all candidates.
#[inline(always)]
pub(super) fn of_bit<P: Plane>(word: u32, i: usize) -> P {
    P::all_if(word >> i & 1 != 0)
}

/// Bit `i` of a word for the first candidate, bit `i + 1` for all others.
#[inline(always)]
pub(super) fn two_bits<P: Plane>(word: u32, i: usize) -> P {
    P::of_signed((word << (30 - i)) as i32 >> 30)
}

/// Adds two bits to a third, whose place is the sum's; what is carried.
#[inline(always)]
pub(super) fn add_pair<P: Plane>(sum: &mut P, a: P, b: P) -> P {
    let half = a ^ b;
    let carry = a ^ (half & (a ^ *sum));
    *sum = half ^ *sum;
    carry
}
