//! Answers dropped that too few others support, in a band of five rows.
//!
//! An answer's support is counted along a cross (after Zhang, Lu & Lafruit 2009): from it straight up and
//! down as far as the answers are of one surface, and from each of these along its row as far as that surface
//! goes. Upwards every row counts, downwards the `LOOK_AHEAD` rows that have come when the row is decided.
//! For a small patch that is its size or little less; counting a patch exactly (a union-find over the band)
//! refuses the same answers to within a few in a hundred, but its work depends on the picture. This one's
//! does not.
//!
//! Each row adds its surfaces' lengths to the support of the row above where the two are of one surface.
//! Support only grows downwards: where it is enough, it is enough for all rows above that the surface goes on
//! from. Two bits a row say all that is to be kept of those, in one word with the support so far.

use crate::matching::backend::loops::{empty_row, fill_bytes};
use crate::matching::backend::{Isa, SpeckleWork};
use crate::matching::memory::rings::{above, waiting};
use crate::matching::method::Frame;

/// Forgets the frame before.
pub(super) fn begin(frame: &mut Frame<'_>) {
    fill_bytes(frame.support, 0);
    // The row above the first one.
    empty_row(frame.band.row_mut(above(0)));
}

/// Drops the answers of the row that waits which too few others support.
pub(super) fn drop_speckle(frame: &mut Frame<'_>, newest: usize) {
    let here = waiting(newest);
    // In the first rows of a frame no row waits yet: what is written then is not looked at.
    let checks = &frame.config.checks;
    frame.backend.speckle(SpeckleWork {
        here: frame.band.row(newest),
        above: frame.band.row(above(newest)),
        lengths: frame.workspace.lengths(),
        kept: frame.support,
        flags: frame.flags.row_mut(here),
        answers: if checks.median { None } else { Some(frame.band.row(here)) },
        finished: frame.finished.row_mut(here),
        step: checks.surface_step,
        pixels: checks.speckle_pixels,
        run: checks.speckle_run,
    });
}

/// Says that row `newest` is below the image: no surface goes on there.
pub(super) fn end_surfaces(frame: &mut Frame<'_>, newest: usize) {
    empty_row(frame.band.row_mut(newest));
    frame.workspace.skip_row();
}
