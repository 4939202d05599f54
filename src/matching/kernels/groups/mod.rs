//! Bytes side by side, whose lanes run over the disparities of one pixel: what the passes along paths and
//! under windows are written for.
//!
//! * `group`: what all of them can do.
//! * `words`: four bytes in a word.
//! * `sse2`, `avx2`, `avx512`, `neon`: registers of larger processors, with what they have alike from
//!   `registers`.

mod group;

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod registers;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod words;

pub use group::Group;

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Wide;
#[cfg(target_arch = "x86_64")]
pub(super) use avx512::Widest;
#[cfg(target_arch = "aarch64")]
pub(super) use neon::Vector;
#[cfg(target_arch = "x86_64")]
pub(super) use sse2::Vector;
pub(super) use words::Word;
/// The target's own vectors, as far as they are used here.
#[cfg(all(target_pointer_width = "64", not(any(target_arch = "x86_64", target_arch = "aarch64"))))]
pub(super) use words::Word as Vector;
