//! The dense path in plain Rust.
//!
//! * `planes`: census and windows in bit planes, for cores without vectors.
//! * `group`: bytes side by side, which the code along paths and under windows in vectors is written for;
//!   `words`: four bytes in a word.
//! * `sgm`: costs along paths.
//! * `left_right`, `consistency`, `subpixel`: winners into answers; `left_right_rows`: pixels side by side.
//! * `smooth`, `median`, `speckle`, `vertical`: the filters of answers.

pub(super) mod census;
mod consistency;
pub(super) mod group;
pub(super) mod left_right;
pub(super) mod left_right_rows;
pub(super) mod median;
pub(super) mod planes;
pub(super) mod sgm;
pub(super) mod smooth;
pub(super) mod speckle;
mod subpixel;
pub(super) mod vertical;
pub(super) mod words;

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
