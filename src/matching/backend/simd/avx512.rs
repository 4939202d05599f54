//! AVX-512 registers. Only the code that is compiled for AVX-512, behind its proof, makes one.
#![allow(unsafe_code)]

use super::avx2::{LANES_AFTER, lanes_after, lanes_before, least_key, shift_right};
use super::half_words::HalfWords;
use super::registers::{AROUND, BITS_APART_OF_FOUR, by_shifts, half_words, register};
use super::x86::partners::{Places, offer_each};
use crate::matching::backend::portable::group::Group;
use crate::matching::memory::slices::part;
use core::arch::x86_64::*;

/// Bytes in a register.
const BYTES: usize = 64;

/// 64 bytes in a register.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::matching) struct Widest(__m512i);

/// Calls of intrinsics.
macro_rules! safely {
    ($work:expr) => {
        // SAFETY: only code that runs behind the proof that the processor has AVX-512 is given groups of this
        // kind; the pointers are to arrays of a register's size, without alignment.
        unsafe { $work }
    };
}

impl Group for Widest {
    register! {
        64 bytes, load _mm512_loadu_si512, store _mm512_storeu_si512, splat _mm512_set1_epi8,
        numbers u32 _mm512_set1_epi32,
        plus _mm512_add_epi8, plus_saturating _mm512_adds_epu8,
        minus _mm512_sub_epi8, minus_saturating _mm512_subs_epu8,
        min _mm512_min_epu8, max _mm512_max_epu8,
        average_up _mm512_avg_epu8,
        or _mm512_or_si512, and _mm512_and_si512,
        four_bits_apart _mm512_shuffle_epi8,
    }

    by_shifts!();

    #[inline(always)]
    fn bits_apart(self, other: Self) -> Self {
        safely!(Self(_mm512_popcnt_epi8(_mm512_xor_si512(self.0, other.0))))
    }

    #[inline(always)]
    fn key_of_four(code: u8) -> Self {
        let bits = &BITS_APART_OF_FOUR[usize::from(code % 16)];
        safely!(Self(_mm512_broadcast_i32x4(_mm_loadu_si128(bits.as_ptr().cast()))))
    }

    #[inline(always)]
    fn moved(self, here: &Self::Bytes) -> Self {
        let [.., a, b, c, last] = *here;
        // The last number and those before it, again and again: in the last lane the last one.
        let ends = Self::splat_number(u32::from_le_bytes([a, b, c, last]));
        safely!({
            let after = Self::of(lanes_after()).0;
            Self(_mm512_mask_permutexvar_epi8(ends.0, u64::MAX >> 1, after, self.0))
        })
    }

    #[inline(always)]
    fn apart(self, other: Self) -> Self {
        safely!(Self(_mm512_abs_epi8(_mm512_sub_epi8(self.0, other.0))))
    }

    // By sixteen bytes, and then within them: on some processors two thirds of the work of a permutation of
    // two registers.
    #[inline(always)]
    fn after(self, before: Self) -> Self {
        safely!({
            let sixteen_before = _mm512_alignr_epi64(self.0, before.0, 6);
            Self(_mm512_alignr_epi8(self.0, sixteen_before, 15))
        })
    }

    #[inline(always)]
    fn before(self, next: Self) -> Self {
        safely!({
            let sixteen_after = _mm512_alignr_epi64(next.0, self.0, 2);
            Self(_mm512_alignr_epi8(sixteen_after, self.0, 1))
        })
    }

    // Of one register: on some processors a third of the work of two.
    #[inline(always)]
    fn after_end(self, _: Self) -> Self {
        safely!(Self(_mm512_permutexvar_epi8(Self::of(lanes_before()).0, self.0)))
    }

    #[inline(always)]
    fn before_end(self, _: Self) -> Self {
        safely!(Self(_mm512_permutexvar_epi8(Self::of(lanes_after()).0, self.0)))
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

    #[inline(always)]
    fn lanes(self, [a, b]: [usize; 2]) -> [u8; 2] {
        let [a, b, ..] = safely!({
            let lanes = _mm512_castsi128_si512(_mm_cvtsi32_si128((a | b << 8) as i32));
            _mm_cvtsi128_si32(_mm512_castsi512_si128(_mm512_permutexvar_epi8(lanes, self.0)))
        })
        .to_le_bytes();
        [a, b]
    }

    #[inline(always)]
    fn last_least_by_keys(cells: &[Self]) -> (u8, usize) {
        safely!({
            let mut least = _mm512_set1_epi8(-1);
            for (cell, after) in cells.iter().zip(Self::groups(LANES_AFTER)) {
                let after = Self::of_bytes(*after).0;
                let keys = (_mm512_unpacklo_epi8(after, cell.0), _mm512_unpackhi_epi8(after, cell.0));
                least = _mm512_min_epu16(least, _mm512_min_epu16(keys.0, keys.1));
            }
            let half = _mm256_min_epu16(_mm512_castsi512_si256(least), _mm512_extracti64x4_epi64(least, 1));
            least_key(_mm_min_epu16(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1)))
        })
    }
}

/// The numbers of half-words, twice.
const PLACES: &[u16; 64] = &{
    let mut places = [0; 64];
    let mut place = 0;
    while place < 64 {
        places[place] = place as u16 % 32;
        place += 1;
    }
    places
};

impl HalfWords for Widest {
    half_words! { sums _mm512_adds_epu16, differences _mm512_subs_epu16, greater _mm512_max_epu16 }

    #[inline(always)]
    fn on<const BY: usize>(self) -> Self {
        safely!({
            let from = _mm512_loadu_si512(PLACES.as_ptr().add(32 - BY % 32).cast());
            Self(_mm512_maskz_permutexvar_epi16(u32::MAX << BY, from, self.0))
        })
    }

    #[inline(always)]
    fn back<const BY: usize>(self) -> Self {
        safely!({
            let from = _mm512_loadu_si512(PLACES.as_ptr().add(BY % 32).cast());
            Self(_mm512_maskz_permutexvar_epi16(u32::MAX >> BY, from, self.0))
        })
    }
}

impl Widest {
    /// Each number, shifted to the right.
    #[inline(always)]
    fn shifted_right<const BY: i32>(self) -> Self {
        let shift = safely!(_mm512_set1_epi64(const { shift_right(BY) }));
        safely!(Self(_mm512_gf2p8affine_epi64_epi8::<0>(self.0, shift)))
    }

    /// The last lane that has a number, which one has: see [`register`].
    #[inline(always)]
    fn last_lane_of(cells: &[Self], number: Self) -> usize {
        let mut place = 0;
        for (first, cell) in (0..).step_by(64).zip(cells) {
            // A bit for each lane that has it.
            let equal = safely!(_mm512_cmpeq_epi8_mask(cell.0, number.0));
            let last = (first | 63usize).wrapping_sub(equal.leading_zeros() as usize);
            place = if equal != 0 || cells.len() == 1 { last } else { place };
        }
        place
    }
}

impl Places for Widest {
    #[inline(always)]
    fn of_first(row: &[u8]) -> Self {
        let Some(cell) = row.first_chunk() else {
            let lanes = (1 << row.len()) - 1;
            // SAFETY: as above. Of what is in memory only the bytes of the row are read, fewer than lanes.
            return unsafe { Self(_mm512_maskz_loadu_epi8(lanes, row.as_ptr().cast())) };
        };
        Self::of(*cell)
    }

    #[inline(always)]
    fn at(self, places: Self) -> Self {
        safely!({
            let is_inside = _mm512_cmplt_epu8_mask(places.0, Self::splat(BYTES as u8).0);
            Self(_mm512_maskz_permutexvar_epi8(is_inside, places.0, self.0))
        })
    }

    #[inline(always)]
    fn offer(costs: &[u8], disparities: &[u8], candidates: usize, right: &mut [u16], kept: &mut [u8]) {
        if candidates <= FEW {
            offer_few(costs, disparities, candidates, kept);
        } else {
            offer_each(costs, disparities, right, kept);
        }
    }
}

/// Of how many candidates [`offer_few`] takes less than one winner after the other.
const FEW: usize = 32;

/// Offers of winners among few candidates, to 64 right columns at a time, of which the disparities alone are
/// kept: four instructions for 64 evaluations, whatever the picture.
#[inline(always)]
fn offer_few(costs: &[u8], disparities: &[u8], candidates: usize, right: &mut [u8]) {
    for (first, right) in (0..).step_by(BYTES).zip(right.chunks_mut(BYTES)) {
        let mut kept = Kept::of_nobody(candidates);
        let [costs, disparities] = [part(costs, first..), part(disparities, first..)];
        let whole = candidates.min((costs.len() + 1).saturating_sub(BYTES));
        for at in (whole..candidates).rev() {
            let offered = [costs, disparities].map(
                #[inline(always)]
                |row| Widest::of_first(row.get(at..).unwrap_or_default()),
            );
            kept.offer(offered);
        }
        let [costs, disparities] = [costs, disparities].map(
            #[inline(always)]
            |row| row.get(..whole + BYTES - 1).unwrap_or_default().windows(BYTES).rev(),
        );
        for (costs, disparities) in costs.zip(disparities) {
            kept.offer([Widest::of_first(costs), Widest::of_first(disparities)]);
        }
        kept.disparities.put_first(right);
    }
}

/// What 64 right columns keep: the least cost, and the disparity of the left pixel that offered it.
struct Kept {
    costs: Widest,
    disparities: Widest,
    /// The disparity of those who offered last.
    last: Widest,
}

impl Kept {
    /// Before the last of the candidates offers.
    #[inline(always)]
    fn of_nobody(candidates: usize) -> Self {
        let none = Widest::splat(u8::MAX);
        Self { costs: none, disparities: none, last: Widest::splat(candidates as u8) }
    }

    /// Offers the winners that are the next nearer candidate, among the left pixels that it would be of:
    /// their costs and disparities. Of equal costs the nearest stays.
    #[inline(always)]
    fn offer(&mut self, [costs, disparities]: [Widest; 2]) {
        self.last = self.last.minus(Widest::splat(1));
        let (last, kept) = (self.last.0, self.costs.0);
        safely!({
            let offered = _mm512_cmpeq_epi8_mask(disparities.0, last);
            let is_less = _mm512_mask_cmple_epu8_mask(offered, costs.0, kept);
            self.costs.0 = _mm512_mask_min_epu8(kept, offered, costs.0, kept);
            self.disparities.0 = _mm512_mask_mov_epi8(self.disparities.0, is_less, last);
        });
    }
}
