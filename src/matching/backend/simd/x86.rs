//! Windows in the registers of AVX2 and AVX-512, unrolled for the usual numbers of disparities.
#![allow(unsafe_code)]

pub(super) mod partners;

pub(super) use super::avx2::{Wide, WideByAvx512};
pub(super) use super::avx512::Widest;
use super::windows;
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::portable::group::Group;
use crate::matching::backend::work::WindowWork;
use crate::matching::memory::winners::{Select, WinnerRows};
use core::arch::x86_64::__cpuid;

cpufeatures::new!(avx2, "avx2");
// Level 4 of x86-64, and what counts, shifts and moves bytes of 512 bits: Ice Lake, Zen 4 and what came
// after. Registers of 512 bits slow older processors down.
cpufeatures::new!(
    avx512,
    "avx2",
    "avx512f",
    "avx512bw",
    "avx512cd",
    "avx512dq",
    "avx512vl",
    "avx512vbmi",
    "avx512bitalg",
    "gfni"
);

/// Whether the processor counts leading zeros; `cpufeatures` does not know that one.
fn counts_zeros() -> bool {
    // SAFETY: every processor of 64 bits has the instruction and this leaf. To compilers later than the
    // oldest that is supported the call is safe without it.
    #[allow(unused_unsafe)]
    let leaf = unsafe { __cpuid(0x8000_0001) };
    leaf.ecx & 1 << 5 != 0
}

/// Proof that the processor has AVX2: only [`Avx2::detect`] makes one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::matching) struct Avx2(());

impl Avx2 {
    pub(super) fn detect() -> Option<Self> {
        (avx2::get() && counts_zeros()).then_some(Self(()))
    }

    /// Does something that is compiled for AVX2 as far as it is inlined.
    #[inline(always)]
    pub(super) fn run(self, work: impl FnOnce()) {
        // SAFETY: `self` is the proof that the processor has the one feature that the function is compiled
        // for.
        unsafe { run(work) }
    }

    /// What partners keep of the winners' offers: [`partners::keep`], among any number of candidates.
    #[inline]
    pub(super) fn keep(
        self,
        winners: &WinnerRows<'_>,
        pixels: Option<[&[u8]; 2]>,
        candidates: usize,
        right: &mut [u16],
        room: [&mut [u8]; 2],
    ) {
        self.run(
            #[inline(always)]
            || partners::keep::<Wide>(winners, pixels, candidates, right, room),
        );
    }

    /// A row whose columns are whole registers: of 32 lanes.
    #[inline]
    pub(super) fn row<S: WindowParameters>(self, work: WindowWork<'_>, select: Option<Select<'_>>) {
        // SAFETY: `self` is the proof that the processor has the one feature that the function is compiled
        // for.
        unsafe { row::<S>(work, select) }
    }
}

#[target_feature(enable = "avx2,lzcnt")]
fn run(work: impl FnOnce()) {
    work();
}

#[target_feature(enable = "avx2,lzcnt")]
fn row<S: WindowParameters>(work: WindowWork<'_>, select: Option<Select<'_>>) {
    match work.stride {
        32 => in_wide::<S, 1, true>(work, select),
        64 => in_wide::<S, 2, true>(work, select),
        128 => in_wide::<S, 4, true>(work, select),
        256 => in_wide::<S, 8, true>(work, select),
        _ => in_wide::<S, 8, false>(work, select),
    }
}

/// Each number of groups in a function of its own: the compiler's passes take far longer over one function of
/// all of them.
#[target_feature(enable = "avx2,lzcnt")]
#[inline(never)]
fn in_wide<S: WindowParameters, const CELLS: usize, const ALL: bool>(
    work: WindowWork<'_>,
    select: Option<Select<'_>>,
) {
    windows::row::<S, Wide, CELLS, ALL>(work, select);
}

/// Proof that the processor has AVX-512, with operations on bytes, and that its registers are kept: only
/// [`Avx512::detect`] makes one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::matching) struct Avx512(());

impl Avx512 {
    pub(super) fn detect() -> Option<Self> {
        (avx512::get() && counts_zeros()).then_some(Self(()))
    }

    /// Does something that is compiled for AVX-512 as far as it is inlined.
    #[inline(always)]
    pub(super) fn run(self, work: impl FnOnce()) {
        // SAFETY: `self` is the proof that the processor has the features that the function is compiled for.
        unsafe { run_512(work) }
    }

    /// What partners keep of the winners' offers: [`partners::keep`], among any number of candidates.
    #[inline]
    pub(super) fn keep(
        self,
        winners: &WinnerRows<'_>,
        pixels: Option<[&[u8]; 2]>,
        candidates: usize,
        right: &mut [u16],
        room: [&mut [u8]; 2],
    ) {
        self.run(
            #[inline(always)]
            || partners::keep::<Widest>(winners, pixels, candidates, right, room),
        );
    }

    /// A row whose columns are whole registers of AVX2.
    #[inline]
    pub(super) fn row<S: WindowParameters>(self, work: WindowWork<'_>, select: Option<Select<'_>>) {
        // SAFETY: `self` is the proof that the processor has the features that the function is compiled for.
        unsafe { row_512::<S>(work, select) }
    }
}

#[target_feature(
    enable = "avx2,lzcnt,avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx512vbmi,avx512bitalg,gfni"
)]
fn run_512(work: impl FnOnce()) {
    work();
}

#[target_feature(
    enable = "avx2,lzcnt,avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx512vbmi,avx512bitalg,gfni"
)]
fn row_512<S: WindowParameters>(work: WindowWork<'_>, select: Option<Select<'_>>) {
    match work.stride {
        32 => in_groups::<S, WideByAvx512, 1, true>(work, select),
        64 => in_groups::<S, Widest, 1, true>(work, select),
        128 => in_groups::<S, Widest, 2, true>(work, select),
        256 => in_groups::<S, Widest, 4, true>(work, select),
        stride if stride % 64 == 0 => in_groups::<S, Widest, 4, false>(work, select),
        _ => row::<S>(work, select),
    }
}

/// [`in_wide`] with AVX-512's instructions.
#[target_feature(
    enable = "avx2,lzcnt,avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx512vbmi,avx512bitalg,gfni"
)]
#[inline(never)]
fn in_groups<S: WindowParameters, G: Group, const CELLS: usize, const ALL: bool>(
    work: WindowWork<'_>,
    select: Option<Select<'_>>,
) {
    windows::row::<S, G, CELLS, ALL>(work, select);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_used_where_the_processor_has_their_instructions() {
        extern crate std;
        use std::is_x86_feature_detected as has;
        let has_avx2 = has!("avx2") && has!("lzcnt");
        let has_avx512 = has!("avx512f")
            && has!("avx512bw")
            && has!("avx512cd")
            && has!("avx512dq")
            && has!("avx512vl")
            && has!("avx512vbmi")
            && has!("avx512bitalg")
            && has!("gfni");
        assert_eq!(Avx2::detect().is_some(), has_avx2);
        assert_eq!(Avx512::detect().is_some(), has_avx2 && has_avx512);
    }
}
