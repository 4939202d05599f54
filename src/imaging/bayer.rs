//! Grey lines of a Bayer mosaic, by the mean of 2x2 pixels.

use super::grey::to_grey;
use crate::camera::{
    CameraError, ErrorType, FrameStart, LineFault, LineFormat, LineSource, LineStart, PixelFormat,
};

/// Grey lines of [`PixelFormat::Grey8`] over a source of [`PixelFormat::Bayer8`] or [`PixelFormat::Bayer16`].
///
/// A grey pixel is the mean of 2x2 raw ones:
/// `g(x, y) = (p(x, y) + p(x + 1, y) + p(x, y + 1) + p(x + 1, y + 1) + 2) / 4`. In every Bayer pattern these
/// are one red, two green and one blue, `(R + 2 G + B) / 4`, half a pixel to the right and below. Both
/// cameras shift alike, which leaves disparities unchanged. The last column and the last row repeat the means
/// before them; an image of one row is its own row below.
///
/// A row needs the line below, so that the source is one line ahead; where that line is lost, so is the row,
/// and the last row where the line above it is.
/// The capacities are `W` pixels and `RAW` bytes.
#[derive(Debug)]
pub struct BayerLines<S, const W: usize, const RAW: usize> {
    source: S,
    raw: [u8; RAW],
    /// The line ahead and the one above it, 8 bits per pixel.
    ahead: [u8; W],
    above: [u8; W],
    /// Row and time of the line ahead, where it is the next one to be given.
    start: Option<LineStart>,
    /// Row of the line ahead; `None` before a frame's first line.
    row: Option<u16>,
    /// Whether the line above is of the row above the line ahead.
    is_adjacent: bool,
}

impl<S: LineSource, const W: usize, const RAW: usize> BayerLines<S, W, RAW> {
    /// Wraps a source; refused when its lines have more than `RAW` bytes, or more than `W` pixels.
    pub fn new(source: S) -> Result<Self, CameraError<S::Error>> {
        let format = source.format();
        for (needed, capacity) in [(format.line_bytes(), RAW), (usize::from(format.width), W)] {
            if needed > capacity {
                return Err(CameraError::BufferTooShort { needed });
            }
        }
        let (start, row, is_adjacent) = (None, None, false);
        Ok(Self { source, raw: [0; RAW], ahead: [0; W], above: [0; W], start, row, is_adjacent })
    }

    /// Releases the source.
    pub fn release(self) -> S {
        self.source
    }

    /// Reads the next line of the source; the line that was ahead becomes the one above. Without a line,
    /// nothing changes.
    fn fetch(&mut self, format: &LineFormat) -> Result<LineStart, CameraError<S::Error>> {
        let start = self.source.next_line(&mut self.raw)?;
        core::mem::swap(&mut self.ahead, &mut self.above);
        to_grey(format.pixel, &self.raw, self.ahead.get_mut(..usize::from(format.width)).unwrap_or_default());
        self.is_adjacent = self.row.is_some_and(|above| above.saturating_add(1) == start.row);
        self.row = Some(start.row);
        Ok(start)
    }
}

impl<S: LineSource, const W: usize, const RAW: usize> ErrorType for BayerLines<S, W, RAW> {
    type Error = S::Error;
}

impl<S: LineSource, const W: usize, const RAW: usize> LineSource for BayerLines<S, W, RAW> {
    fn format(&self) -> LineFormat {
        LineFormat { pixel: PixelFormat::Grey8, ..self.source.format() }
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<S::Error>> {
        (self.start, self.row) = (None, None);
        self.source.start_frame()
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        let format = self.source.format();
        let needed = usize::from(format.width);
        let Some(line) = line.get_mut(..needed) else { return Err(CameraError::BufferTooShort { needed }) };
        let own = match self.start.take() {
            Some(own) => own,
            None => self.fetch(&format)?,
        };
        if own.row.saturating_add(1) < format.height {
            match self.fetch(&format) {
                Ok(below) => self.start = Some(below),
                Err(error) => {
                    // What fails is the line below, and with it this row: the caller's next call is for the
                    // row below. A line that is not there yet has not failed.
                    self.start = matches!(error, CameraError::WouldBlock).then_some(own);
                    return Err(error);
                }
            }
        }
        // The frame's last row has none below: `above` and `ahead` are still those of the row before it.
        let above = if format.height == 1 { &self.ahead } else { &self.above };
        if format.height > 1 && !self.is_adjacent {
            return Err(CameraError::LineLost(LineFault::Dropped));
        }
        mean_of_four(above, &self.ahead, line);
        Ok(own)
    }
}

/// Means of 2x2 pixels of two lines.
fn mean_of_four(above: &[u8], below: &[u8], out: &mut [u8]) {
    let last = out.len().saturating_sub(1);
    let first = last.saturating_sub(1);
    let at = |line: &[u8], x: usize| u16::from(line.get(x).copied().unwrap_or(0));
    for (x, out) in out.iter_mut().enumerate() {
        let x = x.min(first);
        let right = (x + 1).min(last);
        let sum = at(above, x) + at(above, right) + at(below, x) + at(below, right);
        *out = ((sum + 2) >> 2) as u8;
    }
}
