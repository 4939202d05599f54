//! NEON registers, which every 64-bit Arm processor has.
#![allow(unsafe_code)]
// To compilers later than the oldest that is supported some of the instructions are safe.
#![allow(unused_unsafe)]

use super::half_words::HalfWords;
use super::registers::{AROUND, BITS_APART_OF_FOUR, half_words, register};
use crate::matching::backend::portable::group::Group;
use core::arch::aarch64::*;

/// 16 bytes in a register.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::matching) struct Vector(uint8x16_t);

/// Calls of intrinsics.
macro_rules! safely {
    ($work:expr) => {
        // SAFETY: every 64-bit Arm processor has NEON; the pointers are to arrays of a register's size.
        unsafe { $work }
    };
}

impl Group for Vector {
    register! {
        16 bytes, load vld1q_u8, store vst1q_u8, splat vdupq_n_u8,
        numbers u8 vdupq_n_u8,
        plus vaddq_u8, plus_saturating vqaddq_u8,
        minus vsubq_u8, minus_saturating vqsubq_u8,
        min vminq_u8, max vmaxq_u8,
        apart vabdq_u8,
        average_up vrhaddq_u8, average_down vhaddq_u8,
        or vorrq_u8, and vandq_u8,
        four_bits_apart vqtbl1q_u8,
    }

    #[inline(always)]
    fn quarter(self) -> Self {
        safely!(Self(vshrq_n_u8(self.0, 2)))
    }

    #[inline(always)]
    fn bits_apart(self, other: Self) -> Self {
        safely!(Self(vcntq_u8(veorq_u8(self.0, other.0))))
    }

    #[inline(always)]
    fn key_of_four(code: u8) -> Self {
        let bits = &BITS_APART_OF_FOUR[usize::from(code % 16)];
        safely!(Self(vld1q_u8(bits.as_ptr())))
    }

    #[inline(always)]
    fn after(self, before: Self) -> Self {
        safely!(Self(vextq_u8(before.0, self.0, 15)))
    }

    #[inline(always)]
    fn before(self, next: Self) -> Self {
        safely!(Self(vextq_u8(self.0, next.0, 1)))
    }

    #[inline(always)]
    fn least(self) -> Self {
        safely!(Self(vdupq_n_u8(vminvq_u8(self.0))))
    }
}

/// An instruction on half-words, of bytes.
macro_rules! of_half_words {
    ($($name:ident $instruction:ident),*) => {$(
        #[inline(always)]
        fn $name(a: uint8x16_t, b: uint8x16_t) -> uint8x16_t {
            safely!(vreinterpretq_u8_u16($instruction(vreinterpretq_u16_u8(a), vreinterpretq_u16_u8(b))))
        }
    )*};
}

of_half_words! { add vqaddq_u16, subtract vqsubq_u16, max vmaxq_u16 }

impl HalfWords for Vector {
    half_words! { sums add, differences subtract, greater max }

    #[inline(always)]
    fn on<const BY: usize>(self) -> Self {
        let none = Self::splat(0).0;
        safely!(Self(match BY {
            1 => vextq_u8(none, self.0, 14),
            2 => vextq_u8(none, self.0, 12),
            _ => vextq_u8(none, self.0, 8),
        }))
    }

    #[inline(always)]
    fn back<const BY: usize>(self) -> Self {
        let none = Self::splat(0).0;
        safely!(Self(match BY {
            1 => vextq_u8(self.0, none, 2),
            2 => vextq_u8(self.0, none, 4),
            _ => vextq_u8(self.0, none, 8),
        }))
    }
}

impl Vector {
    /// The last lane that has a number, which one has: see [`register`].
    #[inline(always)]
    fn last_lane_of(cells: &[Self], number: Self) -> usize {
        let mut place = 0;
        for (first, cell) in (0..).step_by(Self::LANES).zip(cells) {
            // Four bits for each lane that has it.
            let equal = safely!({
                let lanes = vreinterpretq_u16_u8(vceqq_u8(cell.0, number.0));
                vget_lane_u64(vreinterpret_u64_u8(vshrn_n_u16(lanes, 4)), 0)
            });
            let last = (first + 15usize).wrapping_sub(equal.leading_zeros() as usize / 4);
            place = if equal != 0 { last } else { place };
        }
        place
    }
}
