//! Answers dropped that too few others support, in a band of five rows.
//!
//! An answer's support is counted along a cross (after Zhang, Lu & Lafruit 2009): from it straight up and down as far
//! as the answers are of one surface, and from each of these along its row as far as that surface goes. Upwards every
//! row counts, downwards the [`LOOK_AHEAD`] rows that have come when the row is judged. For a small patch that is its
//! size or little less; counting a patch exactly (a union-find over the band) refuses the same answers to within a few
//! in a hundred, but its work depends on the picture. This one's does not.
//!
//! Each row adds its surfaces' lengths to the support of the row above where the two are of one surface. Support only
//! grows downwards: where it is enough, it is enough for all rows above that the surface goes on from. Two bits a row say
//! all that is to be kept of those.

use super::row::slot;
use crate::units::{Disparity, PixelFlags};

/// Rows that must follow before a row is judged.
pub(super) const LOOK_AHEAD: usize = 4;
/// Rows of the band: a ring, row `y` in slot `y % BAND`.
pub(super) const BAND: usize = LOOK_AHEAD + 1;

/// What the columns keep from row to row. All slices have the row's width.
pub(super) struct Support<'a> {
    /// Of the newest row: how many answers its surfaces have along it.
    pub lengths: &'a mut [u16],
    /// Of the row before: the support counted so far.
    pub counts: &'a mut [u16],
    /// Low half: whether the last four rows go on from those above them, the newest row lowest. High half: whether the last
    /// four rows have enough.
    pub history: &'a mut [u8],
}

impl Support<'_> {
    /// Forgets the frame before. `band` is the ring of rows.
    pub(super) fn begin(self, band: &mut [Disparity]) {
        self.history.fill(0);
        // The row above the first one.
        let above = (BAND - 1) * self.history.len();
        band.get_mut(above..).unwrap_or_default().fill(Disparity::NONE);
    }

    /// Counts row `y` of the `band`, and judges the row that waited for it, [`LOOK_AHEAD`] above: what is finished are
    /// its answers without those that have less support than `pixels`. In the first rows of a frame there is none yet;
    /// what is written then is not looked at.
    #[inline(never)]
    pub(super) fn count(
        &mut self,
        y: usize,
        band: &[Disparity],
        step: Disparity,
        pixels: u16,
        flags: &mut [PixelFlags],
        finished: &mut [Disparity],
    ) {
        let width = self.history.len();
        let row = |y: usize| slot(band, y % BAND, width);
        let (here, above, judged) = (row(y), row(y + BAND - 1), row(y + BAND - LOOK_AHEAD));
        let step = u32::from(step.raw());
        let kept = self.counts.iter_mut().zip(self.history.iter_mut());
        let rows = here.iter().zip(above).zip(self.lengths.iter().zip(kept));
        let out = judged.iter().zip(flags).zip(finished);
        for (((here, above), (length, (count, history))), ((answer, flags), finished)) in rows.zip(out) {
            let change = u32::from(here.raw()).wrapping_sub(u32::from(above.raw()));
            let joined = change.wrapping_add(step) <= 2 * step;
            *count = length.saturating_add(*count & 0u16.wrapping_sub(u16::from(joined)));
            let joined_rows = (*history << 1 | u8::from(joined)) & 0xf;
            // This row, and those above as far as they are joined.
            let reached = joined_rows ^ (joined_rows + 1);
            let enough = (*history >> 3 & 0x1e) | reached & 0u8.wrapping_sub(u8::from(*count >= pixels));
            *history = enough << 4 | joined_rows;
            let refused = enough & 1 << LOOK_AHEAD == 0;
            // What has no answer is no speckle.
            *flags = flags.union(PixelFlags::SPECKLE.when(refused & answer.is_some()));
            *finished = Disparity::from_raw(answer.raw() | 0u16.wrapping_sub(u16::from(refused)));
        }
    }
}
