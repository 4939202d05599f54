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
/// before them.
///
/// A row needs the line below, so that the source is one line ahead; where that line is lost, so is the row.
/// The capacities are `W` pixels and `RAW` bytes.
#[derive(Debug)]
pub struct BayerLines<S, const W: usize, const RAW: usize> {
    source: S,
    raw: [u8; RAW],
    /// The line ahead and the one above it, 8 bits per pixel.
    ahead: [u8; W],
    above: [u8; W],
    /// Row and time of the line ahead; `None` before the first and after the last line of a frame.
    start: Option<LineStart>,
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
        Ok(Self { source, raw: [0; RAW], ahead: [0; W], above: [0; W], start: None })
    }

    /// Releases the source.
    pub fn release(self) -> S {
        self.source
    }

    /// Reads the next line of the source; the line that was ahead becomes the one above.
    fn fetch(&mut self, format: &LineFormat) -> Result<LineStart, CameraError<S::Error>> {
        core::mem::swap(&mut self.ahead, &mut self.above);
        let start = self.source.next_line(&mut self.raw)?;
        to_grey(format.pixel, &self.raw, self.ahead.get_mut(..usize::from(format.width)).unwrap_or_default());
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
        self.start = None;
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
            // What fails is the line below, and with it this row: the caller's next call is for the row
            // below.
            let below = self.fetch(&format)?;
            self.start = Some(below);
            if below.row != own.row.saturating_add(1) {
                return Err(CameraError::LineLost(LineFault::Dropped));
            }
        }
        // The frame's last row has none below: `above` and `ahead` are still those of the row before it.
        mean_of_four(&self.above, &self.ahead, line);
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
