//! Streaming rectification: raw lines in, rectified lines out, with only as many raw lines held as the warp
//! needs.
//!
//! In: a [`Warp`](crate::geometry::rectify::Warp), and raw lines as they come. Out: rectified lines with
//! their valid-pixel masks.
//!
//! 1. [`RemapTable`]: the warp as a coarse lattice of raw positions, computed once in floating point.
//! 2. `segments`: the lattice at a rectified line; `segment`: positions along it, interpolated in integers by
//!    two additions per pixel.
//! 3. [`Remap`]: the band of raw lines, and the rectified lines; `sample`: bilinear interpolation, by
//!    `armv7em` where there are Arm's instructions on two half-words.
//! 4. [`RectifiedPair`]: two raw cameras as a rectified stereo source.
//!
//! A rectified pixel takes 22 instructions on a Cortex-M7, position and mask included: 320 x 240 px, a
//! rotation of one degree, a lens with k1 = -0.1 and k2 = 0.02, cells of 64 px. Without a lens it takes 26,
//! as the borders are in the image and need a test per pixel; a strong lens with cells of 32 px takes 33.
//! `cargo xtask firmware --all` measures these. Setting a table takes 9 million instructions.

#[cfg(any(stereopsis_dsp, stereopsis_vectors))]
mod armv7em;
mod error;
mod lines;
mod near;
mod pair;
mod rectified_pair;
mod sample;
mod segment;
mod segments;
mod table;

pub use error::{RemapError, RemapTableError};
pub use lines::Remap;
pub use pair::{RemapPair, RemapPairError};
pub use rectified_pair::{RectifiedPair, RectifiedPairError};
pub use table::RemapTable;
