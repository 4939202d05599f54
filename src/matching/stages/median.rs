//! The middle one of the answers in 3 x 3 pixels.
//!
//! A wrong answer among right ones goes, and depth edges stay where they are. A neighbour that is no answer,
//! or lies outside of the image, counts as the answer in the middle; where there is none in the middle, there
//! is none after.
//!
//! The nine are answers as the band holds them, averaged along the row and not yet judged: the medians go to
//! where the row will be finished. So nothing is kept beside the band, and a pixel has to do with no row but
//! its own and the two beside it.
//!
//! The work is the same for every picture: numbers change places in a fixed order, and nothing is asked of
//! them.

use crate::matching::backend::{Backend, Isa};
use crate::units::Disparity;

/// Makes `out` the medians of the second of three rows of its width.
pub(super) fn median(backend: Backend, rows: [&[Disparity]; 3], out: &mut [Disparity]) {
    backend.median(rows, out);
}
