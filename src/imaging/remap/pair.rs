//! Rectified stereo source over two raw cameras.

use super::{Remap, RemapError};
use crate::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource};
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
}

impl<const W: usize, const N: usize, const SLOTS: usize> RemapPair<W, N, SLOTS> {
    /// Creates remaps to images without pixels; [`Self::set`] gives them their warps.
    pub const fn empty() -> Self {
        Self { left: Remap::empty(), right: Remap::empty(), valid: [[0; W]; 2] }
    }

    /// Joins the remaps of the left and the right camera.
    pub fn new(left: Remap<W, N, SLOTS>, right: Remap<W, N, SLOTS>) -> Self {
        Self { left, right, valid: [[0; W]; 2] }
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

    /// Returns the least `N` for which a [`RectifiedPair`] takes these remaps: a camera's lines are held
    /// until the other's next line is in, which may be more lines than each remap needs alone.
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
}

/// Stereo source of rectified lines over a source of raw lines.
///
/// Raw lines are read in pairs until both cameras have what their next rectified line needs.
#[derive(Debug)]
pub struct RectifiedPair<'a, S, const W: usize, const N: usize, const SLOTS: usize> {
    source: S,
    pair: &'a mut RemapPair<W, N, SLOTS>,
    last: LineStart,
}

/// Why there is no pair of rectified lines.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RectifiedPairError<E> {
    /// The raw source failed.
    Source(E),
    /// A remap refused.
    Remap(RemapError),
    /// The raw lines are not 8-bit grey, or not of the size that the tables are for.
    Raw(LineFormat),
    /// The two tables make rectified images of different sizes.
    Sizes,
}

impl<E: fmt::Display> fmt::Display for RectifiedPairError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Source(e) => e.fmt(f),
            Self::Remap(e) => e.fmt(f),
            Self::Raw(format) => write!(
                f,
                "raw frames of {}x{} px are not those of the remap, which takes 8-bit grey",
                format.width, format.height
            ),
            Self::Sizes => f.write_str("the two remaps make images of different sizes"),
        }
    }
}

impl<E: fmt::Display + fmt::Debug> core::error::Error for RectifiedPairError<E> {}

impl<E> From<RemapError> for CameraError<RectifiedPairError<E>> {
    fn from(error: RemapError) -> Self {
        match error {
            RemapError::BufferTooShort { needed } => Self::BufferTooShort { needed },
            RemapError::NoLineLeft => Self::NoLineLeft,
            other => Self::Hardware(RectifiedPairError::Remap(other)),
        }
    }
}

impl<'a, S: StereoSource, const W: usize, const N: usize, const SLOTS: usize>
    RectifiedPair<'a, S, W, N, SLOTS>
{
    /// Rectifies a source; refused where raw lines and remaps do not match, or where the bands are too small
    /// for both cameras in step, as a camera's lines are held until the other's next line is in.
    pub fn new(
        source: S,
        pair: &'a mut RemapPair<W, N, SLOTS>,
    ) -> Result<Self, RectifiedPairError<S::Error>> {
        let [left, right] = pair.remaps();
        let format = source.format();
        let raws = [left.table().raw_size(), right.table().raw_size()];
        let fits = raws.iter().all(|raw| (raw.width, raw.height) == (format.width, format.height));
        if !fits || format.pixel != PixelFormat::Grey8 {
            return Err(RectifiedPairError::Raw(format));
        }
        if left.table().size() != right.table().size() {
            return Err(RectifiedPairError::Sizes);
        }
        let needed = pair.lines_needed();
        if needed > N {
            return Err(RectifiedPairError::Remap(RemapError::Lines { needed }));
        }
        let last = LineStart { row: 0, timestamp_us: 0 };
        Ok(Self { source, pair, last })
    }

    /// Returns the masks of the last lines, left and right: 1 for a valid pixel, else 0.
    pub fn valid(&self) -> [&[u8]; 2] {
        let width = usize::from(self.pair.left.table().size().width);
        self.pair.valid.each_ref().map(|valid| valid.get(..width).unwrap_or(&[]))
    }

    /// Returns the remaps of the left and the right camera.
    pub fn remaps(&self) -> [&Remap<W, N, SLOTS>; 2] {
        self.pair.remaps()
    }

    /// Releases the source.
    pub fn release(self) -> S {
        self.source
    }
}

impl<S: StereoSource, const W: usize, const N: usize, const SLOTS: usize> ErrorType
    for RectifiedPair<'_, S, W, N, SLOTS>
{
    type Error = RectifiedPairError<S::Error>;
}

impl<S: StereoSource, const W: usize, const N: usize, const SLOTS: usize> StereoSource
    for RectifiedPair<'_, S, W, N, SLOTS>
{
    fn format(&self) -> LineFormat {
        let size = self.pair.left.table().size();
        LineFormat { width: size.width, height: size.height, ..self.source.format() }
    }

    fn max_row_skew_us(&self) -> u32 {
        self.source.max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        let start = self.source.start_frame().map_err(|e| e.map_hardware(RectifiedPairError::Source))?;
        self.pair.left.begin();
        self.pair.right.begin();
        Ok(start)
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        let RemapPair { left: first, right: second, valid: [first_valid, second_valid] } = &mut *self.pair;
        // Each iteration reads a raw line; an image has at most 4096.
        while first.wants_line() || second.wants_line() {
            let lines = self.source.next_lines(first.next_line(), second.next_line());
            self.last = lines.map_err(|e| e.map_hardware(RectifiedPairError::Source))?;
            first.accept();
            second.accept();
        }
        let row = first.row(left, first_valid)?;
        second.row(right, second_valid)?;
        Ok(LineStart { row, ..self.last })
    }

    fn mask(&self, row: u16, [left, right]: [&mut [u8]; 2]) -> bool {
        self.pair.left.table().mask(row, left);
        self.pair.right.table().mask(row, right);
        true
    }
}
