//! A target without code of its own: every stage is the portable one.

use super::isa::Isa;
use crate::matching::kernel::Kernel;

/// The portable code, for a target that has no other.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::matching) struct Backend;

impl Backend {
    /// What a matcher is made with before it is started.
    pub(in crate::matching) const FIRST: Self = Self;

    /// The fastest code that this processor runs.
    pub(in crate::matching) fn detect() -> Self {
        Self
    }

    /// The code of a kernel, if this processor runs it.
    pub(in crate::matching) fn of(kernel: Kernel) -> Option<Self> {
        (kernel == Kernel::Planes).then_some(Self)
    }
}

impl Isa for Backend {
    #[inline(always)]
    fn kernel(self) -> Kernel {
        Kernel::Planes
    }
}

/// Whether the two codes of a pixel share a byte where codes have up to four bits.
pub(in crate::matching) const CODES_SHARE_A_BYTE: bool = false;

/// Where a frame's columns begin in their memory: nothing is gained by another place than the first.
#[inline(always)]
pub(in crate::matching) const fn columns_begin(_: &[u8], _: usize) -> u8 {
    0
}
