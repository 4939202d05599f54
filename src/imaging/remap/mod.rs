//! Raw lines in, rectified lines out, with no more of the raw image held than the warp needs.
//!
//! In: a [`Warp`](crate::geometry::Warp), and raw lines as they come. Out: rectified lines, each pixel with whether it is
//! one.
//!
//! 1. [`RemapTable`]: the warp as a coarse lattice of places in the raw image, made once from real numbers.
//! 2. `segment`: the places along a rectified line, between two columns of the lattice by two additions a pixel, in
//!    integers.
//! 3. [`Remap`]: the band of raw lines, and the pixels between four of them.
//! 4. [`RectifiedPair`]: two raw cameras as a rectified stereo source.

mod lines;
mod pair;
mod segment;
mod table;

pub use lines::{Remap, RemapError};
pub use pair::{RectifiedPair, RectifiedPairError};
pub use table::{RemapTable, RemapTableError};
