//! The kernel in lanes compiled for AVX2 and for AVX-512, and unrolled for the usual numbers of disparities.
#![allow(unsafe_code)]

use super::{RowWork, Select, lanes};
use crate::matching::window::Windowed;
use core::arch::x86_64::*;

cpufeatures::new!(avx2, "avx2");
// What every processor with operations on bytes in 512 bits has: level 4 of x86-64.
cpufeatures::new!(avx512, "avx2", "avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl");

/// Proof that the processor has AVX2: only [`Avx2::detect`] makes one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Avx2(());

impl Avx2 {
    pub(super) fn detect() -> Option<Self> {
        avx2::get().then_some(Self(()))
    }

    /// Does something that is compiled for AVX2 as far as it is inlined.
    #[inline(always)]
    pub(super) fn run(self, work: impl FnOnce()) {
        // SAFETY: `self` is the proof that the processor has the one feature that the function is compiled for.
        unsafe { run(work) }
    }

    /// A row whose columns are whole registers: of 32 lanes.
    #[inline]
    pub(super) fn row<S: Windowed>(self, work: RowWork<'_>, select: Option<Select<'_>>) {
        // SAFETY: `self` is the proof that the processor has the one feature that the function is compiled for.
        unsafe { row::<S>(work, select) }
    }
}

#[target_feature(enable = "avx2")]
fn run(work: impl FnOnce()) {
    work();
}

#[target_feature(enable = "avx2")]
fn row<S: Windowed>(work: RowWork<'_>, select: Option<Select<'_>>) {
    // Two registers of lanes at a time measured best; and masks up to 64 lanes, with more of them the numbers. (A closure
    // has the features of what it is in.)
    let nearest = |least: u8, sums: &[u8]| nearest_of_64(least, sums);
    match work.stride {
        32 => in_groups::<S, 32, 32>(work, select, nearest),
        64 => in_groups::<S, 64, 64>(work, select, nearest),
        128 => in_groups::<S, 64, 128>(work, select, lanes::nearest_with::<128>),
        256 => in_groups::<S, 64, 256>(work, select, lanes::nearest_with::<256>),
        _ => in_groups::<S, 32, 0>(work, select, lanes::nearest_with::<0>),
    }
}

/// [`lanes::row_in_groups`], each number of lanes in a function of its own: the compiler's passes take far longer over one
/// function of all of them.
#[target_feature(enable = "avx2")]
#[inline(never)]
fn in_groups<S: Windowed, const GROUP: usize, const STRIDE: usize>(
    work: RowWork<'_>,
    select: Option<Select<'_>>,
    nearest: impl Fn(u8, &[u8]) -> usize,
) {
    lanes::row_in_groups::<S, GROUP, STRIDE>(work, select, nearest);
}

/// [`lanes::nearest_with`] of 32 or 64 lanes: the last bit of a mask instead of the least number.
#[target_feature(enable = "avx2")]
#[inline]
fn nearest_of_64(least: u8, sums: &[u8]) -> usize {
    let least = _mm256_set1_epi8(least as i8);
    let mut equal = 0;
    for group in sums.as_chunks::<32>().0 {
        // SAFETY: the group is 32 bytes, and no alignment is asked for.
        let group = unsafe { _mm256_loadu_si256(group.as_ptr().cast()) };
        let mask = _mm256_movemask_epi8(_mm256_cmpeq_epi8(group, least)) as u32;
        equal = equal >> 32 | u64::from(mask) << 32;
    }
    equal.leading_zeros() as usize
}

/// Proof that the processor has AVX-512, with operations on bytes, and that its registers are kept: only [`Avx512::detect`]
/// makes one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Avx512(());

impl Avx512 {
    pub(super) fn detect() -> Option<Self> {
        avx512::get().then_some(Self(()))
    }

    /// Does something that is compiled for AVX-512 as far as it is inlined.
    #[inline(always)]
    pub(super) fn run(self, work: impl FnOnce()) {
        // SAFETY: `self` is the proof that the processor has the features that the function is compiled for.
        unsafe { run_512(work) }
    }

    /// A row whose columns are whole registers of AVX2.
    #[inline]
    pub(super) fn row<S: Windowed>(self, work: RowWork<'_>, select: Option<Select<'_>>) {
        // SAFETY: `self` is the proof that the processor has the features that the function is compiled for.
        unsafe { row_512::<S>(work, select) }
    }
}

#[target_feature(enable = "avx2,avx512f,avx512bw,avx512cd,avx512dq,avx512vl")]
fn run_512(work: impl FnOnce()) {
    work();
}

#[target_feature(enable = "avx2,avx512f,avx512bw,avx512cd,avx512dq,avx512vl")]
fn row_512<S: Windowed>(work: RowWork<'_>, select: Option<Select<'_>>) {
    match work.stride {
        64 => in_groups_512::<S, 64>(work, select),
        128 => in_groups_512::<S, 128>(work, select),
        256 => in_groups_512::<S, 256>(work, select),
        stride if stride % 64 == 0 => in_groups_512::<S, 0>(work, select),
        _ => row::<S>(work, select),
    }
}

/// [`in_groups`] of 64 lanes.
#[target_feature(enable = "avx2,avx512f,avx512bw,avx512cd,avx512dq,avx512vl")]
#[inline(never)]
fn in_groups_512<S: Windowed, const STRIDE: usize>(work: RowWork<'_>, select: Option<Select<'_>>) {
    let nearest = |least: u8, sums: &[u8]| nearest_of_64s(least, sums);
    lanes::row_in_groups::<S, 64, STRIDE>(work, select, nearest);
}

/// [`lanes::nearest_with`] of whole registers of AVX-512: the last bit of the last mask that has one.
#[target_feature(enable = "avx512f,avx512bw")]
#[inline]
fn nearest_of_64s(least: u8, sums: &[u8]) -> usize {
    let least = _mm512_set1_epi8(least as i8);
    let mut nearest = 0;
    for group in sums.as_chunks::<64>().0 {
        // SAFETY: the group is 64 bytes, and no alignment is asked for.
        let group = unsafe { _mm512_loadu_si512(group.as_ptr().cast()) };
        let equal = _mm512_cmpeq_epi8_mask(group, least);
        // A group farther on has smaller disparities.
        nearest = if equal != 0 { equal.leading_zeros() as usize } else { nearest + 64 };
    }
    nearest
}
