//! Raw lines in, rectified lines out, with no more of the raw image held than the warp needs.
//!
//! In: a [`Warp`](crate::geometry::rectify::Warp), and raw lines as they come. Out: rectified lines, each
//! pixel with whether it is one.
//!
//! 1. [`RemapTable`]: the warp as a coarse lattice of places in the raw image, made once from real numbers.
//! 2. `segment`: the places along a rectified line, between two columns of the lattice by two additions a
//!    pixel, in integers.
//! 3. [`Remap`]: the band of raw lines, and rectified ones out of it; `sample`: the pixels between four raw
//!    ones.
//! 4. [`RectifiedPair`]: two raw cameras as a rectified stereo source.
//!
//! A rectified pixel takes 34 instructions on a Cortex-M7, its place and its mask included: 320 x 240 px, the
//! camera turned by one degree, a lens with k1 = -0.1 and k2 = 0.02, cells of 64 px. The same without a lens
//! takes 38, because its borders are in the image, where each pixel is asked whether it was seen; a strong
//! lens with cells of 32 px takes 39. The README has the table, and the command that makes it. Setting a
//! table takes 9 million instructions.

mod lines;
mod pair;
mod sample;
mod segment;
mod table;

pub use lines::{Remap, RemapError};
pub use pair::{RectifiedPair, RectifiedPairError, RemapPair};
pub use table::{RemapTable, RemapTableError};
