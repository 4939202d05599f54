//! One row of results.

use super::config::Config;
use super::memory::rings::{BAND, HISTORY, row as slot};
use crate::units::{Disparity, PixelFlags};
use core::fmt;

/// The least standard deviation of an answer that was filled in, px.
const FILLED_SIGMA_PX: f32 = 1.0;

/// Pixels on each side that the uncertainty looks at: the reach of the matching window.
const REACH: usize = 4;
const _: () = assert!(HISTORY == REACH + 1, "the row itself and those that the uncertainty looks back at");

/// A row of disparities, with why a pixel has none and how sure the others are.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    pub(super) index: usize,
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) flags: &'a [PixelFlags],
    /// `HISTORY` finished rows, row `y` in slot `y % HISTORY`; of these only the row itself has its gaps
    /// filled.
    pub(super) finished: &'a [Disparity],
    /// `BAND` rows before median, speckle filter and smoothing down the columns, row `y` in slot `y % BAND`:
    /// this row and those below.
    pub(super) band: &'a [Disparity],
    pub(super) sigma_px: f32,
    pub(super) confidences: &'a [u8],
}

impl fmt::Debug for Row<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut row = f.debug_struct("Row");
        row.field("index", &self.index).field("disparities", &self.disparities());
        row.field("flags", &self.flags).field("confidences", &self.confidences).finish_non_exhaustive()
    }
}

impl<'a> Row<'a> {
    /// The row in the image, from 0.
    pub fn index(&self) -> u16 {
        self.index as u16
    }

    /// A disparity for each column.
    pub fn disparities(&self) -> &'a [Disparity] {
        slot(self.finished, self.index % HISTORY, self.width)
    }

    /// The flags of each column.
    pub fn flags(&self) -> &'a [PixelFlags] {
        self.flags
    }

    /// The largest of [`Self::confidences`].
    pub const MOST_CONFIDENCE: u8 = Config::MOST_CONFIDENCE;

    /// How sure the answer of each column is, from 1 to [`Self::MOST_CONFIDENCE`]; 0 where there is no
    /// answer. Empty unless [`Config::confidence`] or a [`Config::min_confidence`] over 0 asks for them.
    ///
    /// With `m` the cost of the best candidate over two px away less the winner's, at most 127, `s` the
    /// greatest difference to the answers 4 and 8 columns left and right, and `t` to those 2 and 4 rows
    /// above and below, in 1/32 px:
    ///
    /// `confidence = max(1, m + (40 - min(s / 4, 40)) + (40 - min(t / 4, 40)))`
    ///
    /// A neighbour without an answer, or below the image, makes its term 0; one above or beside the image is
    /// left out. Answers above are as they came out, but for what was filled; the others are as they were
    /// before the median, the speckle filter and the smoothing down the columns, and so is the answer itself
    /// but for the median. A filled answer ([`PixelFlags::FILLED`]) has 1, and `m` is 0 in the first five
    /// columns that have a candidate.
    ///
    /// The number puts the answers of one method in order, the wrong ones first: take away those under a
    /// threshold and the share of wrong ones falls. It is no probability, and says nothing about
    /// fractions of a pixel; [`Self::sigma_px`] does, of an answer that is right.
    pub fn confidences(&self) -> &'a [u8] {
        self.confidences
    }

    /// Standard deviation of the answer at column `x`, px; `None` where there is no answer.
    ///
    /// Away from depth edges it is the method's own ([`Method::SIGMA_PX`](super::Method::SIGMA_PX)). Near an
    /// edge the window sees two surfaces and may answer with either one's disparity, so the answers up to
    /// four pixels left, right, above and below are looked at: three sigma reach to the farthest of them,
    /// `sigma = max(SIGMA_PX, spread / 3)`. Those above are as they came out, but for what was filled; the
    /// others are as they were before the median, the speckle filter and the smoothing down the columns.
    ///
    /// A filled answer ([`PixelFlags::FILLED`]) is a guess: its sigma is at least 1 px, and three of it reach
    /// the answers on both sides of its gap as well.
    ///
    /// The work, 16 look-ups and a look at each pixel of the gap, is done when asked for.
    pub fn sigma_px(&self, x: usize) -> Option<f32> {
        let centre = self.disparities().get(x).copied().filter(|d| d.is_some())?;
        let here = slot(self.band, self.index % BAND, self.width);
        let mut spread = 0;
        let mut least_px = self.sigma_px;
        let mut look = |row: &[Disparity], x: usize| {
            let neighbour = row.get(x).copied().unwrap_or_default();
            spread = spread.max(centre.distance(neighbour).unwrap_or(0));
        };
        for k in 1..=REACH {
            look(here, x.wrapping_sub(k));
            look(here, x + k);
            if let Some(y) = self.index.checked_sub(k) {
                look(slot(self.finished, y % HISTORY, self.width), x);
            }
            let y = self.index + k;
            if y < self.height {
                look(slot(self.band, y % BAND, self.width), x);
            }
        }
        let filled = |x: &usize| self.flags.get(*x).is_some_and(|flags| flags.contains(PixelFlags::FILLED));
        if filled(&x) {
            least_px = least_px.max(FILLED_SIGMA_PX);
            let sides = [(0..x).rev().find(|x| !filled(x)), (x..self.width).find(|x| !filled(x))];
            sides.into_iter().flatten().for_each(|side| look(self.disparities(), side));
        }
        let spread_px = f32::from(spread) / f32::from(Disparity::ONE);
        Some(least_px.max(spread_px / 3.0))
    }
}
