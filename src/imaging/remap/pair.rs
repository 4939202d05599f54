//! Remaps of two cameras in step.

use super::{Remap, RemapError};
use crate::geometry::{Real, rectify::Rectification};
use core::fmt;

/// Remaps of two cameras with the masks of their last lines, for a static.
///
/// ```
/// use stereopsis::{geometry::camera::ImageSize, imaging::{RemapPair, RemapTable}};
/// const SIZE: ImageSize = ImageSize { width: 160, height: 120 };
/// // Lines for rows that move by up to 30 px across the image, and a copy.
/// static REMAPS: RemapPair<160, 32, { RemapTable::<0>::most_slots(SIZE) }> = RemapPair::empty();
/// # assert!(size_of_val(&REMAPS) < 20 << 10);
/// ```
#[derive(Clone, Debug)]
pub struct RemapPair<const W: usize, const N: usize, const SLOTS: usize> {
    left: Remap<W, N, SLOTS>,
    right: Remap<W, N, SLOTS>,
    valid: [[u8; W]; 2],
    /// Whether other lines stand for the raw ones that are held, by their row's remainder.
    replaced: [bool; N],
    /// Whether there are any of those in the frame.
    has_replaced: bool,
}

impl<const W: usize, const N: usize, const SLOTS: usize> RemapPair<W, N, SLOTS> {
    /// Creates remaps to images without pixels; [`Self::set`] gives them their warps.
    pub const fn empty() -> Self {
        Self::new(Remap::empty(), Remap::empty())
    }

    /// Joins the remaps of the left and the right camera.
    pub const fn new(left: Remap<W, N, SLOTS>, right: Remap<W, N, SLOTS>) -> Self {
        Self { left, right, valid: [[0; W]; 2], replaced: [false; N], has_replaced: false }
    }

    /// Sets the warps of a rectification in place.
    pub fn set<T: Real>(&mut self, rectification: &Rectification<T>) -> Result<(), RemapError> {
        let [left, right] = rectification.warps();
        self.left.set(left)?;
        self.right.set(right)
    }

    /// Returns the remaps of the left and the right camera.
    pub fn remaps(&self) -> [&Remap<W, N, SLOTS>; 2] {
        [&self.left, &self.right]
    }

    /// Returns the least `N` for which a [`RectifiedPair`](super::RectifiedPair) takes these remaps: a
    /// camera's lines are held until the other's next line is in, which may be more lines than each remap
    /// needs alone.
    pub fn lines_needed(&self) -> usize {
        let tables = self.remaps().map(Remap::table);
        let height = tables.map(|table| table.size().height).into_iter().max().unwrap_or(0);
        let (mut came, mut most) = (0, 0);
        for row in 0..height {
            let needs = tables.map(|table| table.raw_rows(row));
            came = needs.iter().flatten().fold(came, |came, (_, last)| came.max(*last));
            most = needs.iter().flatten().fold(most, |most, (first, _)| most.max(came - first + 1));
        }
        usize::from(most) + 1
    }

    /// Returns [`Self::lines_needed`]; refused where the bands hold fewer, or the images differ in size.
    pub fn lines_in_step(&self) -> Result<usize, RemapPairError> {
        let [left, right] = self.remaps().map(Remap::table);
        if left.size() != right.size() || left.raw_size() != right.raw_size() {
            return Err(RemapPairError::Sizes);
        }
        let needed = self.lines_needed();
        if needed > N { Err(RemapPairError::Lines { needed }) } else { Ok(needed) }
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        self.has_replaced = false;
        self.replaced = [false; N];
        self.left.begin();
        self.right.begin();
    }

    /// Returns the row that [`Self::row`] gives next; the height after the last one.
    pub fn next_row(&self) -> u16 {
        self.left.next_row()
    }

    /// Returns whether the next rectified lines need other raw lines. Take all rectified lines that do not
    /// before accepting the next raw lines, which may overwrite what they need.
    pub fn wants_lines(&self) -> bool {
        self.left.wants_line() || self.right.wants_line()
    }

    /// Returns the buffers for the next raw lines, which count once [`Self::accept`] is called.
    pub fn next_lines(&mut self) -> [&mut [u8]; 2] {
        [self.left.next_line(), self.right.next_line()]
    }

    /// Writes the raw lines above into [`Self::next_lines`], in place of lost ones.
    pub fn repeat_lines(&mut self) {
        self.left.repeat();
        self.right.repeat();
    }

    /// Accepts the raw lines in [`Self::next_lines`].
    pub fn accept(&mut self) {
        self.take(false);
    }

    /// Accepts the raw lines in [`Self::next_lines`], which stand for lost ones.
    pub fn accept_replaced(&mut self) {
        self.take(true);
    }

    fn take(&mut self, is_replaced: bool) {
        self.has_replaced |= is_replaced;
        if self.has_replaced {
            let slot = usize::from(self.came()) % N;
            if let Some(replaced) = self.replaced.get_mut(slot) {
                *replaced = is_replaced;
            }
        }
        self.left.accept();
        self.right.accept();
    }

    /// Returns the number of raw lines accepted of each camera since [`Self::begin`].
    pub fn came(&self) -> u16 {
        self.left.came()
    }

    /// Returns whether the next rectified lines need a raw line that was lost.
    pub fn is_damaged(&self) -> bool {
        if !self.has_replaced {
            return false;
        }
        let was_replaced = |row| self.replaced.get(usize::from(row) % N).is_some_and(|replaced| *replaced);
        let needs = [self.left.needs(), self.right.needs()];
        needs.into_iter().flatten().any(|(first, last)| (first..=last).any(was_replaced))
    }

    /// Passes over the next rectified lines.
    pub fn skip(&mut self) {
        self.left.skip();
        self.right.skip();
    }

    /// Writes the next rectified lines, and returns their row.
    pub fn row(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<u16, RemapError> {
        let [left_valid, right_valid] = &mut self.valid;
        let row = self.left.row(left, left_valid)?;
        self.right.row(right, right_valid)?;
        Ok(row)
    }

    /// Returns the masks of the last lines, left and right: 1 for a valid pixel, else 0.
    pub fn valid(&self) -> [&[u8]; 2] {
        let width = usize::from(self.left.table().size().width);
        self.valid.each_ref().map(|valid| valid.get(..width).unwrap_or(&[]))
    }

    /// Writes the masks of a rectified row, 1 for a valid pixel, else 0, as many as fit.
    pub fn mask(&self, row: u16, [left, right]: [&mut [u8]; 2]) {
        self.left.table().mask(row, left);
        self.right.table().mask(row, right);
    }
}

/// Why two remaps cannot run in step.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RemapPairError {
    /// The raw images or the rectified images of the two cameras differ in size.
    Sizes,
    /// The bands hold too few lines for both cameras in step.
    Lines {
        /// Number of lines `N` that would have been enough.
        needed: usize,
    },
}

impl fmt::Display for RemapPairError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sizes => f.write_str("the two remaps take or make images of different sizes"),
            Self::Lines { needed } => RemapError::Lines { needed: *needed }.fmt(f),
        }
    }
}

impl core::error::Error for RemapPairError {}
