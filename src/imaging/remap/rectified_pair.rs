//! Rectified stereo source over two raw cameras.

use super::{Remap, RemapError, RemapPair, RemapPairError};
use crate::camera::{
    CameraError, ErrorType, FrameStart, LineFault, LineFormat, LineStart, PixelFormat, StereoSource,
};
use core::fmt;

/// Stereo source of rectified lines over a source of raw lines.
///
/// Raw lines are read in pairs until both cameras have what their next rectified line needs. A raw line that
/// is lost, skipped, or older than the one before is replaced by a neighbour, so that the others keep their
/// places, and the rectified rows that need it are [`CameraError::LineLost`]. One that comes again is
/// ignored.
#[derive(Debug)]
pub struct RectifiedPair<'a, S, const W: usize, const N: usize, const SLOTS: usize> {
    source: S,
    pair: &'a mut RemapPair<W, N, SLOTS>,
    /// The newest raw line.
    last: LineStart,
    /// What happened to the last raw line that was lost.
    fault: LineFault,
    /// Row of the newest raw line while it stands for skipped ones above it.
    held: Option<u16>,
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
        pair.lines_in_step().map_err(|error| match error {
            RemapPairError::Sizes => RectifiedPairError::Sizes,
            RemapPairError::Lines { needed } => RectifiedPairError::Remap(RemapError::Lines { needed }),
        })?;
        let last = LineStart { row: 0, timestamp_us: 0 };
        Ok(Self { source, pair, last, fault: LineFault::Dropped, held: None })
    }

    /// Returns the masks of the last lines, left and right: 1 for a valid pixel, else 0.
    pub fn valid(&self) -> [&[u8]; 2] {
        self.pair.valid()
    }

    /// Returns the remaps of the left and the right camera.
    pub fn remaps(&self) -> [&Remap<W, N, SLOTS>; 2] {
        self.pair.remaps()
    }

    /// Releases the source.
    pub fn release(self) -> S {
        self.source
    }

    fn raw_height(&self) -> u16 {
        self.pair.remaps()[0].table().raw_size().height
    }

    /// Takes the next raw lines of each camera, their own or others in their place; or none, where they came
    /// before.
    fn read(&mut self) -> Result<(), CameraError<RectifiedPairError<S::Error>>> {
        let due = self.pair.came();
        if let Some(row) = self.held {
            self.pair.repeat_lines();
            self.take(row, due);
            return Ok(());
        }
        let [left, right] = self.pair.next_lines();
        let line = match self.source.next_lines(left, right) {
            Ok(line) => line,
            Err(CameraError::LineLost(fault)) => {
                self.replace(fault);
                return Ok(());
            }
            Err(error) => return Err(error.map_hardware(RectifiedPairError::Source)),
        };
        if line.row < self.last.row || line.row >= self.raw_height() {
            return Err(CameraError::LostSync);
        }
        self.last.row = line.row;
        // It came before, or others stand in its place.
        if line.row < due {
            return Ok(());
        }
        if line.timestamp_us != 0 && line.timestamp_us < self.last.timestamp_us {
            self.replace(LineFault::Stale);
            return Ok(());
        }
        self.last = line;
        self.take(line.row, due);
        Ok(())
    }

    /// Accepts the lines of `row`, which stand for `due` as well where it was skipped.
    fn take(&mut self, row: u16, due: u16) {
        if row == due {
            self.held = None;
            self.pair.accept();
        } else {
            (self.held, self.fault) = (Some(row), LineFault::Dropped);
            self.pair.accept_replaced();
        }
    }

    /// Accepts the lines above in place of lost ones.
    fn replace(&mut self, fault: LineFault) {
        self.fault = fault;
        self.pair.repeat_lines();
        self.pair.accept_replaced();
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
        let size = self.pair.remaps()[0].table().size();
        LineFormat { width: size.width, height: size.height, ..self.source.format() }
    }

    fn max_row_skew_us(&self) -> u32 {
        self.source.max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        let start = self.source.start_frame().map_err(|e| e.map_hardware(RectifiedPairError::Source))?;
        self.pair.begin();
        (self.last, self.held) = (LineStart { row: 0, timestamp_us: start.timestamp_us }, None);
        Ok(start)
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        // A source may give lines again and again: a frame's worth of that is enough.
        let mut reads = 2 * u32::from(self.raw_height());
        while self.pair.wants_lines() {
            reads = reads.checked_sub(1).ok_or(CameraError::LostSync)?;
            self.read()?;
        }
        if self.pair.is_damaged() {
            self.pair.skip();
            return Err(CameraError::LineLost(self.fault));
        }
        let row = self.pair.row(left, right)?;
        Ok(LineStart { row, ..self.last })
    }

    fn mask(&self, row: u16, masks: [&mut [u8]; 2]) -> bool {
        self.pair.mask(row, masks);
        true
    }
}
