//! SIMD128 registers of WebAssembly: a module that has them is refused whole where they are not known.
#![allow(unsafe_code)]

use super::half_words::HalfWords;
use super::registers::{AROUND, BITS_APART_OF_FOUR, half_words, register};
use crate::matching::backend::portable::group::Group;
use core::arch::wasm32::*;

/// 16 bytes in a register.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::matching) struct Vector(v128);

/// Calls of intrinsics.
macro_rules! safely {
    ($work:expr) => {
        // SAFETY: the module is compiled for SIMD128 as a whole; the pointers are to arrays of a register's
        // size, without alignment. All but those that read and write memory are safe by themselves.
        #[allow(unused_unsafe)]
        unsafe {
            $work
        }
    };
}

impl Group for Vector {
    register! {
        16 bytes, load v128_load, store v128_store, splat u8x16_splat,
        numbers u8 u8x16_splat,
        plus u8x16_add, plus_saturating u8x16_add_sat,
        minus u8x16_sub, minus_saturating u8x16_sub_sat,
        min u8x16_min, max u8x16_max,
        average_up u8x16_avgr,
        or v128_or, and v128_and,
        four_bits_apart u8x16_swizzle,
    }

    #[inline(always)]
    fn apart(self, other: Self) -> Self {
        self.minus_saturating(other).or(other.minus_saturating(self))
    }

    #[inline(always)]
    fn average_down(self, other: Self) -> Self {
        Self(u8x16_shr(self.plus(other).0, 1))
    }

    #[inline(always)]
    fn quarter(self) -> Self {
        Self(u8x16_shr(self.0, 2))
    }

    #[inline(always)]
    fn bits_apart(self, other: Self) -> Self {
        Self(u8x16_popcnt(v128_xor(self.0, other.0)))
    }

    #[inline(always)]
    fn key_of_four(code: u8) -> Self {
        let bits = &BITS_APART_OF_FOUR[usize::from(code % 16)];
        Self::of(*bits)
    }

    #[inline(always)]
    fn after(self, before: Self) -> Self {
        Self(u8x16_shuffle::<15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30>(
            before.0, self.0,
        ))
    }

    #[inline(always)]
    fn before(self, next: Self) -> Self {
        Self(u8x16_shuffle::<1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16>(self.0, next.0))
    }

    #[inline(always)]
    fn least(self) -> Self {
        let eight = u8x16_min(self.0, u64x2_shuffle::<1, 0>(self.0, self.0));
        let four = u8x16_min(eight, u32x4_shuffle::<1, 0, 3, 2>(eight, eight));
        let two = u8x16_min(four, u16x8_shuffle::<1, 0, 3, 2, 5, 4, 7, 6>(four, four));
        let one = u8x16_min(two, u16x8_shr(two, 8));
        Self(u8x16_shuffle::<0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0>(one, one))
    }
}

impl HalfWords for Vector {
    half_words! { sums u16x8_add_sat, differences u16x8_sub_sat, greater u16x8_max }

    #[inline(always)]
    fn on<const BY: usize>(self) -> Self {
        let none = Self::splat(0).0;
        Self(match BY {
            1 => u16x8_shuffle::<7, 8, 9, 10, 11, 12, 13, 14>(none, self.0),
            2 => u16x8_shuffle::<6, 7, 8, 9, 10, 11, 12, 13>(none, self.0),
            _ => u16x8_shuffle::<4, 5, 6, 7, 8, 9, 10, 11>(none, self.0),
        })
    }

    #[inline(always)]
    fn back<const BY: usize>(self) -> Self {
        let none = Self::splat(0).0;
        Self(match BY {
            1 => u16x8_shuffle::<1, 2, 3, 4, 5, 6, 7, 8>(self.0, none),
            2 => u16x8_shuffle::<2, 3, 4, 5, 6, 7, 8, 9>(self.0, none),
            _ => u16x8_shuffle::<4, 5, 6, 7, 8, 9, 10, 11>(self.0, none),
        })
    }
}

impl Vector {
    /// The last lane that has a number, which one has: see [`register`].
    #[inline(always)]
    fn last_lane_of(cells: &[Self], number: Self) -> usize {
        let mut place = 0;
        for (first, cell) in (0..).step_by(Self::LANES).zip(cells) {
            // A bit for each lane that has it.
            let equal = u8x16_bitmask(u8x16_eq(cell.0, number.0));
            let last = (first + 15usize).wrapping_sub(equal.leading_zeros() as usize);
            place = if equal != 0 { last } else { place };
        }
        place
    }
}
