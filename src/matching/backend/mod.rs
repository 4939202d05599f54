//! The instructions that the dense path runs on: the choice among targets, and nothing else.
//!
//! * `isa`: what the stages ask of a target. `parameters`, `work`: what they hand to it.
//! * `portable`: all of it in plain Rust; bit planes and words for cores without vectors, for a Cortex-M3
//!   with the loops along paths in assembly. `plain`: the target that has no more than that.
//! * `simd`: vectors of 64-bit processors, and of WebAssembly with SIMD128.
//! * `armv7em`: Arm's instructions on four bytes in a word (Cortex-M4, M7, M33), where build.rs finds them.
//! * `mve`: the vectors of a Cortex-M55, likewise.
//! * `rvv`: the vectors of a 32-bit RISC-V core (Zve32x), likewise.
//!
//! A new core's code is a folder with an [`Isa`] of its own, and an arm here.

mod isa;
pub(in crate::matching) mod loops;
mod parameters;
#[allow(dead_code, reason = "a target may have all of it itself")]
mod plain;
#[allow(dead_code, reason = "a target has its own code for some of it")]
mod portable;
#[allow(dead_code, reason = "each target looks at what it needs")]
mod work;

#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
#[allow(dead_code, reason = "on a Cortex-M55 vectors do the most of it")]
mod armv7em;
#[cfg(stereopsis_vectors)]
mod mve;
#[cfg(stereopsis_rvv)]
mod rvv;
#[cfg(stereopsis_simd)]
mod simd;

#[cfg(stereopsis_dsp)]
use armv7em as target;
#[cfg(stereopsis_vectors)]
use mve as target;
#[cfg(not(any(stereopsis_dsp, stereopsis_vectors, stereopsis_rvv, stereopsis_simd)))]
use plain as target;
#[cfg(stereopsis_rvv)]
use rvv as target;
#[cfg(stereopsis_simd)]
use simd as target;

use super::kernel::Kernel;
pub(super) use isa::Isa;
pub use parameters::MethodParameters;
pub(super) use parameters::{SgmParameters, WindowParameters};
#[cfg(feature = "trace")]
pub(super) use portable::consistency::compared_cost;
pub(super) use portable::left_right::answer_records;
pub(super) use portable::smooth::MARGIN as SMOOTH_MARGIN;
pub(super) use target::{BY_CAPACITY, Backend, CODES_SHARE_A_BYTE, columns_begin};
pub(super) use work::{
    AnswerWork, CensusWork, CostWork, EdgeWork, FatteningWork, FillWork, Guide, PathWork, Rules, STEP,
    SmoothWork, SpeckleWork, WindowWork,
};

/// Words that the tables of a target take beside the workspace of a window whose codes have up to four bits,
/// and four that rows are read beyond. A matcher's bytes are given for all targets alike.
pub(super) const TABLE_WORDS: usize = 2 * 16 * 96 / size_of::<u32>() + 4;
/// Words that the tables of a target take beside the workspace of a window whose codes have eight bits.
pub(super) const TABLE_WORDS_OF_EIGHT: usize = 2 * 16 * 88 / size_of::<u32>();

impl Kernel {
    /// The fastest kernel that this processor runs.
    pub fn detect() -> Self {
        Backend::detect().kernel()
    }

    /// The kernels that this processor runs, the fastest last.
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|&kernel| Backend::of(kernel).is_some())
    }
}
