//! Raw lines in a band, and rectified lines out of it.

use super::RemapTable;
use super::segment::{BITS, Part, Segment, Segments};
use crate::geometry::ImageSize;

/// Columns of the raw image that four rectified ones may span to be looked up at once.
const SPAN: usize = 8;

/// One camera's raw lines, rectified.
///
/// `W` is the capacity for columns, of the raw and of the rectified image. `N` lines are held, one of which is a copy of another, so that a line and
/// the next one always stand together: raw rows are remapped that need [`RemapTable::rows`] of at most `N - 1`. The state is
/// `N W` bytes, the table, and a few words.
///
/// A pixel between four raw ones is their mean, weighted in 256ths of a pixel along both directions (bilinear). A pixel whose
/// place is outside the raw image, or not described by the lens model, is 0 and not valid.
///
/// ```
/// use stereopsis::geometry::{Camera, Crop, ImageSize, Pose, Rectification, StereoRig};
/// use stereopsis::imaging::{Remap, RemapTable};
/// use nalgebra::{Matrix3, Vector3};
/// let size = ImageSize { width: 64, height: 8 };
/// let camera = Camera::new(60.0, 60.0, 31.5, 3.5)?;
/// let lower = Camera::new(60.0, 60.0, 31.5, 4.5)?;
/// let rig = StereoRig::new([camera, lower], Pose::new(Matrix3::identity(), Vector3::x())?, [size; 2])?;
/// let rectified = Rectification::new(&rig, Crop::Natural, size)?;
/// let mut remap = Remap::<64, 4, 24>::new(RemapTable::new(&rectified.warps()[1])?)?;
/// let (mut line, mut valid) = ([0; 64], [0; 64]);
/// remap.begin();
/// for brightness in [10, 20] {
///     remap.next_line().fill(brightness);
///     remap.accept();
/// }
/// // Both cameras go halfway: this one's rows are between two of its own.
/// assert_eq!(remap.row(&mut line, &mut valid)?, 0);
/// assert_eq!((line[0], valid[0]), (15, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Remap<const W: usize, const N: usize, const SLOTS: usize> {
    table: RemapTable<SLOTS>,
    lines: [[u8; W]; N],
    /// Raw lines that came.
    came: u16,
    /// The rectified row that is next.
    next: u16,
    /// The first and the last raw row that it needs.
    needs: Option<(u16, u16)>,
}

/// Why lines are not remapped.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RemapError {
    /// The warp needs more raw lines at once than are held.
    Lines {
        /// How many lines `N` would have been enough.
        needed: usize,
    },
    /// The raw or the rectified lines are longer than there is room for.
    Width {
        /// The capacity `W` that would have been enough.
        needed: usize,
    },
    /// The buffers for a rectified line and its mask are too short.
    BufferTooShort {
        /// Bytes that would have been enough.
        needed: usize,
    },
    /// The next rectified line needs a raw line that did not come yet.
    Early {
        /// How many raw lines are needed.
        needed: u16,
    },
    /// A raw line that the next rectified line needs was overwritten: more raw lines were accepted than it waited for.
    Late {
        /// The row of the rectified line.
        row: u16,
    },
    /// The frame's last rectified line was taken.
    NoLineLeft,
}

impl core::fmt::Display for RemapError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Lines { needed } => write!(f, "the remap must hold {needed} raw lines at once"),
            Self::Width { needed } => write!(f, "the remap must have room for lines of {needed} px"),
            Self::BufferTooShort { needed } => write!(f, "the line's and the mask's buffers must hold {needed} bytes"),
            Self::Early { needed } => write!(f, "the next rectified line needs {needed} raw lines"),
            Self::Late { row } => write!(f, "a raw line that rectified row {row} needs is no longer held"),
            Self::NoLineLeft => f.write_str("no rectified line is left in this frame"),
        }
    }
}

impl core::error::Error for RemapError {}

impl<const W: usize, const N: usize, const SLOTS: usize> Remap<W, N, SLOTS> {
    /// Raw rows that are held: one line is a copy.
    const ROWS: u16 = {
        assert!(N >= 3 && N <= 4097, "two rows are looked at at once, and one line is a copy");
        assert!(W >= 2 && W <= 4096);
        N as u16 - 1
    };

    /// A remap through a table; refused when the band is too small for it.
    pub fn new(table: RemapTable<SLOTS>) -> Result<Self, RemapError> {
        let rows = table.rows();
        if rows > Self::ROWS {
            return Err(RemapError::Lines { needed: usize::from(rows) + 1 });
        }
        let needed = usize::from(table.raw_size().width.max(table.size().width));
        if needed > W {
            return Err(RemapError::Width { needed });
        }
        let mut remap = Self { table, lines: [[0; W]; N], came: 0, next: 0, needs: None };
        remap.begin();
        Ok(remap)
    }

    /// The table.
    pub fn table(&self) -> &RemapTable<SLOTS> {
        &self.table
    }

    /// Forgets all lines: the next one is the first of a frame.
    pub fn begin(&mut self) {
        (self.came, self.next) = (0, 0);
        self.needs = self.table.raw_rows(0);
    }

    /// Where the next raw line goes. It counts once [`Self::accept`] is called.
    pub fn next_line(&mut self) -> &mut [u8] {
        let (slot, width) = (usize::from(self.came % Self::ROWS), usize::from(self.table.raw_size().width));
        self.lines.get_mut(slot).and_then(|line| line.get_mut(..width)).unwrap_or_default()
    }

    /// The raw line is whole.
    pub fn accept(&mut self) {
        if self.came.is_multiple_of(Self::ROWS)
            && let [first, .., copy] = self.lines.as_mut_slice()
        {
            *copy = *first;
        }
        self.came = self.came.saturating_add(1);
    }

    /// Raw lines accepted since [`Self::begin`].
    pub fn came(&self) -> u16 {
        self.came
    }

    /// The rectified row that [`Self::row`] gives next; the height after the last one.
    pub fn next_row(&self) -> u16 {
        self.next
    }

    /// Whether the next rectified line waits for a raw line. Take all that do not before the next raw line is accepted: what
    /// they need would be overwritten.
    pub fn wants_line(&self) -> bool {
        let last = self.needs.map_or(0, |(_, last)| last + 1);
        self.next < self.table.size().height && self.came < last
    }

    /// The next rectified line, and whether each of its pixels is valid (1 or 0); returns its row.
    pub fn row(&mut self, out: &mut [u8], valid: &mut [u8]) -> Result<u16, RemapError> {
        let row = self.next;
        if row >= self.table.size().height {
            return Err(RemapError::NoLineLeft);
        }
        let needed = usize::from(self.table.size().width);
        let too_short = RemapError::BufferTooShort { needed };
        let out = out.get_mut(..needed).ok_or(too_short)?;
        let valid = valid.get_mut(..needed).ok_or(too_short)?;
        let (first, last) = self.needs.unwrap_or((0, 0));
        if self.wants_line() {
            return Err(RemapError::Early { needed: last + 1 });
        }
        if self.needs.is_some() && self.came - first > Self::ROWS {
            return Err(RemapError::Late { row });
        }
        // Rows in the band are counted from the slot of the first one that is needed.
        let shift = (i32::from(first) - i32::from(first % Self::ROWS)) << BITS;
        let raw = self.table.raw_size();
        let cell = 1 << self.table.shift();
        let segments = Segments::new(&self.table, row);
        for ((out, valid), segment) in out.chunks_mut(cell).zip(valid.chunks_mut(cell)).zip(segments) {
            segment.mask(raw, self.table.piece(), valid);
            match segment.part {
                Part::None => out.fill(0),
                Part::All => self.inside(&segment, shift, out),
                Part::Some => self.at_the_edge(&segment, shift, out, valid),
            }
        }
        self.next += 1;
        self.needs = if self.next < self.table.size().height { self.table.raw_rows(self.next) } else { None };
        Ok(row)
    }

    /// The pixels of a segment that is inside the raw image.
    #[inline(never)]
    fn inside(&self, segment: &Segment, shift: i32, out: &mut [u8]) {
        let lines = self.lines.as_flattened();
        let (mut column, mut row) = (segment.column, segment.row);
        row.start -= shift;
        let piece = self.table.piece();
        for four in out.chunks_mut(1 << piece) {
            let (mut x, mut y) = (column.start, row.start);
            // Mostly all of a piece are between the same two rows, and a few columns: these are looked up once.
            let last = (x.wrapping_add(column.step.wrapping_mul(3)), y.wrapping_add(row.step.wrapping_mul(3)));
            let is_one_row = (y ^ last.1) >> BITS == 0;
            let columns = ((last.0 >> BITS) - (x >> BITS)) as u32;
            let at = at::<W, N>((x >> BITS) as u32, (y >> BITS) as u32);
            let is_together = is_one_row && columns < SPAN as u32 && at <= (N * W).saturating_sub(W + SPAN + 1);
            match lines.get(at..at.wrapping_add(W + SPAN + 1)) {
                Some(window) if is_together => {
                    let mut along = x & ((1 << BITS) - 1);
                    for out in four {
                        let at = (along >> BITS) as usize % SPAN;
                        let pixel = |at: usize| u32::from(window.get(at).copied().unwrap_or(0));
                        let around = [pixel(at), pixel(at + 1), pixel(at + W), pixel(at + W + 1)];
                        *out = weighted(around, fraction(along), fraction(y));
                        along = along.wrapping_add(column.step);
                        y = y.wrapping_add(row.step);
                        // Pixel by pixel: unrolled, this has more numbers at hand than a Cortex-M has registers.
                        core::hint::black_box(());
                    }
                }
                _ => {
                    for out in four {
                        *out = between::<W, N>(lines, x, y);
                        x = x.wrapping_add(column.step);
                        y = y.wrapping_add(row.step);
                        core::hint::black_box(());
                    }
                }
            }
            column.advance(piece);
            row.advance(piece);
        }
    }

    /// The pixels of a segment of which some are not.
    fn at_the_edge(&self, segment: &Segment, shift: i32, out: &mut [u8], valid: &[u8]) {
        let lines = self.lines.as_flattened();
        let raw = self.table.raw_size();
        let places = segment.column.places(self.table.piece()).zip(segment.row.places(self.table.piece()));
        for ((out, &valid), (column, row)) in out.iter_mut().zip(valid).zip(places) {
            *out = if valid == 0 {
                0
            } else {
                let (x, right) = split(column, raw.width);
                let (y, down) = split(row, raw.height);
                weighted(four::<W, N>(lines, x, y.wrapping_sub((shift >> BITS) as u32)), right, down)
            };
        }
    }
}

impl Segment {
    /// Whether its pixels are in the raw image.
    pub(super) fn mask(&self, raw: ImageSize, piece: u32, valid: &mut [u8]) {
        match self.part {
            Part::None => valid.fill(0),
            Part::All => valid.fill(1),
            Part::Some => {
                let is_in = |place: i32, side: u16| place >= 0 && place >> (BITS - 8) <= (i32::from(side) - 1) << 8;
                for ((valid, column), row) in
                    valid.iter_mut().zip(self.column.places(piece)).zip(self.row.places(piece))
                {
                    *valid = (is_in(column, raw.width) && is_in(row, raw.height)).into();
                }
            }
        }
    }
}

/// A place as a pixel that has another after it, and 256ths of the way to that: all of it on the image's last one.
fn split(place: i32, side: u16) -> (u32, u32) {
    let whole = (place >> BITS).clamp(0, i32::from(side) - 2);
    (whole as u32, (place >> (BITS - 8)).wrapping_sub(whole << 8) as u32)
}

/// 256ths of the way from a place's pixel to the next.
#[inline(always)]
fn fraction(place: i32) -> u32 {
    (place >> (BITS - 8)) as u32 & 0xff
}

/// The pixel at a place of the band.
#[inline(always)]
fn between<const W: usize, const N: usize>(lines: &[u8], column: i32, row: i32) -> u8 {
    weighted(four::<W, N>(lines, (column >> BITS) as u32, (row >> BITS) as u32), fraction(column), fraction(row))
}

/// Where a pixel is in the band.
#[inline(always)]
fn at<const W: usize, const N: usize>(column: u32, row: u32) -> usize {
    let rows = N as u32 - 1;
    // Slots are counted from one within the band: those past its end begin again.
    let slot = if rows.is_power_of_two() { row & (rows - 1) } else { row.min(row.wrapping_sub(rows)) };
    (slot as usize).wrapping_mul(W).wrapping_add(column as usize)
}

/// Four pixels of the band: two neighbours, and the two below.
#[inline(always)]
fn four<const W: usize, const N: usize>(lines: &[u8], column: u32, row: u32) -> [u32; 4] {
    let at = at::<W, N>(column, row);
    if at > N * W - W - 2 {
        return [0; 4];
    }
    let pixel = |at: usize| u32::from(lines.get(at).copied().unwrap_or(0));
    [pixel(at), pixel(at + 1), pixel(at + W), pixel(at + W + 1)]
}

/// Their mean, weighted by 256ths of a pixel to the right and down, to the nearest.
#[inline(always)]
fn weighted([a, b, c, d]: [u32; 4], right: u32, down: u32) -> u8 {
    let top = (a << 8).wrapping_add(b.wrapping_sub(a).wrapping_mul(right));
    let bottom = (c << 8).wrapping_add(d.wrapping_sub(c).wrapping_mul(right));
    let mean = (top << 8).wrapping_add(bottom.wrapping_sub(top).wrapping_mul(down));
    (mean.wrapping_add(1 << 15) >> 16) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_of_four() {
        assert_eq!(weighted([10, 20, 30, 40], 0, 0), 10);
        assert_eq!(weighted([10, 20, 30, 40], 128, 0), 15);
        assert_eq!(weighted([10, 20, 30, 40], 128, 128), 25);
        assert_eq!(weighted([10, 20, 30, 40], 256, 256), 40);
    }

    #[test]
    fn the_band_begins_again() {
        // Three rows and the copy of the first.
        let lines = [[1, 2], [3, 4], [5, 6], [1, 2]];
        assert_eq!(four::<2, 4>(lines.as_flattened(), 0, 2), [5, 6, 1, 2]);
        assert_eq!(four::<2, 4>(lines.as_flattened(), 0, 4), [3, 4, 5, 6]);
    }
}
