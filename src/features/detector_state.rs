//! What becomes of a row's corners in a feature detector: found, described, given out.

use super::grid::{self, CornerSlot};
use super::maxima::{COLUMNS, maxima_of_four};
use super::pattern::PATCH_RADIUS;
use super::{Corner, Descriptor, Feature, FeatureConfig, Orientation, Patch, PatchOrientation, refine};
use crate::imaging::{RowRing, part};
use core::num::NonZero;

/// Lines that the smoothing of a row waits for.
pub(super) const SMOOTHING: usize = 2;
/// Lines that a row of scores waits for.
pub(super) const CIRCLE: usize = 3;
/// Lines that a row of corners waits for: the scores of the row below.
pub(super) const NEIGHBOURS: usize = CIRCLE + 1;
/// Lines that a row of features waits for: the patch.
pub(super) const MARGIN: usize = FeatureConfig::MARGIN as usize;
const _: () = assert!(MARGIN == PATCH_RADIUS as usize + SMOOTHING);
/// Corners and the patches they wait for lie in two rows of cells at most.
const _: () = assert!(FeatureConfig::LEAST_CELL as usize > MARGIN - NEIGHBOURS);

/// What became of a frame's corners.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FeatureCounts {
    /// Corners that were found.
    pub corners: u32,
    /// Number of corners dropped because stronger ones of their grid cell took its slots.
    pub crowded_out: u32,
    /// Number of corners dropped because the caller's list was full.
    pub dropped: u32,
}

/// How far a [`FeatureDetector`](super::FeatureDetector) is with a frame.
#[derive(Debug)]
pub struct FeatureDetectorState {
    pub(super) config: FeatureConfig,
    /// Rows that came, of those of the configuration.
    pub(super) taken: u16,
    pub(super) counts: FeatureCounts,
}

impl FeatureDetectorState {
    /// The state of a detector that waits for a start. All zeros.
    pub const fn new() -> Self {
        let counts = FeatureCounts { corners: 0, crowded_out: 0, dropped: 0 };
        Self { config: FeatureConfig::NONE, taken: 0, counts }
    }

    /// What became of the corners, so far.
    pub fn counts(&self) -> FeatureCounts {
        self.counts
    }

    /// The side of a cell, px, and how many corners are kept in it. Neither is 0, and their type says so: it
    /// leaves no panic where they divide, however little the compiler does.
    fn cell(&self) -> (NonZero<usize>, usize) {
        let least = |number: u16| NonZero::new(usize::from(number)).unwrap_or(NonZero::<usize>::MIN);
        (least(self.config.cell_px), least(self.config.per_cell).get())
    }

    /// The corners of a row into their cells: pixels that score more than the neighbours that come before
    /// them, and no less than those that come after.
    pub(super) fn find(&mut self, row: usize, scores: [&[u8]; 3], cells: &mut [&mut [CornerSlot]; 2]) {
        let FeatureConfig { width, height, .. } = self.config;
        let (width, height) = (usize::from(width), usize::from(height));
        let (cell_px, per_cell) = self.cell();
        if row < MARGIN || row + MARGIN >= height || width <= 2 * MARGIN {
            return;
        }
        let Some(cells) = cells.get_mut(row / cell_px % 2) else { return };
        // All of one length, which is asked for once.
        let [Some(above), Some(here), Some(below)] = scores.map(|row| row.get(..width)) else { return };
        let end = width - MARGIN;
        let (mut corners, mut crowded_out, mut begin) = (0, 0, MARGIN);
        while begin < end && begin + COLUMNS < width {
            let parts = [above, here, below].map(|row| part(row, begin - 1));
            let [_, here, _] = parts;
            let mut maxima = maxima_of_four(parts);
            while maxima != 0 {
                let lane = maxima.trailing_zeros() / u8::BITS;
                maxima &= !(0xff << (lane * u8::BITS));
                let (lane, column) = (lane as usize, begin + lane as usize);
                let score = here.get(1 + lane).copied().unwrap_or(0);
                if column >= end {
                    break;
                }
                let corner = Corner { column: column as u16, row: row as u16, score, ..Corner::NONE };
                let first = column / cell_px * per_cell;
                corners += 1;
                if let Some(cell) = cells.get_mut(first..first + per_cell) {
                    crowded_out += u32::from(grid::insert(cell, corner));
                }
            }
            begin += COLUMNS;
        }
        self.counts.corners += corners;
        self.counts.crowded_out += crowded_out;
    }

    /// Where a row's corners are, to a fraction of a pixel, and what they look like.
    // Alone, so that the rows of a patch are on the stack while they are needed.
    #[inline(never)]
    pub(super) fn describe(
        &self,
        row: usize,
        smooth: &RowRing<'_, u8, { Patch::SIDE }>,
        cells: &mut [&mut [CornerSlot]; 2],
    ) {
        let (cell_px, _) = self.cell();
        let Some(cells) = cells.get_mut(row / cell_px % 2) else { return };
        let is_waiting = |slot: &CornerSlot| slot.corner.score > 0 && usize::from(slot.corner.row) == row;
        // The rest has its price, and in most rows of most pictures none waits.
        if !cells.iter().any(is_waiting) {
            return;
        }
        let rows = smooth.all(row.saturating_sub(PATCH_RADIUS as usize));
        let mut patch = Patch::BLACK;
        for slot in cells.iter_mut().filter(|slot| is_waiting(slot)) {
            if patch.fill(&rows, slot.corner.column.into()).is_none() {
                continue;
            }
            let turn = match self.config.orientation {
                Orientation::Upright => PatchOrientation::NONE,
                Orientation::Centroid => patch.direction(),
            };
            [slot.corner.right, slot.corner.down] = refine(&patch);
            slot.descriptor = Descriptor::of(&patch, turn);
        }
    }

    /// Gives out the rows of cells that are done with the line `newest`, to what says whether it has room.
    pub(super) fn emit(
        &mut self,
        newest: usize,
        cells: &mut [&mut [CornerSlot]; 2],
        out: &mut impl FnMut(Feature) -> bool,
    ) {
        let FeatureConfig { height, level, .. } = self.config;
        let (cell_px, per_cell) = self.cell();
        let is_last = newest + 1 == usize::from(height);
        // Rows of cells whose last row is described.
        let done = (newest + 1).saturating_sub(MARGIN) / cell_px;
        let begins = (newest + 1).saturating_sub(MARGIN).is_multiple_of(cell_px.get());
        let one = (begins && done > 0).then(|| done - 1);
        // The last row of cells may be cut off.
        let rest = is_last.then_some(done);
        for row in one.into_iter().chain(rest) {
            let Some(mut waiting) = cells.get_mut(row % 2).map(|cells| &mut **cells) else { continue };
            while let Some((cell, others)) = waiting.split_at_mut_checked(per_cell) {
                waiting = others;
                while let Some(slot) = grid::take_strongest(cell) {
                    let feature = Feature::new(&slot.corner, level, slot.descriptor);
                    self.counts.dropped += u32::from(!out(feature));
                }
            }
        }
    }
}

impl Default for FeatureDetectorState {
    fn default() -> Self {
        Self::new()
    }
}
