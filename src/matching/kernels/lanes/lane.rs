//! The integers that window sums are made of.

use crate::matching::kernels::scratch::{bytes_mut, halves_mut};

/// A window's sum in a vector's lane, above as many bits as [`Lane::NUMBER_BITS`] for the lane's own number: where there
/// are some, one comparison finds the least sum and its place.
pub trait Lane: Copy + Ord + 'static {
    /// Bits below the sum.
    const NUMBER_BITS: u32;
    /// The largest number that [`Lane::INDICES`] has.
    const NUMBERS: Self;
    /// More than any sum with its number: what a lane counts that is no candidate.
    const MAX: Self;
    /// 256 lanes of zero, then 256 of [`Self::MAX`]: a slice of it masks the lanes from any one on.
    const MASKS: &'static [Self; 512];
    /// The numbers 0 to 255, each as far as a lane holds it: with its own number in a lane that has one, with all of
    /// it in one that has none.
    const INDICES: &'static [Self; 256];
    /// Words as lanes.
    fn of_words(words: &mut [u32]) -> &mut [Self];
    /// The sum with a column's sum added and another's taken off.
    fn moved(self, enters: u8, leaves: u8) -> Self;
    /// [`Self::MAX`] where the two are not equal, else nothing.
    fn differs(self, other: Self) -> Self;
    /// Bitwise or.
    fn or(self, other: Self) -> Self;
    /// The sum.
    fn cost(self) -> u32;
    /// The number.
    fn number(self) -> u32;
}

macro_rules! lane {
    ($lane:ty, $bits:literal, $of_words:expr) => {
        impl Lane for $lane {
            const NUMBER_BITS: u32 = $bits;
            const NUMBERS: Self = if $bits > 0 { (1 << $bits) - 1 } else { Self::MAX };
            const MAX: Self = <$lane>::MAX;
            const MASKS: &'static [Self; 512] = &{
                let mut masks = [0; 512];
                let mut i = 256;
                while i < 512 {
                    masks[i] = <$lane>::MAX;
                    i += 1;
                }
                masks
            };
            const INDICES: &'static [Self; 256] = &{
                let mut indices = [0; 256];
                let mut i = 0;
                while i < 256 {
                    indices[i] = i as $lane & Self::NUMBERS;
                    i += 1;
                }
                indices
            };

            #[inline(always)]
            fn of_words(words: &mut [u32]) -> &mut [Self] {
                $of_words(words)
            }

            #[inline(always)]
            fn moved(self, enters: u8, leaves: u8) -> Self {
                let change = (enters as $lane).wrapping_sub(leaves as $lane);
                self.wrapping_add(change << $bits)
            }

            #[inline(always)]
            fn differs(self, other: Self) -> Self {
                if self != other { Self::MAX } else { 0 }
            }

            #[inline(always)]
            fn or(self, other: Self) -> Self {
                self | other
            }

            #[inline(always)]
            fn cost(self) -> u32 {
                u32::from(self >> $bits)
            }

            #[inline(always)]
            fn number(self) -> u32 {
                u32::from(self) & ((1 << $bits) - 1)
            }
        }
    };
}

lane!(u8, 0, bytes_mut);
lane!(u16, 6, halves_mut);
