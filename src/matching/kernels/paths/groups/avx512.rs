//! AVX-512 registers. Only the code that is compiled for AVX-512, behind its proof, makes one.
#![allow(unsafe_code)]

use super::group::Group;
use super::registers::register;
use core::arch::x86_64::*;

/// 64 bytes in a register.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::matching) struct Widest(__m512i);

/// Calls of intrinsics.
macro_rules! safely {
    ($work:expr) => {
        // SAFETY: only code that runs behind the proof that the processor has AVX-512 is given groups of this kind; the
        // pointers are to arrays of a register's size, without alignment.
        unsafe { $work }
    };
}

impl Group for Widest {
    register!(64);

    #[inline(always)]
    fn of(cell: Self::Cell) -> Self {
        safely!(Self(_mm512_loadu_si512(cell.as_ptr().cast())))
    }

    #[inline(always)]
    fn cell(self) -> Self::Cell {
        let mut cell = [0; 64];
        safely!(_mm512_storeu_si512(cell.as_mut_ptr().cast(), self.0));
        cell
    }

    #[inline(always)]
    fn splat(number: u8) -> Self {
        safely!(Self(_mm512_set1_epi8(number as i8)))
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        safely!(Self(_mm512_add_epi8(self.0, other.0)))
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        safely!(Self(_mm512_sub_epi8(self.0, other.0)))
    }

    #[inline(always)]
    fn plus_saturating(self, other: Self) -> Self {
        safely!(Self(_mm512_adds_epu8(self.0, other.0)))
    }

    #[inline(always)]
    fn minus_saturating(self, other: Self) -> Self {
        safely!(Self(_mm512_subs_epu8(self.0, other.0)))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        safely!(Self(_mm512_min_epu8(self.0, other.0)))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        safely!(Self(_mm512_max_epu8(self.0, other.0)))
    }

    #[inline(always)]
    fn average_up(self, other: Self) -> Self {
        safely!(Self(_mm512_avg_epu8(self.0, other.0)))
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        safely!(Self(_mm512_or_si512(self.0, other.0)))
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        safely!(Self(_mm512_and_si512(self.0, other.0)))
    }

    #[inline(always)]
    fn apart(self, other: Self) -> Self {
        self.minus_saturating(other).or(other.minus_saturating(self))
    }

    #[inline(always)]
    fn average_down(self, other: Self) -> Self {
        safely!(Self(_mm512_and_si512(_mm512_srli_epi16(_mm512_add_epi8(self.0, other.0), 1), _mm512_set1_epi8(0x7f))))
    }

    #[inline(always)]
    fn quarter(self) -> Self {
        safely!(Self(_mm512_and_si512(_mm512_srli_epi16(self.0, 2), _mm512_set1_epi8(0x3f))))
    }

    #[inline(always)]
    fn bits_apart(self, other: Self) -> Self {
        safely!({
            // The bits of a nibble, looked up.
            let bits = _mm512_broadcast_i32x4(_mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
            let nibble = _mm512_set1_epi8(0x0f);
            let apart = _mm512_xor_si512(self.0, other.0);
            let low = _mm512_shuffle_epi8(bits, _mm512_and_si512(apart, nibble));
            let high = _mm512_shuffle_epi8(bits, _mm512_and_si512(_mm512_srli_epi16(apart, 4), nibble));
            Self(_mm512_add_epi8(low, high))
        })
    }

    // In quarters of a register, moved on by a quarter and then by a byte.

    #[inline(always)]
    fn after(self, before: Self) -> Self {
        safely!(Self(_mm512_alignr_epi8(self.0, _mm512_alignr_epi64(self.0, before.0, 6), 15)))
    }

    #[inline(always)]
    fn before(self, next: Self) -> Self {
        safely!(Self(_mm512_alignr_epi8(_mm512_alignr_epi64(next.0, self.0, 2), self.0, 1)))
    }

    #[inline(always)]
    fn least(self) -> Self {
        safely!({
            let half = _mm256_min_epu8(_mm512_castsi512_si256(self.0), _mm512_extracti64x4_epi64(self.0, 1));
            let quarter = _mm_min_epu8(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
            // The lesser byte of each half-word, of which one instruction finds the least.
            let halves = _mm_min_epu8(quarter, _mm_srli_epi16(quarter, 8));
            Self(_mm512_broadcastb_epi8(_mm_minpos_epu16(halves)))
        })
    }
}

impl Widest {
    /// The last lane that has a number, which one has: see [`register`].
    #[inline(always)]
    fn last_lane_of(cells: &[Self], number: Self) -> usize {
        let mut place = 0;
        for (first, cell) in (0..).step_by(64).zip(cells) {
            // A bit for each lane that has it.
            let equal = safely!(_mm512_cmpeq_epi8_mask(cell.0, number.0));
            let last = (first | 63usize) - (equal | 1).leading_zeros() as usize;
            place = if equal != 0 { last } else { place };
        }
        place
    }
}
