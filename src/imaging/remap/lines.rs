//! Rectification of one camera: a band of raw lines in, rectified lines out.

use super::sample::Band;
use super::segment::Part;
use super::{RemapError, RemapTable};
use crate::geometry::{Real, rectify::Warp};
use core::cell::Cell;

/// Rectification of one camera's lines.
///
/// The capacity is `W` columns of the raw and the rectified image, and `N` lines, one of which is a copy, so
/// that two adjacent rows are always adjacent in memory: [`RemapTable::rows`] is at most `N - 1`. The state
/// takes `N W` bytes, the table, and a few words.
///
/// Pixels are interpolated bilinearly, with weights in 256ths. A pixel outside the raw image, or not
/// described by the lens model, is 0 and invalid.
///
/// ```
/// use stereopsis::geometry::{camera::{Camera, ImageSize, Pose, StereoRig}, rectify::{Crop, Rectification}};
/// use stereopsis::imaging::{Remap, RemapTable};
/// use nalgebra::{Matrix3, Vector3};
/// let size = ImageSize { width: 64, height: 8 };
/// let camera = Camera::new(60.0, 60.0, 31.5, 3.5)?;
/// let lower = Camera::new(60.0, 60.0, 31.5, 4.5)?;
/// let rig = StereoRig::new([camera, lower], Pose::new(Matrix3::identity(), Vector3::x())?, [size; 2])?;
/// let rectified = Rectification::new(&rig, Crop::Natural, size)?;
/// let mut remap = Remap::<64, 4, 48>::new(RemapTable::new(&rectified.warps()[1])?)?;
/// let (mut line, mut valid) = ([0; 64], [0; 64]);
/// remap.begin();
/// for brightness in [10, 20] {
///     remap.next_line().fill(brightness);
///     remap.accept();
/// }
/// // Rectification moves each camera by half a pixel: these rows lie between two raw ones.
/// assert_eq!(remap.row(&mut line, &mut valid)?, 0);
/// assert_eq!((line[0], valid[0]), (15, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Remap<const W: usize, const N: usize, const SLOTS: usize> {
    table: RemapTable<SLOTS>,
    lines: [[u8; W]; N],
    /// Number of raw lines accepted.
    came: u16,
    /// Next rectified row.
    next: u16,
    /// First and last raw row that the next rectified row needs.
    needs: Option<(u16, u16)>,
}

impl<const W: usize, const N: usize, const SLOTS: usize> Remap<W, N, SLOTS> {
    /// Number of raw rows that the band holds.
    const ROWS: u16 = {
        assert!(N >= 3 && N <= 4097, "two rows are looked at at once, and one line is a copy");
        assert!(W >= 2 && W <= 4096);
        N as u16 - 1
    };

    /// Creates a remap to an image without pixels, for a static; [`Self::set`] gives it a warp.
    pub const fn empty() -> Self {
        Self { table: RemapTable::empty(), lines: [[0; W]; N], came: 0, next: 0, needs: None }
    }

    /// Creates a remap by a table; refused when the band is too small for it.
    pub fn new(table: RemapTable<SLOTS>) -> Result<Self, RemapError> {
        let mut remap = Self { table, ..Self::empty() };
        remap.check()?;
        remap.begin();
        Ok(remap)
    }

    /// Sets the warp in place; a refused warp leaves [`Self::empty`].
    pub fn set<T: Real>(&mut self, warp: &Warp<T>) -> Result<(), RemapError> {
        self.table.set(warp).map_err(RemapError::Table)?;
        let checked = self.check();
        if checked.is_err() {
            self.table.clear();
        }
        self.begin();
        checked
    }

    /// Checks that the band is large enough for the table.
    fn check(&self) -> Result<(), RemapError> {
        let rows = self.table.rows();
        if rows > Self::ROWS {
            return Err(RemapError::Lines { needed: usize::from(rows) + 1 });
        }
        let needed = usize::from(self.table.raw_size().width.max(self.table.size().width));
        if needed > W { Err(RemapError::Width { needed }) } else { Ok(()) }
    }

    /// Returns the table.
    pub fn table(&self) -> &RemapTable<SLOTS> {
        &self.table
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        (self.came, self.next) = (0, 0);
        self.needs = self.table.raw_rows(0);
    }

    /// Returns the buffer for the next raw line, which counts once [`Self::accept`] is called.
    pub fn next_line(&mut self) -> &mut [u8] {
        let (slot, width) = (usize::from(self.came % Self::ROWS), usize::from(self.table.raw_size().width));
        self.lines.get_mut(slot).and_then(|line| line.get_mut(..width)).unwrap_or_default()
    }

    /// Writes the raw line above into [`Self::next_line`], zeros for a frame's first line: what stands for a
    /// lost one.
    pub fn repeat(&mut self) {
        let [above, slot] = [self.came.saturating_sub(1), self.came].map(|row| usize::from(row % Self::ROWS));
        match self.lines.get_disjoint_mut([above, slot]) {
            Ok([above, line]) => *line = *above,
            Err(_) => self.next_line().fill(0),
        }
    }

    /// Accepts the raw line in [`Self::next_line`].
    pub fn accept(&mut self) {
        if self.came.is_multiple_of(Self::ROWS)
            && let [first, .., copy] = self.lines.as_mut_slice()
        {
            *copy = *first;
        }
        self.came = self.came.saturating_add(1);
    }

    /// Returns the number of raw lines accepted since [`Self::begin`].
    pub fn came(&self) -> u16 {
        self.came
    }

    /// Returns the row that [`Self::row`] gives next; the height after the last one.
    pub fn next_row(&self) -> u16 {
        self.next
    }

    /// Returns whether the next rectified line needs another raw line. Take all rectified lines that do not
    /// before accepting the next raw line, which may overwrite what they need.
    pub fn wants_line(&self) -> bool {
        let last = self.needs.map_or(0, |(_, last)| last + 1);
        self.next < self.table.size().height && self.came < last
    }

    /// Returns the first and the last raw row that the next rectified row needs; `None` where it sees none.
    pub fn needs(&self) -> Option<(u16, u16)> {
        self.needs
    }

    /// Passes over the next rectified row.
    pub fn skip(&mut self) {
        let height = self.table.size().height;
        self.next = height.min(self.next.saturating_add(1));
        self.needs = if self.next < height { self.table.raw_rows(self.next) } else { None };
    }

    /// Writes the next rectified line and its mask (1 for a valid pixel, else 0), and returns its row.
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
        let (raw, piece) = (self.table.raw_size(), self.table.piece());
        let band = Band::new(&self.lines, first - first % Self::ROWS, raw, piece);
        let cell = 1 << self.table.shift();
        let mut segments = self.table.segments(row, self.table.is_whole(row));
        #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
        super::armv7em::fill_with_ones(valid);
        #[cfg(not(any(stereopsis_dsp, stereopsis_vectors)))]
        valid.fill(1);
        for (out, valid) in out.chunks_mut(cell).zip(valid.chunks_mut(cell)) {
            let Some(segment) = segments.step() else { break };
            match segment.part {
                Part::All => band.segment::<false>(segment, Cell::from_mut(out).as_slice_of_cells(), valid),
                Part::Some => {
                    segment.mask(raw, piece, valid);
                    band.segment::<true>(segment, Cell::from_mut(out).as_slice_of_cells(), valid);
                }
                Part::None => {
                    valid.fill(0);
                    out.fill(0);
                }
            }
        }
        self.skip();
        Ok(row)
    }
}
