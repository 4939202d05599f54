//! AVX2 registers. Only the code that is compiled for AVX2, behind its proof, makes one.
#![allow(unsafe_code)]

use super::half_words::HalfWords;
use super::registers::{AROUND, BITS_APART_OF_FOUR, by_shifts, half_words, register};
use super::x86::partners::Places;
use crate::matching::backend::portable::group::Group;
use core::arch::x86_64::*;

/// 32 bytes in a register; whether AVX-512's instructions on such registers are used.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::matching) struct Bytes32<const BY_AVX512: bool>(__m256i);

/// A register of AVX2.
pub(in crate::matching) type Wide = Bytes32<false>;
/// A register of AVX2 with AVX-512's instructions.
pub(in crate::matching) type WideByAvx512 = Bytes32<true>;

/// For each lane the one before it, for the first one itself.
pub(super) const fn lanes_before<const LANES: usize>() -> [u8; LANES] {
    const {
        let mut lanes = [0; LANES];
        let mut lane = 1;
        while lane < LANES {
            lanes[lane] = lane as u8 - 1;
            lane += 1;
        }
        lanes
    }
}

/// For each lane the one after it, for the last one itself.
pub(super) const fn lanes_after<const LANES: usize>() -> [u8; LANES] {
    const {
        let mut lanes = [LANES as u8 - 1; LANES];
        let mut lane = 1;
        while lane < LANES {
            lanes[lane - 1] = lane as u8;
            lane += 1;
        }
        lanes
    }
}

/// The matrix that GFNI multiplies the bits of a byte by to shift them to the right by some places.
pub(super) const fn shift_right(by: i32) -> i64 {
    0x0102_0408_1020_4080u64.wrapping_shl(8 * by as u32) as i64
}

/// How many lanes there are after each of 256.
pub(super) const LANES_AFTER: &[u8; 256] = &{
    let mut lanes = [0; 256];
    let mut lane = 0;
    while lane < 256 {
        lanes[lane] = 255 - lane as u8;
        lane += 1;
    }
    lanes
};

/// Calls of intrinsics.
macro_rules! safely {
    ($work:expr) => {
        // SAFETY: only code that runs behind the proof that the processor has AVX2, or AVX-512, is given
        // groups of this kind; the pointers are to arrays of a register's size, without alignment.
        unsafe { $work }
    };
}

impl<const BY_AVX512: bool> Group for Bytes32<BY_AVX512> {
    register! {
        32 bytes, load _mm256_loadu_si256, store _mm256_storeu_si256, splat _mm256_set1_epi8,
        numbers u8 _mm256_set1_epi8,
        plus _mm256_add_epi8, plus_saturating _mm256_adds_epu8,
        minus _mm256_sub_epi8, minus_saturating _mm256_subs_epu8,
        min _mm256_min_epu8, max _mm256_max_epu8,
        average_up _mm256_avg_epu8,
        or _mm256_or_si256, and _mm256_and_si256,
        four_bits_apart _mm256_shuffle_epi8,
    }

    by_shifts!();

    #[inline(always)]
    fn apart(self, other: Self) -> Self {
        safely!(Self(_mm256_abs_epi8(_mm256_sub_epi8(self.0, other.0))))
    }

    #[inline(always)]
    fn bits_apart(self, other: Self) -> Self {
        if BY_AVX512 {
            return safely!(Self(_mm256_popcnt_epi8(_mm256_xor_si256(self.0, other.0))));
        }
        safely!({
            // The bits of a nibble, looked up.
            let bits = _mm256_setr_epi8(
                0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4, 0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3,
                4,
            );
            let nibble = _mm256_set1_epi8(0x0f);
            let apart = _mm256_xor_si256(self.0, other.0);
            let low = _mm256_shuffle_epi8(bits, _mm256_and_si256(apart, nibble));
            let high = _mm256_shuffle_epi8(bits, _mm256_and_si256(_mm256_srli_epi16(apart, 4), nibble));
            Self(_mm256_add_epi8(low, high))
        })
    }

    #[inline(always)]
    fn key_of_four(code: u8) -> Self {
        let bits = &BITS_APART_OF_FOUR[usize::from(code % 16)];
        safely!(Self(_mm256_broadcastsi128_si256(_mm_loadu_si128(bits.as_ptr().cast()))))
    }

    #[inline(always)]
    fn after(self, before: Self) -> Self {
        safely!(Self(_mm256_alignr_epi8(self.0, _mm256_permute2x128_si256(before.0, self.0, 0x21), 15)))
    }

    #[inline(always)]
    fn before(self, next: Self) -> Self {
        safely!(Self(_mm256_alignr_epi8(_mm256_permute2x128_si256(self.0, next.0, 0x21), self.0, 1)))
    }

    #[inline(always)]
    fn after_end(self, before: Self) -> Self {
        if BY_AVX512 {
            return safely!(Self(_mm256_permutexvar_epi8(Self::of(lanes_before()).0, self.0)));
        }
        self.after(before)
    }

    #[inline(always)]
    fn before_end(self, next: Self) -> Self {
        if BY_AVX512 {
            return safely!(Self(_mm256_permutexvar_epi8(Self::of(lanes_after()).0, self.0)));
        }
        self.before(next)
    }

    #[inline(always)]
    fn least(self) -> Self {
        safely!({
            let half = _mm_min_epu8(_mm256_castsi256_si128(self.0), _mm256_extracti128_si256(self.0, 1));
            // The lesser byte of each half-word, of which one instruction finds the least.
            let halves = _mm_min_epu8(half, _mm_srli_epi16(half, 8));
            Self(_mm256_broadcastb_epi8(_mm_minpos_epu16(halves)))
        })
    }

    #[inline(always)]
    fn last_least_by_keys(cells: &[Self]) -> (u8, usize) {
        safely!({
            let mut least = _mm256_set1_epi8(-1);
            for (cell, after) in cells.iter().zip(Self::groups(LANES_AFTER)) {
                let after = Self::of_bytes(*after).0;
                let keys = (_mm256_unpacklo_epi8(after, cell.0), _mm256_unpackhi_epi8(after, cell.0));
                least = _mm256_min_epu16(least, _mm256_min_epu16(keys.0, keys.1));
            }
            least_key(_mm_min_epu16(_mm256_castsi256_si128(least), _mm256_extracti128_si256(least, 1)))
        })
    }
}

/// The least of eight keys: its number, and its place among 256 lanes.
#[inline(always)]
pub(super) fn least_key(keys: __m128i) -> (u8, usize) {
    let key = safely!(_mm_cvtsi128_si32(_mm_minpos_epu16(keys)));
    ((key >> 8) as u8, 255 - usize::from(key as u8))
}

impl Places for Wide {
    #[inline(always)]
    fn at(self, places: Self) -> Self {
        // A lookup is among 16 lanes, and zero where a place has its top bit set.
        let in_half = |half: __m256i, places: Self| {
            let place = places.plus_saturating(Self::splat(0x70));
            safely!(Self(_mm256_shuffle_epi8(half, place.0)))
        };
        let halves = safely!([
            _mm256_permute2x128_si256(self.0, self.0, 0x00),
            _mm256_permute2x128_si256(self.0, self.0, 0x11),
        ]);
        in_half(halves[0], places).or(in_half(halves[1], places.minus(Self::splat(16))))
    }
}

impl<const BY_AVX512: bool> HalfWords for Bytes32<BY_AVX512> {
    half_words! { sums _mm256_adds_epu16, differences _mm256_subs_epu16, greater _mm256_max_epu16 }

    #[inline(always)]
    fn on<const BY: usize>(self) -> Self {
        safely!({
            // Zeros, and then the first half.
            let half = _mm256_permute2x128_si256(self.0, self.0, 0x08);
            Self(match BY {
                1 => _mm256_alignr_epi8(self.0, half, 14),
                2 => _mm256_alignr_epi8(self.0, half, 12),
                4 => _mm256_alignr_epi8(self.0, half, 8),
                _ => half,
            })
        })
    }

    #[inline(always)]
    fn back<const BY: usize>(self) -> Self {
        safely!({
            // The second half, and then zeros.
            let half = _mm256_permute2x128_si256(self.0, self.0, 0x81);
            Self(match BY {
                1 => _mm256_alignr_epi8(half, self.0, 2),
                2 => _mm256_alignr_epi8(half, self.0, 4),
                4 => _mm256_alignr_epi8(half, self.0, 8),
                _ => half,
            })
        })
    }
}

impl<const BY_AVX512: bool> Bytes32<BY_AVX512> {
    /// Each number, shifted to the right.
    #[inline(always)]
    fn shifted_right<const BY: i32>(self) -> Self {
        if BY_AVX512 {
            let shift = safely!(_mm256_set1_epi64x(const { shift_right(BY) }));
            return safely!(Self(_mm256_gf2p8affine_epi64_epi8::<0>(self.0, shift)));
        }
        safely!(Self(_mm256_srli_epi16::<BY>(self.0))).and(Self::splat(0xff >> BY))
    }

    /// The last lane that has a number, which one has: see [`register`].
    #[inline(always)]
    fn last_lane_of(cells: &[Self], number: Self) -> usize {
        // A bit for each lane that has it, of 64 at a time.
        let mut place = 0;
        for (first, pair) in (0..).step_by(64).zip(cells.chunks(2)) {
            let equal = pair.iter().rev().fold(
                0u64,
                #[inline(always)]
                |bits, cell| {
                    bits << 32
                        | u64::from(safely!(_mm256_movemask_epi8(_mm256_cmpeq_epi8(cell.0, number.0))) as u32)
                },
            );
            let last = (first | 63usize).wrapping_sub(equal.leading_zeros() as usize);
            place = if equal != 0 || cells.len() <= 2 { last } else { place };
        }
        place
    }
}
