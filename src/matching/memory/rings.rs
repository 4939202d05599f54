//! Rows of a frame that are kept for a while, in rings: row `y` stands in slot `y % rows`.

use super::slices::{part, part_mut, split_mut};

/// Five lines of an image: a row with the two above it and the two below.
pub type Rows5<'a> = [&'a [u8]; 5];

/// Rows that must follow before a row's speckle is decided.
pub(in crate::matching) const LOOK_AHEAD: usize = 4;
/// Rows of answers and flags before the speckle filter.
pub(in crate::matching) const BAND: usize = LOOK_AHEAD + 1;
/// Rows of finished answers: the last one and the four above it that the uncertainty looks at.
pub(in crate::matching) const HISTORY: usize = 5;

/// A row whose slots are those of the row above row `y`.
pub(in crate::matching) const fn above(y: usize) -> usize {
    y + BAND - 1
}

/// A row whose slots are those of the row that waits for `newest`, [`LOOK_AHEAD`] above it.
pub(in crate::matching) const fn waiting(newest: usize) -> usize {
    newest + BAND - LOOK_AHEAD
}

/// Row `slot` of a ring of rows `width` pixels wide.
#[inline(always)]
pub(in crate::matching) fn row<T>(ring: &[T], slot: usize, width: usize) -> &[T] {
    part(part(ring, slot * width..), ..width)
}

/// Mutable access to row `slot` of a ring of rows `width` pixels wide.
#[inline(always)]
pub(in crate::matching) fn row_mut<T>(ring: &mut [T], slot: usize, width: usize) -> &mut [T] {
    part_mut(part_mut(ring, slot * width..), ..width)
}

/// A ring of `ROWS` rows, each `width` pixels wide.
pub struct Ring<'a, T, const ROWS: usize> {
    rows: &'a mut [T],
    width: usize,
}

impl<'a, T, const ROWS: usize> Ring<'a, T, ROWS> {
    /// A ring in the first part of a memory.
    #[inline(always)]
    pub(in crate::matching) fn new(memory: &'a mut [T], width: usize) -> Self {
        Self { rows: part_mut(memory, ..ROWS * width), width }
    }

    /// Row `y` of the frame, which the ring must still hold.
    // A stage asks for a row or two: once in flash it is smaller, and no slower to speak of.
    #[cfg_attr(not(stereopsis_simd), inline(never))]
    pub(in crate::matching) fn row(&self, y: usize) -> &[T] {
        row(self.rows, y % ROWS, self.width)
    }

    /// Mutable access to row `y` of the frame.
    #[cfg_attr(not(stereopsis_simd), inline(never))]
    pub(in crate::matching) fn row_mut(&mut self, y: usize) -> &mut [T] {
        row_mut(self.rows, y % ROWS, self.width)
    }

    /// Mutable access to row `y` of the frame, and access to the one above it.
    pub(in crate::matching) fn row_and_above(&mut self, y: usize) -> (&mut [T], &[T]) {
        let slot = y % ROWS;
        let (before, rest) = split_mut(self.rows, slot * self.width);
        let (here, after) = split_mut(rest, self.width);
        let above = match slot.checked_sub(1) {
            Some(above) => row(before, above, self.width),
            None => row(after, ROWS - 2, self.width),
        };
        (here, above)
    }
}
