//! The kernel in lanes compiled for AVX2, and unrolled for the usual numbers of disparities.
#![allow(unsafe_code)]

use super::{RowWork, Select, lanes};
use crate::matching::scheme::Scheme;

cpufeatures::new!(avx2, "avx2");

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

    #[inline]
    pub(super) fn row<S: Scheme>(self, work: RowWork<'_>, select: Option<Select<'_>>) {
        // SAFETY: `self` is the proof that the processor has the one feature that the function is compiled for.
        unsafe { row::<S>(work, select) }
    }
}

#[target_feature(enable = "avx2")]
fn run(work: impl FnOnce()) {
    work();
}

#[target_feature(enable = "avx2")]
fn row<S: Scheme>(work: RowWork<'_>, select: Option<Select<'_>>) {
    use lanes::row_in_groups;
    // Two registers of lanes at a time measured best.
    match work.stride {
        32 => row_in_groups::<S, 32, 32>(work, select),
        64 => row_in_groups::<S, 64, 64>(work, select),
        128 => row_in_groups::<S, 64, 128>(work, select),
        256 => row_in_groups::<S, 64, 256>(work, select),
        stride if stride % 32 == 0 => row_in_groups::<S, 32, 0>(work, select),
        _ => row_in_groups::<S, 16, 0>(work, select),
    }
}
