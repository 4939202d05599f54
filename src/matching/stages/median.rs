//! The middle one of the answers in 3 x 3 pixels.
//!
//! A wrong answer among right ones goes, and depth edges stay where they are. A neighbour that is no answer,
//! or lies outside of the image, counts as the answer in the middle; where there is none in the middle, there
//! is none after.
//!
//! The nine are answers as the band holds them, averaged along the row and not yet checked for support: the
//! medians go to where the row will be finished. So nothing is kept beside the band, and a pixel has to do
//! with no row but its own and the two beside it.
//!
//! The work is the same for every picture: numbers change places in a fixed order, and nothing is asked of
//! them.

use crate::matching::backend::Isa;
use crate::matching::memory::rings::{above, waiting};
use crate::matching::method::Frame;

/// Makes the medians of the row that waits, while the band still holds the row above it.
pub(super) fn take_medians(frame: &mut Frame<'_>, newest: usize) {
    if frame.config.checks.median {
        let here = waiting(newest);
        let rows = [above(here), here, here + 1].map(|y| frame.band.row(y));
        frame.backend.median(rows, frame.finished.row_mut(here));
    }
}
