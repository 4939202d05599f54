//! What stands for the vectors of x86-64 on other processors: kernels that no processor has.

pub(super) use super::{Vector as Wide, Vector as WideByAvx512, Vector as Widest};
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::work::WindowWork;
use crate::matching::memory::winners::{Select, WinnerRows};

/// No proof that the processor has AVX2 can be made.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::matching) enum Avx2 {}

/// No proof that the processor has AVX-512 can be made.
pub(in crate::matching) type Avx512 = Avx2;

impl Avx2 {
    pub(super) fn detect() -> Option<Self> {
        None
    }

    pub(super) fn run(self, _: impl FnOnce()) {
        match self {}
    }

    pub(super) fn keep(
        self,
        _: &WinnerRows<'_>,
        _: Option<[&[u8]; 2]>,
        _: usize,
        _: &mut [u16],
        _: [&mut [u8]; 2],
    ) {
        match self {}
    }

    pub(super) fn row<S: WindowParameters>(self, _: WindowWork<'_>, _: Option<Select<'_>>) {
        match self {}
    }
}
