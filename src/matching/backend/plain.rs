//! A target without code of its own: every stage is the portable one.

use super::isa::{Isa, sole_kernel};
use crate::matching::kernel::Kernel;

sole_kernel! {
    /// The portable code, for a target that has no other.
    Planes
}

impl Isa for Backend {
    #[inline(always)]
    fn kernel(self) -> Kernel {
        Kernel::Planes
    }
}

/// Whether the two codes of a pixel share a byte where codes have up to four bits.
pub(in crate::matching) const CODES_SHARE_A_BYTE: bool = false;

/// Whether a matcher's capacity chooses the code of its rows, so that a program is linked without the rest.
pub(in crate::matching) const BY_CAPACITY: bool = true;

/// Where a frame's columns begin in their memory: nothing is gained by another place than the first.
#[inline(always)]
pub(in crate::matching) const fn columns_begin(_: &[u8], _: usize) -> u8 {
    0
}
