//! Remap table: a warp sampled on a coarse lattice, interpolated in integers.

use super::RemapTableError;
use super::segment::{BITS, Cell, Part};
use super::segments::{Lattice, Segments};
use crate::geometry::{Real, camera::ImageSize, rectify::Warp};
use nalgebra::Point2;

/// Raw positions of the pixels of a rectified image: a lattice every 8, 16, 32 or 64 px, in 1/65536 px.
///
/// Positions are interpolated by a cubic between rows and a parabola between columns, the latter in straight
/// pieces of four pixels where these suffice; all in integers, so that every core finds the same ones. The
/// widest lattice is taken that stays within [`Self::TOLERANCE_PX`] of the warp, checked in every second
/// column of every fourth row, and in the others more loosely. A slot takes 8 bytes; [`Self::slots`] counts
/// them. A table of one warp in one type, `f32` or `f64`, is equal on every core: it takes products,
/// quotients and roots alone.
#[derive(Clone, Debug)]
pub struct RemapTable<const SLOTS: usize> {
    /// The lattice, column by column: column and row, where the column's lowest bit means that the lens model
    /// does not describe the position. Then two rectified rows per slot: first and, 16 bits higher, last raw
    /// row, and [`WHOLE`].
    slots: [[i32; 2]; SLOTS],
    shift: u8,
    piece: u8,
    /// Rows of the lattice, and its points.
    lattice_rows: u16,
    nodes: u32,
    size: ImageSize,
    raw: ImageSize,
    rows: u16,
}

/// Widest and finest lattice, as powers of two.
const WIDEST: u32 = 6;
pub(super) const FINEST: u32 = 3;
/// Size of an empty image.
const NO_PIXELS: ImageSize = ImageSize { width: 0, height: 0 };
/// Bit of a row that is wholly inside the raw image.
const WHOLE: u32 = 1 << 31;
/// Entry of a row outside the raw image: its first raw row is after the last.
const NOWHERE: u32 = 0xffff;
/// Limits of a position, left and above, right and below, so that sums of four fit a word.
const FARTHEST: (f64, f64) = (-2048.0, 6143.0);

impl<const SLOTS: usize> RemapTable<SLOTS> {
    /// Largest error of a position in every fourth row and the last one, px.
    pub const TOLERANCE_PX: f64 = 0.03;
    /// Largest error of any position, px.
    pub(super) const LARGEST_ERROR_PX: f64 = 0.05;

    /// Creates the table of an image without pixels, for [`Self::set`]. All its bytes are zero, so that a
    /// static takes no flash.
    pub const fn empty() -> Self {
        let (slots, size, raw) = ([[0; 2]; SLOTS], NO_PIXELS, NO_PIXELS);
        Self { slots, shift: 0, piece: 0, lattice_rows: 0, nodes: 0, size, raw, rows: 0 }
    }

    /// Tabulates a warp.
    pub fn new<T: Real>(warp: &Warp<T>) -> Result<Self, RemapTableError> {
        let mut table = Self::empty();
        table.set(warp)?;
        Ok(table)
    }

    /// Tabulates a warp in place; a refused warp leaves [`Self::empty`].
    pub fn set<T: Real>(&mut self, warp: &Warp<T>) -> Result<(), RemapTableError> {
        (self.size, self.raw) = (warp.size(), warp.raw_size());
        self.make(warp).inspect_err(|_| self.clear())
    }

    /// Resets to [`Self::empty`].
    pub(super) fn clear(&mut self) {
        (self.size, self.raw, self.rows) = (NO_PIXELS, NO_PIXELS, 0);
        (self.lattice_rows, self.nodes) = (0, 0);
    }

    fn make<T: Real>(&mut self, warp: &Warp<T>) -> Result<(), RemapTableError> {
        // Pieces of four pixels are faster.
        for piece in [2, 0] {
            for shift in (FINEST..=self.widest()).rev() {
                self.fill(warp, shift)?;
                self.piece = piece;
                if self.is_near(warp) {
                    self.note_rows();
                    return Ok(());
                }
            }
        }
        Err(RemapTableError::TooBent)
    }

    /// Number of slots for an image of this size with cells of `2^shift` px, shift 3 to 6.
    pub const fn slots(size: ImageSize, shift: u32) -> usize {
        Self::nodes(size, shift) + (size.height as usize).div_ceil(2)
    }

    /// Number of slots that suffice for every warp to an image of this size. The slots of one warp may be a
    /// tenth: `stereo calib check` says them for a rig, as a [`RemapPair`](super::RemapPair) to copy.
    pub const fn most_slots(size: ImageSize) -> usize {
        Self::slots(size, FINEST)
    }

    /// Returns the number of slots that this table takes.
    pub const fn slots_taken(&self) -> usize {
        Self::slots(self.size, self.shift as u32)
    }

    /// Number of lattice points.
    const fn nodes(size: ImageSize, shift: u32) -> usize {
        lattice(size.width, shift) * lattice(size.height, shift)
    }

    /// Widest lattice whose cells are no wider than the image.
    fn widest(&self) -> u32 {
        let side = u32::from(self.size.width.min(self.size.height));
        (FINEST..=WIDEST).rev().find(|shift| 1 << shift <= side).unwrap_or(FINEST)
    }

    fn fill<T: Real>(&mut self, warp: &Warp<T>, shift: u32) -> Result<(), RemapTableError> {
        let (rows, needed) = (lattice(self.size.height, shift), Self::slots(self.size, shift));
        let slots = self.slots.get_mut(..needed).ok_or(RemapTableError::Slots { needed })?;
        let count = Self::nodes(self.size, shift);
        let nodes = slots.get_mut(..count).unwrap_or_default();
        (self.shift, self.lattice_rows, self.nodes) = (shift as u8, rows as u16, count as u32);
        for (x, column) in nodes.chunks_exact_mut(rows).enumerate() {
            for (y, node) in column.iter_mut().enumerate() {
                // The lattice begins one cell outside the image.
                let place = |i: usize| T::count(i << shift) - T::count(1 << shift);
                *node = match warp.source(&Point2::new(place(x), place(y))) {
                    Ok(source) => fixed(&source.pixel, source.is_described),
                    Err(_) => [1, 0],
                };
            }
        }
        Ok(())
    }

    /// Returns the size of the rectified image.
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// Returns the size of the raw image.
    pub fn raw_size(&self) -> ImageSize {
        self.raw
    }

    /// Returns the side of a lattice cell as a power of two, 3 to 6.
    pub fn shift(&self) -> u32 {
        u32::from(self.shift)
    }

    /// Returns the number of pixels of a straight piece, as a power of two: 2, or 0 for a strongly curved
    /// warp.
    pub fn piece(&self) -> u32 {
        u32::from(self.piece)
    }

    /// Returns the number of raw rows that must be held at once, with lines in order.
    pub fn rows(&self) -> u16 {
        self.rows
    }

    /// Returns the lattice, column by column from one cell left of and above the image: column and row in
    /// 1/65536 px, with the column's lowest bit set where the lens model does not describe the position.
    pub fn places(&self) -> &[[i32; 2]] {
        self.slots.get(..self.nodes as usize).unwrap_or(&[])
    }

    /// Returns the first and the last raw row that a rectified row needs; `None` where it is outside the raw
    /// image.
    pub fn raw_rows(&self, row: u16) -> Option<(u16, u16)> {
        let noted = self.noted(row);
        let (first, last) = (noted as u16, (noted >> 16) as u16 & !(WHOLE >> 16) as u16);
        (first <= last).then_some((first, last))
    }

    /// Whether all pixels of a row are inside the raw image, before its last column and row.
    pub(super) fn is_whole(&self, row: u16) -> bool {
        self.noted(row) & WHOLE != 0
    }

    /// Entry of a row; [`NOWHERE`] outside the image.
    fn noted(&self, row: u16) -> u32 {
        let slot = self.slots.get(self.nodes as usize + usize::from(row / 2));
        slot.and_then(|slot| slot.get(usize::from(row % 2))).map_or(NOWHERE, |noted| noted.cast_unsigned())
    }

    /// Writes the mask of a rectified row, 1 for a valid pixel, else 0, as many as fit.
    pub fn mask(&self, row: u16, valid: &mut [u8]) {
        let width = valid.len().min(self.size.width.into());
        let Some(valid) = valid.get_mut(..width) else { return };
        let (cell, is_whole) = (1 << self.shift, self.is_whole(row));
        valid.fill(1);
        for (valid, segment) in valid.chunks_mut(cell).zip(self.segments(row, is_whole)) {
            segment.mask(self.raw, self.piece(), valid);
        }
    }

    /// Computes which raw rows each row needs, and how many must be held at once.
    fn note_rows(&mut self) {
        let begin = self.nodes as usize;
        let last_row = i32::from(self.raw.height.saturating_sub(1));
        let of = |place: i32| (place >> BITS).max(0).min(last_row);
        let cell = Cell::new(self.shift(), self.piece());
        let (mut last_so_far, mut most) = (0, 0);
        for row in 0..self.size.height {
            let (mut first, mut last, mut whole) = (i32::from(u16::MAX), 0, true);
            for segment in self.segments(row, false) {
                whole &= segment.part == Part::All;
                if segment.part != Part::None {
                    let (least, greatest) = segment.row.reach(&cell);
                    first = first.min(of(least));
                    last = last.max((of(greatest) + 1).min(last_row));
                }
            }
            let slot = self.slots.get_mut(begin + usize::from(row / 2));
            if let Some(noted) = slot.and_then(|slot| slot.get_mut(usize::from(row % 2))) {
                *noted = first | last << 16 | if whole { WHOLE.cast_signed() } else { 0 };
            }
            if first <= last {
                last_so_far = last.max(last_so_far);
                most = most.max(last_so_far - first + 1);
            }
        }
        // At most a raw image's.
        self.rows = most as u16;
    }

    /// Segments of a rectified row, which is wholly inside the raw image if `is_whole`.
    #[inline]
    pub(super) fn segments(&self, row: u16, is_whole: bool) -> Segments<'_> {
        // The row is between the second and the third of four from here on in each column.
        let around = self.places().get(usize::from(row >> self.shift)..).unwrap_or(&[]);
        let columns = around.chunks(usize::from(self.lattice_rows).max(1));
        let (shift, piece, raw) = (self.shift(), self.piece(), self.raw);
        Segments::new(Lattice { columns, shift, piece, raw }, row, is_whole)
    }
}

/// Lattice points along a side: those of the cells, one before and two after.
const fn lattice(side: u16, shift: u32) -> usize {
    (side as usize).div_ceil(1 << shift) + 3
}

/// Rounds a position to 1/65536 px.
fn fixed<T: Real>(place: &Point2<T>, is_described: bool) -> [i32; 2] {
    let is_near = |x: T| x >= T::of(FARTHEST.0) && x <= T::of(FARTHEST.1);
    let to_fixed = |x: T| {
        let x = x.max(T::of(FARTHEST.0)).min(T::of(FARTHEST.1));
        (x * T::of(65536.0) + T::of(0.5)).floor().to_f64() as i32
    };
    let is_one = is_described && is_near(place.x) && is_near(place.y);
    [to_fixed(place.x) & !1 | i32::from(!is_one), to_fixed(place.y)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_is_rounded_and_marked_where_it_is_none() {
        let at = |x: f64, y: f64| fixed(&Point2::new(x, y), true);
        assert_eq!(at(1.0, -2.0), [65536, -131_072]);
        assert_eq!(fixed(&Point2::new(1.0, -2.0), false), [65537, -131_072]);
        // Rounded to nearest, columns to even numbers below.
        assert_eq!(at(4.4 / 65536.0, 4.4 / 65536.0), [4, 4]);
        assert_eq!(at(5.6 / 65536.0, 5.6 / 65536.0), [6, 6]);
        // From 2048 px to the left and above to 6143 px to the right and below.
        let [first, last] = [-2048, 6143].map(|px| px << 16);
        assert_eq!([at(-2048.0, 6143.0), at(6143.0, -2048.0)], [[first, last], [last, first]]);
        assert_eq!([at(-2049.0, 0.0), at(6144.0, 0.0)], [[first | 1, 0], [last | 1, 0]]);
        assert_eq!([at(0.0, -2049.0), at(0.0, 6144.0)], [[1, first], [1, last]]);
    }

    #[test]
    fn slots_are_of_nodes_and_of_two_rows_each() {
        let size = |width: u16, height: u16| ImageSize { width, height };
        // One node before and two after those of the cells.
        assert_eq!(RemapTable::<0>::slots(size(64, 48), 3), (8 + 3) * (6 + 3) + 24);
        assert_eq!(RemapTable::<0>::slots(size(65, 49), 3), (9 + 3) * (7 + 3) + 25);
        assert_eq!(RemapTable::<0>::slots(size(64, 48), 6), (1 + 3) * (1 + 3) + 24);
        assert_eq!(RemapTable::<0>::most_slots(size(64, 48)), RemapTable::<0>::slots(size(64, 48), 3));
        let widest = |side: u16| RemapTable::<0> { size: size(99, side), ..RemapTable::empty() }.widest();
        assert_eq!([1, 8, 15, 16, 31, 32, 63, 64, 98].map(widest), [3, 3, 3, 4, 4, 5, 5, 6, 6]);
    }
}
