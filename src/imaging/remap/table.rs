//! A warp as a coarse lattice of places.

use super::segment::{BITS, Cell, Part, Run, Segments};
use crate::geometry::{Real, camera::ImageSize, rectify::Warp};
use nalgebra::Point2;

/// Where the pixels of a rectified image are in the raw one: a lattice of places every 8, 16, 32 or 64 px, in
/// 1/65536 px.
///
/// Between the lattice's rows a place is on the cubic through four of them, between its columns on a parabola
/// that is bent as that cubic, drawn as straight lines of four pixels where these do; all in integers, so
/// that every core finds the same places. The widest lattice is taken with which the places stay
/// within [`Self::TOLERANCE_PX`] of the warp's own, which is looked at in every fourth row and every second
/// column. It takes 8 bytes for a slot, which [`Self::slots`] counts.
///
/// [`Self::raw_rows`] of every row follow the lattice, two in the room of a place.
///
/// Made from the same warp in the same type, `f32` or `f64`, it is the same on every core: it takes products,
/// quotients and roots alone.
#[derive(Clone, Debug)]
pub struct RemapTable<const SLOTS: usize> {
    /// The lattice, row by row: column and row, where the lowest bit of the column says that the lens model
    /// does not describe the place. Then the raw rows that each rectified row needs: the first and, 16
    /// bits higher, the last; and whether all of the row is in the raw image.
    slots: [[i32; 2]; SLOTS],
    shift: u8,
    piece: u8,
    size: ImageSize,
    raw: ImageSize,
    rows: u16,
}

/// Why a warp has no table.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RemapTableError {
    /// The table has too little room.
    Slots {
        /// How many slots would have been enough.
        needed: usize,
    },
    /// The warp bends too much for the finest lattice, or most of the rectified image is behind the camera.
    TooBent,
}

impl core::fmt::Display for RemapTableError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Slots { needed } => write!(f, "the remap table must have {needed} slots"),
            Self::TooBent => f.write_str("the warp bends too much between 8 pixels"),
        }
    }
}

impl core::error::Error for RemapTableError {}

/// The widest lattice and the finest: powers of two.
const WIDEST: u32 = 6;
const FINEST: u32 = 3;
/// The size of no image.
const NO_PIXELS: ImageSize = ImageSize { width: 0, height: 0 };
/// Added to what is noted of a row when all of it is in the raw image: its last raw row is less than 4096.
const WHOLE: u32 = 1 << 31;
/// What is noted of a row that shows nothing of the raw image: its first raw row is after the last.
const NOWHERE: u32 = 0xffff;
/// Places farther outside the raw image than this on the left and above, and farther than that on the right
/// and below, say no more than that they are outside. Sums of four fit a word.
const FARTHEST: (f64, f64) = (-2048.0, 6143.0);

impl<const SLOTS: usize> RemapTable<SLOTS> {
    /// How far a place that is looked at may be from the warp's, px: then all are within 0.05 px.
    pub const TOLERANCE_PX: f64 = 0.03;

    /// A table of an image without pixels, to be [`set`](Self::set) where it stands.
    pub const fn empty() -> Self {
        Self {
            slots: [[1, 0]; SLOTS],
            shift: FINEST as u8,
            piece: 0,
            size: NO_PIXELS,
            raw: NO_PIXELS,
            rows: 0,
        }
    }

    /// The table of a warp.
    pub fn new<T: Real>(warp: &Warp<T>) -> Result<Self, RemapTableError> {
        let mut table = Self::empty();
        table.set(warp)?;
        Ok(table)
    }

    /// Makes it the table of a warp, without another in between; [`Self::empty`] when there is none.
    pub fn set<T: Real>(&mut self, warp: &Warp<T>) -> Result<(), RemapTableError> {
        (self.size, self.raw) = (warp.size(), warp.raw_size());
        self.make(warp).inspect_err(|_| self.clear())
    }

    /// Leaves it [`Self::empty`].
    pub(super) fn clear(&mut self) {
        (self.size, self.raw, self.rows) = (NO_PIXELS, NO_PIXELS, 0);
    }

    fn make<T: Real>(&mut self, warp: &Warp<T>) -> Result<(), RemapTableError> {
        // Four pixels at a time along a line are faster.
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

    /// How many slots the table of an image of that size takes with cells of `2^shift` px, shift 6 to 3.
    pub const fn slots(size: ImageSize, shift: u32) -> usize {
        Self::nodes(size, shift) + (size.height as usize).div_ceil(2)
    }

    /// How many of them are the lattice's places.
    const fn nodes(size: ImageSize, shift: u32) -> usize {
        lattice(size.width, shift) * lattice(size.height, shift)
    }

    /// The widest lattice whose cells are no wider than the image: places far outside say little about it.
    fn widest(&self) -> u32 {
        let side = u32::from(self.size.width.min(self.size.height));
        (FINEST..=WIDEST).rev().find(|shift| 1 << shift <= side).unwrap_or(FINEST)
    }

    fn fill<T: Real>(&mut self, warp: &Warp<T>, shift: u32) -> Result<(), RemapTableError> {
        let (columns, needed) = (lattice(self.size.width, shift), Self::slots(self.size, shift));
        let slots = self.slots.get_mut(..needed).ok_or(RemapTableError::Slots { needed })?;
        let nodes = slots.get_mut(..Self::nodes(self.size, shift)).unwrap_or_default();
        self.shift = shift as u8;
        for (y, row) in nodes.chunks_exact_mut(columns).enumerate() {
            for (x, node) in row.iter_mut().enumerate() {
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

    /// Whether the places are those of the warp, where they are in the raw image.
    fn is_near<T: Real>(&self, warp: &Warp<T>) -> bool {
        let cell = 1 << self.shift;
        let scale = T::of(1.0 / 65536.0);
        let one = |run: &Run, k: usize| {
            let place = run.places(self.piece()).nth(k).unwrap_or(0);
            // Half a 256th was added, for the pixels' weights.
            (T::of(f64::from(place)) - T::of(128.0)) * scale
        };
        let last = self.size.height.saturating_sub(1);
        for y in (0..last).step_by(4).chain([last]) {
            for (segment, x) in Segments::new(self, y, false).zip((0..).step_by(cell)) {
                let length = cell.min(usize::from(self.size.width) - x);
                // At the ends and in the middle of each four.
                for k in (0..length).step_by(2) {
                    let Ok(source) = warp.source(&Point2::new(T::count(x + k), T::count(y.into()))) else {
                        continue;
                    };
                    let found = Point2::new(one(&segment.column, k), one(&segment.row, k));
                    let is_asked = source.is_described && warp.is_in_raw(&source.pixel);
                    // A place that is not described takes its cell with it: small ones only.
                    if is_asked && segment.part == Part::None {
                        if self.shift() > FINEST {
                            return false;
                        }
                        continue;
                    }
                    if is_asked && (found - source.pixel).norm() > T::of(Self::TOLERANCE_PX) {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// The size of the rectified image.
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// The size of the raw image.
    pub fn raw_size(&self) -> ImageSize {
        self.raw
    }

    /// The side of a lattice cell as a power of two.
    pub fn shift(&self) -> u32 {
        // 3 to 6.
        u32::from(self.shift)
    }

    /// How many pixels along a line lie on a straight piece, as a power of two: 4, or 1 where the warp is
    /// bent a lot.
    pub fn piece(&self) -> u32 {
        u32::from(self.piece)
    }

    /// Raw rows that have to be held at once, when raw lines come one after the other and rectified lines are
    /// taken in order.
    pub fn rows(&self) -> u16 {
        self.rows
    }

    /// The lattice's places, row by row, the first a cell left of and above the image; column and row in
    /// 1/65536 px, where the lowest bit of the column is set when the lens model does not describe the
    /// place.
    pub fn places(&self) -> &[[i32; 2]] {
        self.slots.get(..Self::nodes(self.size, self.shift())).unwrap_or(&[])
    }

    /// The first and the last raw row that a rectified row needs; none where it shows nothing of the raw
    /// image.
    pub fn raw_rows(&self, row: u16) -> Option<(u16, u16)> {
        let noted = self.noted(row);
        let (first, last) = (noted as u16, (noted >> 16) as u16 & !(WHOLE >> 16) as u16);
        (first <= last).then_some((first, last))
    }

    /// Whether all pixels of a row are in the raw image, and not on its last column or row.
    pub(super) fn is_whole(&self, row: u16) -> bool {
        self.noted(row) & WHOLE != 0
    }

    /// What is noted of a row; of none that it is seen nowhere.
    fn noted(&self, row: u16) -> u32 {
        let slot = self.slots.get(Self::nodes(self.size, self.shift()) + usize::from(row / 2));
        slot.and_then(|slot| slot.get(usize::from(row % 2))).map_or(NOWHERE, |noted| noted.cast_unsigned())
    }

    /// Whether each pixel of a rectified row is seen: 1 or 0, as many as there is room for.
    pub fn mask(&self, row: u16, valid: &mut [u8]) {
        let room = valid.len().min(self.size.width.into());
        let Some(valid) = valid.get_mut(..room) else { return };
        let (cell, is_whole) = (1 << self.shift, self.is_whole(row));
        valid.fill(1);
        for (valid, segment) in valid.chunks_mut(cell).zip(Segments::new(self, row, is_whole)) {
            segment.mask(self.raw, self.piece(), valid);
        }
    }

    /// Notes which raw rows each row needs, and how many are held at most.
    fn note_rows(&mut self) {
        let begin = Self::nodes(self.size, self.shift());
        let last_row = i32::from(self.raw.height.saturating_sub(1));
        let of = |place: i32| (place >> BITS).clamp(0, last_row);
        let cell = Cell::new(self.shift(), self.piece());
        let (mut last_so_far, mut most) = (0, 0);
        for row in 0..self.size.height {
            let (mut first, mut last, mut whole) = (i32::from(u16::MAX), 0, true);
            for segment in Segments::new(self, row, false) {
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

    /// Cells in a row of the lattice that begin in the image.
    pub(super) fn cells(&self) -> u16 {
        self.size.width.div_ceil(1 << self.shift)
    }

    /// The four rows of the lattice around a rectified row.
    pub(super) fn rows_around(&self, row: u16) -> [&[[i32; 2]]; 4] {
        let columns = lattice(self.size.width, self.shift());
        let above = usize::from(row >> self.shift);
        core::array::from_fn(|i| {
            let begin = (above + i) * columns;
            self.slots.get(begin..begin + columns).unwrap_or(&[])
        })
    }
}

/// Places along a side: those of the cells, one before and two after.
const fn lattice(side: u16, shift: u32) -> usize {
    (side as usize).div_ceil(1 << shift) + 3
}

/// A place in 1/65536 px, to the nearest.
fn fixed<T: Real>(place: &Point2<T>, is_described: bool) -> [i32; 2] {
    let is_near = |x: T| x >= T::of(FARTHEST.0) && x <= T::of(FARTHEST.1);
    let to_fixed = |x: T| {
        let x = x.max(T::of(FARTHEST.0)).min(T::of(FARTHEST.1));
        (x * T::of(65536.0) + T::of(0.5)).floor().to_f64() as i32
    };
    let is_one = is_described && is_near(place.x) && is_near(place.y);
    [to_fixed(place.x) & !1 | i32::from(!is_one), to_fixed(place.y)]
}
