//! SSE2 registers, which every x86-64 processor has.
#![allow(unsafe_code)]

use super::half_words::HalfWords;
use super::registers::{AROUND, by_shifts, half_words, register};
use crate::matching::backend::portable::group::Group;
use core::arch::x86_64::*;

/// 16 bytes in a register.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::matching) struct Vector(__m128i);

/// Calls of intrinsics.
macro_rules! safely {
    ($work:expr) => {
        // SAFETY: every x86-64 processor has SSE2; the pointers are to arrays of a register's size, without
        // alignment.
        unsafe { $work }
    };
}

impl Group for Vector {
    register! {
        16 bytes, load _mm_loadu_si128, store _mm_storeu_si128, splat _mm_set1_epi8,
        numbers u8 _mm_set1_epi8,
        plus _mm_add_epi8, plus_saturating _mm_adds_epu8,
        minus _mm_sub_epi8, minus_saturating _mm_subs_epu8,
        min _mm_min_epu8, max _mm_max_epu8,
        average_up _mm_avg_epu8,
        or _mm_or_si128, and _mm_and_si128,
    }

    by_shifts!();

    #[inline(always)]
    fn apart(self, other: Self) -> Self {
        self.minus_saturating(other).or(other.minus_saturating(self))
    }

    #[inline(always)]
    fn bits_apart(self, other: Self) -> Self {
        safely!({
            let mask = |bits: i8| _mm_set1_epi8(bits);
            let bits = _mm_xor_si128(self.0, other.0);
            let pairs = _mm_sub_epi8(bits, _mm_and_si128(_mm_srli_epi16(bits, 1), mask(0x55)));
            let high = _mm_and_si128(_mm_srli_epi16(pairs, 2), mask(0x33));
            let fours = _mm_add_epi8(_mm_and_si128(pairs, mask(0x33)), high);
            Self(_mm_and_si128(_mm_add_epi8(fours, _mm_srli_epi16(fours, 4)), mask(0x0f)))
        })
    }

    #[inline(always)]
    fn key_of_four(code: u8) -> Self {
        Self::splat(code)
    }

    #[inline(always)]
    fn four_bits_apart(self, others: Self) -> Self {
        safely!({
            let mask = |bits: i8| _mm_set1_epi8(bits);
            let bits = _mm_xor_si128(self.0, others.0);
            let pairs = _mm_sub_epi8(bits, _mm_and_si128(_mm_srli_epi16(bits, 1), mask(0x05)));
            Self(_mm_add_epi8(
                _mm_and_si128(pairs, mask(0x03)),
                _mm_and_si128(_mm_srli_epi16(pairs, 2), mask(0x03)),
            ))
        })
    }

    #[inline(always)]
    fn after(self, before: Self) -> Self {
        safely!(Self(_mm_or_si128(_mm_slli_si128(self.0, 1), _mm_srli_si128(before.0, 15))))
    }

    #[inline(always)]
    fn before(self, next: Self) -> Self {
        safely!(Self(_mm_or_si128(_mm_srli_si128(self.0, 1), _mm_slli_si128(next.0, 15))))
    }

    #[inline(always)]
    fn least(self) -> Self {
        safely!({
            let eight = _mm_min_epu8(self.0, _mm_srli_si128(self.0, 8));
            let four = _mm_min_epu8(eight, _mm_srli_si128(eight, 4));
            let two = _mm_min_epu8(four, _mm_srli_epi32(four, 16));
            let one = _mm_min_epu8(two, _mm_srli_epi16(two, 8));
            // Its first byte: of the first half-word, of the first two, of all.
            let one = _mm_unpacklo_epi8(one, one);
            Self(_mm_shuffle_epi32(_mm_shufflelo_epi16(one, 0), 0))
        })
    }
}

impl HalfWords for Vector {
    half_words! { sums _mm_adds_epu16, differences _mm_subs_epu16 }

    #[inline(always)]
    fn on<const BY: usize>(self) -> Self {
        safely!(Self(match BY {
            1 => _mm_slli_si128(self.0, 2),
            2 => _mm_slli_si128(self.0, 4),
            _ => _mm_slli_si128(self.0, 8),
        }))
    }

    #[inline(always)]
    fn back<const BY: usize>(self) -> Self {
        safely!(Self(match BY {
            1 => _mm_srli_si128(self.0, 2),
            2 => _mm_srli_si128(self.0, 4),
            _ => _mm_srli_si128(self.0, 8),
        }))
    }
}

impl Vector {
    /// Each number, shifted to the right.
    #[inline(always)]
    fn shifted_right<const BY: i32>(self) -> Self {
        safely!(Self(_mm_srli_epi16::<BY>(self.0))).and(Self::splat(0xff >> BY))
    }

    /// The last lane that has a number, which one has: see [`register`].
    #[inline(always)]
    fn last_lane_of(cells: &[Self], number: Self) -> usize {
        // A bit for each lane that has it, of 64 at a time.
        let mut place = 0;
        for (first, cells) in (0..).step_by(64).zip(cells.chunks(4)) {
            let equal = cells.iter().rev().fold(
                0u64,
                #[inline(always)]
                |bits, cell| {
                    bits << 16
                        | u64::from(safely!(_mm_movemask_epi8(_mm_cmpeq_epi8(cell.0, number.0))) as u32)
                },
            );
            let last = (first | 63usize) - (equal | 1).leading_zeros() as usize;
            place = if equal != 0 { last } else { place };
        }
        place
    }
}
