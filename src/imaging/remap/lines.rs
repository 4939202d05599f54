//! Raw lines in a band, and rectified lines out of it.

use super::sample::Band;
use super::segment::{Part, Segments};
use super::{RemapTable, RemapTableError};
use crate::geometry::{Real, rectify::Warp};
use core::cell::Cell;

/// One camera's raw lines, rectified.
///
/// `W` is the capacity for columns, of the raw and of the rectified image. `N` lines are held, one of which
/// is a copy of another, so that a line and the next one always stand together: raw rows are remapped that
/// need [`RemapTable::rows`] of at most `N - 1`. The state is `N W` bytes, the table, and a few words.
///
/// A pixel between four raw ones is their mean, weighted in 256ths of a pixel along both directions
/// (bilinear). A pixel whose place is outside the raw image, or not described by the lens model, is 0 and not
/// valid.
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
    /// A raw line that the next rectified line needs was overwritten: more raw lines were accepted than it
    /// waited for.
    Late {
        /// The row of the rectified line.
        row: u16,
    },
    /// The frame's last rectified line was taken.
    NoLineLeft,
    /// The warp has no table.
    Table(RemapTableError),
}

impl core::fmt::Display for RemapError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Lines { needed } => write!(f, "the remap must hold {needed} raw lines at once"),
            Self::Width { needed } => write!(f, "the remap must have room for lines of {needed} px"),
            Self::BufferTooShort { needed } => {
                write!(f, "the line's and the mask's buffers must hold {needed} bytes")
            }
            Self::Early { needed } => write!(f, "the next rectified line needs {needed} raw lines"),
            Self::Late { row } => write!(f, "a raw line that rectified row {row} needs is no longer held"),
            Self::Table(error) => error.fmt(f),
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

    /// A remap to an image without pixels, for a static: [`Self::set`] gives it a warp.
    pub const fn empty() -> Self {
        Self { table: RemapTable::empty(), lines: [[0; W]; N], came: 0, next: 0, needs: None }
    }

    /// A remap through a table; refused when the band is too small for it.
    pub fn new(table: RemapTable<SLOTS>) -> Result<Self, RemapError> {
        let mut remap = Self { table, ..Self::empty() };
        remap.check()?;
        remap.begin();
        Ok(remap)
    }

    /// Makes it the remap of a warp where it stands, in no more memory; [`Self::empty`] when that is refused.
    pub fn set<T: Real>(&mut self, warp: &Warp<T>) -> Result<(), RemapError> {
        self.table.set(warp).map_err(RemapError::Table)?;
        let checked = self.check();
        if checked.is_err() {
            self.table.clear();
        }
        self.begin();
        checked
    }

    /// Whether the band is large enough for the table.
    fn check(&self) -> Result<(), RemapError> {
        let rows = self.table.rows();
        if rows > Self::ROWS {
            return Err(RemapError::Lines { needed: usize::from(rows) + 1 });
        }
        let needed = usize::from(self.table.raw_size().width.max(self.table.size().width));
        if needed > W { Err(RemapError::Width { needed }) } else { Ok(()) }
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

    /// Whether the next rectified line waits for a raw line. Take all that do not before the next raw line is
    /// accepted: what they need would be overwritten.
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
        let (raw, piece) = (self.table.raw_size(), self.table.piece());
        let band = Band::new(&self.lines, first - first % Self::ROWS, raw, piece);
        let cell = 1 << self.table.shift();
        let mut segments = Segments::new(&self.table, row, self.table.is_whole(row));
        valid.fill(1);
        for ((out, valid), segment) in out.chunks_mut(cell).zip(valid.chunks_mut(cell)).zip(&mut segments) {
            match segment.part {
                Part::All => band.segment::<false>(&segment, Cell::from_mut(out).as_slice_of_cells(), valid),
                Part::Some => {
                    segment.mask(raw, piece, valid);
                    band.segment::<true>(&segment, Cell::from_mut(out).as_slice_of_cells(), valid);
                }
                Part::None => {
                    valid.fill(0);
                    out.fill(0);
                }
            }
        }
        self.next += 1;
        self.needs = if self.next < self.table.size().height { self.table.raw_rows(self.next) } else { None };
        Ok(row)
    }
}
