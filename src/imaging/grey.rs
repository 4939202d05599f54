//! Grey conversion: lines of any pixel format as 8-bit grey.

use crate::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineSource, LineStart, PixelFormat};

/// Line source of [`PixelFormat::Grey8`] over a source of any pixel format.
///
/// `RAW` is the capacity for one raw line, bytes. Samples of more than 8 bits lose their low bits; those of
/// fewer are widened by repeating the high bits, so that white is 255. Colour becomes luma by ITU-R BT.601,
/// `(4899 R + 9617 G + 1868 B + 2^13) / 2^14`. Pixels of a Bayer mosaic are taken as they are;
/// [`BayerLines`](super::BayerLines) converts them to grey.
#[derive(Debug)]
pub struct GreyLines<S, const RAW: usize> {
    source: S,
    raw: [u8; RAW],
}

impl<S: LineSource, const RAW: usize> GreyLines<S, RAW> {
    /// Wraps a source; refused when its lines are longer than `RAW` bytes.
    pub fn new(source: S) -> Result<Self, CameraError<S::Error>> {
        let needed = source.format().line_bytes();
        if needed > RAW {
            return Err(CameraError::BufferTooShort { needed });
        }
        Ok(Self { source, raw: [0; RAW] })
    }

    /// Releases the source.
    pub fn release(self) -> S {
        self.source
    }
}

impl<S: LineSource, const RAW: usize> ErrorType for GreyLines<S, RAW> {
    type Error = S::Error;
}

impl<S: LineSource, const RAW: usize> LineSource for GreyLines<S, RAW> {
    fn format(&self) -> LineFormat {
        LineFormat { pixel: PixelFormat::Grey8, ..self.source.format() }
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<S::Error>> {
        self.source.start_frame()
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        let format = self.source.format();
        let needed = usize::from(format.width);
        let too_short = CameraError::BufferTooShort { needed };
        let Some(line) = line.get_mut(..needed) else { return Err(too_short) };
        if format.pixel == PixelFormat::Grey8 {
            return self.source.next_line(line);
        }
        let start = self.source.next_line(&mut self.raw)?;
        to_grey(format.pixel, &self.raw, line);
        Ok(start)
    }
}

/// Converts a line of raw pixels to grey, as many as both have.
pub(super) fn to_grey(pixel: PixelFormat, raw: &[u8], out: &mut [u8]) {
    match pixel {
        PixelFormat::Grey8 | PixelFormat::Bayer8 => out.iter_mut().zip(raw).for_each(|(o, &r)| *o = r),
        PixelFormat::Grey16 { bits } | PixelFormat::Bayer16 { bits } => {
            let shift = shift(bits);
            groups(raw, out, |raw| [top(raw, shift)]);
        }
        // The bytes of high bits are the grey.
        PixelFormat::Grey10Packed => groups(raw, out, |[a, b, c, d, _]| [a, b, c, d]),
        PixelFormat::Grey12Packed => groups(raw, out, |[a, b, _]| [a, b]),
        PixelFormat::Yuyv => groups(raw, out, |[y0, _, y1, _]| [y0, y1]),
        PixelFormat::Uyvy => groups(raw, out, |[_, y0, _, y1]| [y0, y1]),
        PixelFormat::Rgb565 { high_byte_first: true } => {
            groups(raw, out, |raw| [luma(rgb565(u16::from_be_bytes(raw)))])
        }
        PixelFormat::Rgb565 { high_byte_first: false } => {
            groups(raw, out, |raw| [luma(rgb565(u16::from_le_bytes(raw)))])
        }
        PixelFormat::Rgb8 => groups(raw, out, |rgb| [luma(rgb)]),
        PixelFormat::Rgb16 { bits } => {
            let shift = shift(bits);
            groups(raw, out, |[r0, r1, g0, g1, b0, b1]| {
                [luma([top([r0, r1], shift), top([g0, g1], shift), top([b0, b1], shift)])]
            });
        }
    }
}

/// Converts groups of `B` raw bytes to `P` pixels each, as many as fit.
fn groups<const B: usize, const P: usize>(raw: &[u8], out: &mut [u8], grey: impl Fn([u8; B]) -> [u8; P]) {
    for (out, &raw) in out.chunks_mut(P).zip(raw.as_chunks().0) {
        out.iter_mut().zip(grey(raw)).for_each(|(o, g)| *o = g);
    }
}

/// Widens red, green and blue of 5, 6 and 5 bits to bytes.
fn rgb565(pixel: u16) -> [u8; 3] {
    let (r, g, b) = (pixel >> 11, pixel >> 5 & 0x3f, pixel & 0x1f);
    [(r << 3 | r >> 2) as u8, (g << 2 | g >> 4) as u8, (b << 3 | b >> 2) as u8]
}

fn shift(bits: u8) -> u32 {
    u32::from(bits.clamp(8, 16)) - 8
}

/// Top eight of the significant bits; a sample with more bits saturates.
fn top(sample: [u8; 2], shift: u32) -> u8 {
    (u16::from_le_bytes(sample) >> shift).min(255) as u8
}

fn luma([r, g, b]: [u8; 3]) -> u8 {
    ((4899 * u32::from(r) + 9617 * u32::from(g) + 1868 * u32::from(b) + (1 << 13)) >> 14) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_and_green_is_brightest() {
        assert_eq!(luma([255, 255, 255]), 255);
        assert_eq!(luma([255, 0, 0]), 76);
        assert_eq!(luma([0, 255, 0]), 150);
        assert_eq!(luma([0, 0, 255]), 29);
    }

    #[test]
    fn ten_bits_lose_two() {
        let mut out = [0; 2];
        to_grey(PixelFormat::Grey16 { bits: 10 }, &[0xff, 0x03, 0x04, 0x00], &mut out);
        assert_eq!(out, [255, 1]);
    }
}
