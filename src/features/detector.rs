//! FAST corners with descriptors, spread over a grid, line by line.

use super::detector_state::{CIRCLE, FeatureDetectorState, MARGIN, NEIGHBOURS, SMOOTHING};
use super::{
    CornerSlot, Feature, FeatureConfig, FeatureConfigError, FeatureCounts, Patch, binomial5_row, fast_scores,
};
use crate::imaging::RowRing;
use heapless::VecView;

/// Bytes for each pixel of a line: eight lines, the smoothed ones of a patch, three rows of scores.
const LINE_BYTES: usize = RAW + Patch::SIDE + SCORES;
const RAW: usize = 8;
const SCORES: usize = 3;

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

error_text!(FeatureLineError {
    Self::NoLineDue => "no line is due: start a frame",
    Self::Length { needed } => "a line of {needed} pixels is due",
});

/// Finds a picture's features line by line: the strongest corners of every cell, with their descriptors.
///
/// `W` is the longest line, px; `C` is how many corners a row of cells keeps: [`FeatureConfig::slots`]. The
/// detector takes 42 bytes for every pixel of a line, and 80 for every corner that is kept.
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
/// let mut features = stereopsis::heapless::Vec::<_, 16>::new();
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
    state: FeatureDetectorState,
    lines: [[u8; LINE_BYTES]; W],
    slots: [[CornerSlot; 2]; C],
}

/// A borrowed [`FeatureDetector`] of any size.
#[derive(Debug)]
pub struct FeatureDetectorView<'a> {
    state: &'a mut FeatureDetectorState,
    /// Rings of lines, of smoothed lines and of scores.
    lines: &'a mut [u8],
    /// The two rows of cells that corners are put into and wait in, the even one and the odd one.
    slots: &'a mut [CornerSlot],
}

impl<const W: usize, const C: usize> FeatureDetector<W, C> {
    /// A detector that waits for [`Self::start`]. All zeros.
    pub const fn new() -> Self {
        let state = FeatureDetectorState::new();
        Self { state, lines: [[0; LINE_BYTES]; W], slots: [[CornerSlot::EMPTY; 2]; C] }
    }

    /// The detector without its capacities.
    pub fn as_mut_view(&mut self) -> FeatureDetectorView<'_> {
        let (lines, slots) = (self.lines.as_flattened_mut(), self.slots.as_flattened_mut());
        FeatureDetectorView { state: &mut self.state, lines, slots }
    }

    /// Begins a frame, see [`FeatureDetectorView::start`].
    pub fn start(&mut self, config: &FeatureConfig) -> Result<(), FeatureConfigError> {
        self.as_mut_view().start(config)
    }

    /// Takes the next line, see [`FeatureDetectorView::push`].
    pub fn push(&mut self, line: &[u8], out: &mut VecView<Feature>) -> Result<(), FeatureLineError> {
        self.as_mut_view().push(line, out)
    }

    /// What became of the corners, so far.
    pub fn counts(&self) -> FeatureCounts {
        self.state.counts()
    }
}

impl<'a> FeatureDetectorView<'a> {
    /// Bytes that a detector takes for every pixel of its longest line.
    pub const LINE_BYTES: usize = LINE_BYTES;

    /// A detector in the caller's memory: [`Self::LINE_BYTES`] for each pixel of the longest line, and twice
    /// [`FeatureConfig::slots`]. It does not matter what is in them before [`Self::start`]; a view of a frame
    /// under way needs as much, with what the last one left there.
    pub fn new(
        state: &'a mut FeatureDetectorState,
        lines: &'a mut [u8],
        slots: &'a mut [CornerSlot],
    ) -> Result<Self, FeatureConfigError> {
        let view = Self { state, lines, slots };
        if view.state.config.height > 0 {
            view.check(&view.state.config)?;
        }
        Ok(view)
    }

    fn check(&self, config: &FeatureConfig) -> Result<(), FeatureConfigError> {
        config.check(self.lines.len() / LINE_BYTES, self.slots.len() / 2)
    }

    /// Begins a frame; what is left of another one is forgotten.
    // Unrolled at every call it takes flash each time.
    #[inline(never)]
    pub fn start(&mut self, config: &FeatureConfig) -> Result<(), FeatureConfigError> {
        self.check(config)?;
        *self.state = FeatureDetectorState { config: *config, ..FeatureDetectorState::new() };
        self.slots.fill(CornerSlot::EMPTY);
        Ok(())
    }

    /// The next line of grey pixels. The features of cells that are done are added to `out`; for which it has
    /// no place are counted. With the last line of the frame, all are done.
    pub fn push(&mut self, line: &[u8], out: &mut VecView<Feature>) -> Result<(), FeatureLineError> {
        self.push_into(line, &mut |feature| out.push(feature).is_ok())
    }

    /// Takes the next line as [`Self::push`] does, with features to what says whether it has room for one.
    pub(crate) fn push_into(
        &mut self,
        line: &[u8],
        out: &mut impl FnMut(Feature) -> bool,
    ) -> Result<(), FeatureLineError> {
        let state = &mut *self.state;
        let FeatureConfig { width, height, threshold, .. } = state.config;
        if state.taken >= height {
            return Err(FeatureLineError::NoLineDue);
        }
        let width = usize::from(width);
        let (mut raw, rest) = RowRing::<_, RAW>::split(self.lines, width);
        let (mut smooth, rest) = RowRing::<_, { Patch::SIDE }>::split(rest, width);
        let (mut scores, _) = RowRing::<_, SCORES>::split(rest, width);
        if line.len() != width {
            return Err(FeatureLineError::Length { needed: width });
        }
        let newest = usize::from(state.taken);
        state.taken += 1;
        // They are as long: a copy of slices would ask once more, and panic.
        raw.row_mut(newest).iter_mut().zip(line).for_each(|(place, &pixel)| *place = pixel);
        if let Some(row) = newest.checked_sub(SMOOTHING) {
            binomial5_row(&raw.around(row, newest), smooth.row_mut(row));
        }
        if let Some(row) = newest.checked_sub(CIRCLE) {
            fast_scores(&raw.around(row, newest), threshold, scores.row_mut(row));
        }
        // Both rows of cells are as long.
        let middle = self.slots.len() / 2;
        let (even, odd) = self.slots.split_at_mut_checked(middle).unwrap_or_default();
        let mut cells = [even, odd];
        if let Some(row) = newest.checked_sub(NEIGHBOURS) {
            state.find(row, scores.around(row, newest - CIRCLE), &mut cells);
        }
        if let Some(row) = newest.checked_sub(MARGIN) {
            state.describe(row, &smooth, &mut cells);
        }
        state.emit(newest, &mut cells, out);
        Ok(())
    }
}

impl<const W: usize, const C: usize> Default for FeatureDetector<W, C> {
    fn default() -> Self {
        Self::new()
    }
}
