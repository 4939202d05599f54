//! FAST corners with descriptors, spread over a grid, line by line.

use super::grid::{self, Slot};
use super::pattern::PATCH_RADIUS;
use super::{
    Corner, Descriptor, Feature, FeatureConfig, FeatureConfigError, Orientation, Patch, PatchOrientation,
    binomial5_row, fast_scores, refine,
};
use crate::imaging::LineBand;
use core::fmt;
use core::num::NonZero;
use heapless::VecView;

/// Lines that the smoothing of a row waits for.
const SMOOTHING: usize = 2;
/// Lines that a row of scores waits for.
const CIRCLE: usize = 3;
/// Lines that a row of corners waits for: the scores of the row below.
const NEIGHBOURS: usize = CIRCLE + 1;
/// Lines that a row of features waits for: the patch.
const MARGIN: usize = FeatureConfig::MARGIN as usize;
const _: () = assert!(MARGIN == PATCH_RADIUS as usize + SMOOTHING);
/// Corners and the patches they wait for lie in two rows of cells at most.
const _: () = assert!(FeatureConfig::LEAST_CELL as usize > MARGIN - NEIGHBOURS);

/// Why a line was not taken.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FeatureLineError {
    /// The detector was not started, or all lines of the frame have come.
    NoLineDue,
    /// The line has another length than the configuration says.
    Length {
        /// What was due, px.
        needed: usize,
    },
}

impl fmt::Display for FeatureLineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLineDue => write!(f, "no line is due: start a frame"),
            Self::Length { needed } => write!(f, "a line of {needed} pixels is due"),
        }
    }
}

impl core::error::Error for FeatureLineError {}

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

/// Finds a picture's features line by line: the strongest corners of every cell, with their descriptors.
///
/// `W` is the longest line, px; `C` is how many corners a row of cells keeps: [`FeatureConfig::slots`]. The
/// detector takes [`Self::BYTES`]: 42 bytes for every pixel of a line, and 80 for every corner that is kept.
/// The work for a line is bounded by its length, but for its corners: a descriptor for each slot at most.
///
/// In running order, with what each waits for: a row is smoothed (2 lines), scored (3), its local maxima
/// become corners (4) and are put into their cells; those still there when the patch is whole (17) are
/// refined and described; when a row of cells is done, its corners come out, cell by cell from the left, the
/// strongest of each first.
///
/// ```
/// use stereopsis::features::{FeatureConfig, FeatureDetector};
/// let mut detector = FeatureDetector::<64, 10>::new();
/// let mut features = heapless::Vec::<_, 16>::new();
/// detector.start(&FeatureConfig::new(64, 64))?;
/// for y in 0..64 {
///     let mut line = [20; 64];
///     if (30..=36).contains(&y) {
///         line[30..=36].fill(200);
///     }
///     detector.push(&line, features.as_mut_view()).expect("a line that is due");
/// }
/// assert_eq!(features.len(), 4);
/// # Ok::<(), stereopsis::features::FeatureConfigError>(())
/// ```
#[derive(Debug)]
pub struct FeatureDetector<const W: usize, const C: usize> {
    config: FeatureConfig,
    /// Rows that came, of those of the configuration.
    taken: u16,
    raw: LineBand<W, 8>,
    smooth: LineBand<W, { Patch::SIDE }>,
    scores: LineBand<W, 3>,
    /// The two rows of cells that corners are put into and wait in, the even one and the odd one.
    cells: [[Slot; C]; 2],
    counts: FeatureCounts,
}

impl<const W: usize, const C: usize> FeatureDetector<W, C> {
    /// Bytes of a detector, but for a few words.
    pub const BYTES: usize = size_of::<Self>();

    /// A detector that waits for [`Self::start`].
    pub const fn new() -> Self {
        Self {
            config: FeatureConfig::NONE,
            taken: 0,
            raw: LineBand::new(),
            smooth: LineBand::new(),
            scores: LineBand::new(),
            cells: [[Slot::EMPTY; C]; 2],
            counts: FeatureCounts { corners: 0, crowded_out: 0, dropped: 0 },
        }
    }

    /// Begins a frame; what is left of another one is forgotten.
    pub fn start(&mut self, config: &FeatureConfig) -> Result<(), FeatureConfigError> {
        config.check(W, C)?;
        self.config = *config;
        self.taken = 0;
        let width = usize::from(config.width);
        self.raw.begin(width);
        self.smooth.begin(width);
        self.scores.begin(width);
        self.cells.as_flattened_mut().fill(Slot::EMPTY);
        self.counts = FeatureCounts::default();
        Ok(())
    }

    /// What became of the corners, so far.
    pub fn counts(&self) -> FeatureCounts {
        self.counts
    }

    /// The next line of grey pixels. The features of cells that are done are added to `out`; for which it has
    /// no place are counted. With the last line of the frame, all are done.
    pub fn push(&mut self, line: &[u8], out: &mut VecView<Feature>) -> Result<(), FeatureLineError> {
        if self.taken >= self.config.height {
            return Err(FeatureLineError::NoLineDue);
        }
        let place = self.raw.next_line();
        if line.len() != place.len() {
            return Err(FeatureLineError::Length { needed: place.len() });
        }
        // They are as long: a copy of slices would ask once more, and panic.
        place.iter_mut().zip(line).for_each(|(place, &pixel)| *place = pixel);
        self.raw.accept();
        let newest = usize::from(self.taken);
        self.taken += 1;
        if let Some(row) = newest.checked_sub(SMOOTHING) {
            binomial5_row(&self.raw.around(row), self.smooth.next_line());
            self.smooth.accept();
        }
        if let Some(row) = newest.checked_sub(CIRCLE) {
            fast_scores(&self.raw.around(row), self.config.threshold, self.scores.next_line());
            self.scores.accept();
        }
        if let Some(row) = newest.checked_sub(NEIGHBOURS) {
            self.find(row);
        }
        if let Some(row) = newest.checked_sub(MARGIN) {
            self.describe(row);
        }
        self.emit(newest, out);
        Ok(())
    }

    /// The side of a cell, px, and how many corners are kept in it. Neither is 0, and their type says so: it
    /// leaves no panic where they divide, however little the compiler does.
    fn cell(&self) -> (NonZero<usize>, usize) {
        let least = |number: u16| NonZero::new(usize::from(number)).unwrap_or(NonZero::<usize>::MIN);
        (least(self.config.cell_px), least(self.config.per_cell).get())
    }

    /// The corners of a row into their cells: pixels that score more than the neighbours that come before
    /// them, and no less than those that come after.
    fn find(&mut self, row: usize) {
        let FeatureConfig { width, height, .. } = self.config;
        let (width, height) = (usize::from(width), usize::from(height));
        let (cell_px, per_cell) = self.cell();
        if row < MARGIN || row + MARGIN >= height || width <= 2 * MARGIN {
            return;
        }
        let cells = self.cells.get_mut(row / cell_px % 2);
        let [above, here, below] = self.scores.around(row);
        let Some(cells) = cells else { return };
        let triples = above.windows(3).zip(here.windows(3)).zip(below.windows(3)).enumerate();
        for (left, ((above, here), below)) in triples.skip(MARGIN - 1).take(width - 2 * MARGIN) {
            let (&[a, b, c], &[d, score, e], &[f, g, h]) = (above, here, below) else { continue };
            if score == 0 || score <= a.max(b).max(c).max(d) || score < e.max(f).max(g).max(h) {
                continue;
            }
            let column = left + 1;
            let corner = Corner { column: column as u16, row: row as u16, score, ..Corner::NONE };
            let first = column / cell_px * per_cell;
            self.counts.corners += 1;
            if let Some(cell) = cells.get_mut(first..first + per_cell) {
                self.counts.crowded_out += u32::from(grid::insert(cell, corner));
            }
        }
    }

    /// Where a row's corners are, to a fraction of a pixel, and what they look like.
    fn describe(&mut self, row: usize) {
        let (cell_px, _) = self.cell();
        let rows = self.smooth.around(row);
        let Some(cells) = self.cells.get_mut(row / cell_px % 2) else { return };
        let waiting =
            cells.iter_mut().filter(|slot| slot.corner.score > 0 && usize::from(slot.corner.row) == row);
        for slot in waiting {
            let Some(patch) = Patch::cut(&rows, slot.corner.column.into()) else { continue };
            let turn = match self.config.orientation {
                Orientation::Upright => PatchOrientation::NONE,
                Orientation::Centroid => patch.direction(),
            };
            [slot.corner.right, slot.corner.down] = refine(&patch);
            slot.descriptor = Descriptor::of(&patch, turn);
        }
    }

    /// Gives out the rows of cells that are done with the line `newest`.
    fn emit(&mut self, newest: usize, out: &mut VecView<Feature>) {
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
            let Some(cells) = self.cells.get_mut(row % 2) else { continue };
            let mut waiting = cells.as_mut_slice();
            while let Some((cell, others)) = waiting.split_at_mut_checked(per_cell) {
                waiting = others;
                while let Some(slot) = grid::take_strongest(cell) {
                    let feature = Feature::new(&slot.corner, level, slot.descriptor);
                    self.counts.dropped += u32::from(out.push(feature).is_err());
                }
            }
        }
    }
}

impl<const W: usize, const C: usize> Default for FeatureDetector<W, C> {
    fn default() -> Self {
        Self::new()
    }
}
