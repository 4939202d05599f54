//! Answers dropped that too few others support, in a band of five rows.
//!
//! An answer's support is counted along a cross (after Zhang, Lu & Lafruit 2009): from it straight up and
//! down as far as the answers are of one surface, and from each of these along its row as far as that surface
//! goes. Upwards every row counts, downwards the [`LOOK_AHEAD`] rows that have come when the row is judged.
//! For a small patch that is its size or little less; counting a patch exactly (a union-find over the band)
//! refuses the same answers to within a few in a hundred, but its work depends on the picture. This one's
//! does not.
//!
//! Each row adds its surfaces' lengths to the support of the row above where the two are of one surface.
//! Support only grows downwards: where it is enough, it is enough for all rows above that the surface goes on
//! from. Two bits a row say all that is to be kept of those, in one word with the support so far.

use crate::matching::backend::{Backend, Isa, SpeckleWork};
use crate::matching::config::Checks;
use crate::matching::memory::rings::{BAND, LOOK_AHEAD, row};
use crate::units::{Disparity, PixelFlags};

/// What the columns keep from row to row. All slices have the row's width.
pub(in crate::matching) struct Support<'a> {
    /// Of the newest row: how many answers its surfaces have along it.
    pub lengths: &'a mut [u16],
    /// The support of each column so far, in the target's own form.
    pub kept: &'a mut [u16],
}

impl Support<'_> {
    /// Forgets the frame before. `band` is the ring of rows.
    pub(in crate::matching) fn begin(self, band: &mut [Disparity]) {
        self.kept.fill(0);
        // The row above the first one.
        let above = (BAND - 1) * self.kept.len();
        band.get_mut(above..).unwrap_or_default().fill(Disparity::NONE);
    }

    /// Counts the support of row `y` of the `band`, and finishes the row that waited for it, [`LOOK_AHEAD`]
    /// above: its answers without those that have less support than the checks ask for. With a median they
    /// are in `finished` already. In the first rows of a frame no row waits yet; what is written then is not
    /// looked at.
    pub(in crate::matching) fn filter(
        &mut self,
        backend: Backend,
        y: usize,
        band: &[Disparity],
        checks: &Checks,
        flags: &mut [PixelFlags],
        finished: &mut [Disparity],
    ) {
        let width = self.kept.len();
        let of_band = |y: usize| row(band, y % BAND, width);
        backend.speckle(SpeckleWork {
            here: of_band(y),
            above: of_band(y + BAND - 1),
            lengths: self.lengths,
            kept: self.kept,
            flags,
            answers: if checks.median { None } else { Some(of_band(y + BAND - LOOK_AHEAD)) },
            finished,
            step: checks.surface_step,
            pixels: checks.speckle_pixels,
        });
    }
}
