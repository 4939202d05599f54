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

use super::config::Checks;
#[cfg(stereopsis_dsp)]
use super::kernels::bytes as assembly;
#[cfg(stereopsis_vectors)]
use super::kernels::helium as assembly;
#[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
use super::rolled::rolled;
use super::row::slot;
#[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
use super::surface::of_one;
use crate::units::{Disparity, PixelFlags};

/// Rows that must follow before a row is judged.
pub(super) const LOOK_AHEAD: usize = 4;
/// Rows of the band: a ring, row `y` in slot `y % BAND`.
pub(super) const BAND: usize = LOOK_AHEAD + 1;

/// What the columns keep from row to row. All slices have the row's width.
pub(super) struct Support<'a> {
    /// Of the newest row: how many answers its surfaces have along it.
    pub lengths: &'a mut [u16],
    /// From the lowest bit up: whether each of the last four rows goes on from the one above it, the newest
    /// row first; whether each of them has enough; the support counted so far, as far as a byte holds
    /// it.
    pub kept: &'a mut [u16],
}

/// Bits of rows that go on, and then of rows that have enough.
#[cfg(not(stereopsis_vectors))]
pub(super) const ROWS: usize = LOOK_AHEAD;

/// What the numbers are worked on in: where there are vectors, half-words, of which they hold more.
#[cfg(target_pointer_width = "64")]
type Word = u16;
#[cfg(not(any(target_pointer_width = "64", stereopsis_vectors, stereopsis_dsp)))]
type Word = u32;

/// A row of the band, the one above it, and the row that waited for it.
#[cfg(any(stereopsis_vectors, stereopsis_dsp))]
pub(super) struct Judged<'a> {
    pub here: &'a [Disparity],
    pub above: &'a [Disparity],
    /// Bytes, as the kernel's `average` leaves them; they are done with.
    pub lengths: &'a mut [u16],
    /// All zero when a frame begins, then in the kernel's own order.
    pub kept: &'a mut [u16],
    pub flags: &'a mut [PixelFlags],
    /// The row that waited; where there is none, it is in `finished`.
    pub answers: Option<&'a [Disparity]>,
    pub finished: &'a mut [Disparity],
}

impl Support<'_> {
    /// Forgets the frame before. `band` is the ring of rows.
    pub(super) fn begin(self, band: &mut [Disparity]) {
        self.kept.fill(0);
        // The row above the first one.
        let above = (BAND - 1) * self.kept.len();
        band.get_mut(above..).unwrap_or_default().fill(Disparity::NONE);
    }

    /// Counts row `y` of the `band`, and judges the row that waited for it, [`LOOK_AHEAD`] above: what is
    /// finished are its answers without those that have less support than the checks ask for. In the
    /// first rows of a frame there is none yet; what is written then is not looked at.
    #[inline(never)]
    pub(super) fn count(
        &mut self,
        y: usize,
        band: &[Disparity],
        checks: &Checks,
        flags: &mut [PixelFlags],
        finished: &mut [Disparity],
    ) {
        let judged = slot(band, (y + BAND - LOOK_AHEAD) % BAND, self.kept.len());
        #[cfg(any(stereopsis_vectors, stereopsis_dsp))]
        self.judge(y, band, checks, flags, Some(judged), finished);
        #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
        {
            let out = judged.iter().zip(flags).zip(finished);
            self.judge(y, band, checks, out.map(|((answer, flags), finished)| (*answer, flags, finished)));
        }
    }

    /// The same where the answers to be judged are in `finished` already.
    #[inline(never)]
    pub(super) fn count_in_place(
        &mut self,
        y: usize,
        band: &[Disparity],
        checks: &Checks,
        flags: &mut [PixelFlags],
        finished: &mut [Disparity],
    ) {
        #[cfg(any(stereopsis_vectors, stereopsis_dsp))]
        self.judge(y, band, checks, flags, None, finished);
        #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
        {
            let out = flags.iter_mut().zip(finished);
            self.judge(y, band, checks, out.map(|(flags, finished)| (*finished, flags, finished)));
        }
    }

    /// In assembly.
    #[cfg(any(stereopsis_vectors, stereopsis_dsp))]
    fn judge(
        &mut self,
        y: usize,
        band: &[Disparity],
        checks: &Checks,
        flags: &mut [PixelFlags],
        answers: Option<&[Disparity]>,
        finished: &mut [Disparity],
    ) {
        let row = |y: usize| slot(band, y % BAND, self.kept.len());
        let (here, above) = (row(y), row(y + BAND - 1));
        let (lengths, kept) = (&mut *self.lengths, &mut *self.kept);
        let work = Judged { here, above, lengths, kept, flags, answers, finished };
        assembly::judge(work, checks.surface_step, checks.speckle_pixels);
    }

    #[cfg(not(any(stereopsis_vectors, stereopsis_dsp)))]
    #[inline(always)]
    #[allow(clippy::unnecessary_cast, reason = "a word is a half-word on some cores only")]
    fn judge<'a>(
        &mut self,
        y: usize,
        band: &[Disparity],
        checks: &Checks,
        out: impl Iterator<Item = (Disparity, &'a mut PixelFlags, &'a mut Disparity)>,
    ) {
        let width = self.kept.len();
        let row = |y: usize| slot(band, y % BAND, width);
        let (here, above) = (row(y), row(y + BAND - 1));
        let (step, pixels) = (checks.surface_step, Word::from(checks.speckle_pixels));
        let rows = here.iter().zip(above).zip(self.lengths.iter().zip(self.kept.iter_mut()));
        for (((here, above), (&length, kept)), (answer, flags, finished)) in rows.zip(out) {
            rolled();
            let joined = Word::from(of_one(here.raw(), above.raw(), step));
            let before = Word::from(*kept);
            let support = before >> (2 * ROWS) & Word::MIN.wrapping_sub(joined);
            let count = Word::from(length).saturating_add(support).min(0xff);
            // Each bit stands for the row before now; the highest of both halves goes.
            let mut rows = (before << 1 & 0b1_1110_1110) | joined;
            // This row, and those above as far as they are joined.
            let reached = rows ^ (rows + 1);
            rows |= reached << ROWS & Word::MIN.wrapping_sub(Word::from(count >= pixels));
            *kept = (count << (2 * ROWS) | rows & 0xff) as u16;
            let refused = rows & 1 << (ROWS + LOOK_AHEAD) == 0;
            *finished = Disparity::from_raw(answer.raw() | 0u16.wrapping_sub(u16::from(refused)));
            // What has no answer is no speckle.
            *flags = flags.union(PixelFlags::SPECKLE.when(*finished != answer));
        }
    }
}
