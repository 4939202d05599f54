//! A camera that reads image files: what the hardware is on a board, a file is on the desktop.
//!
//! In: PNG, JPEG, PGM/PPM, TIFF, BMP or WebP, told apart by content, with 8 or 16 bits a sample, grey or
//! colour, up to 4096 x 4096. Out: lines in the file's own pixel format, frame after frame without an end.
//!
//! * Alpha is dropped: a camera has none. The samples stay as they are, they are not multiplied by it.
//! * A file with 16 bits a sample may hold the 10 or 12 bits of a sensor. The camera's significant bits are
//!   those of the largest sample, 8 at least; a pair opened by [`MockCamera::open_pair`] shares the larger of
//!   both, and the frames of a stack or a sequence share the largest of all: [`significant_bits`].
//! * A picture is turned as its metadata (EXIF) asks for: lines come as a viewer shows them.

mod decode;
mod error;
mod integrity;

pub use error::MockError;

use crate::limits::IMAGE_SIDE;
use decode::Picture;
use image::{DynamicImage, GrayImage, Luma, Rgb, RgbImage};
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineSource, LineStart, PixelFormat,
};

/// A camera that plays one image file as an endless video.
///
/// Every frame is the same picture; the sequence number counts them, from 0. The camera's clock stands at 0:
/// two cameras on files have no row skew.
#[derive(Clone, Debug)]
pub struct MockCamera {
    format: LineFormat,
    bytes: Vec<u8>,
    had_alpha: bool,
    frames: u32,
    // The next row to hand out; the height when none is left.
    row: u16,
}

impl MockCamera {
    /// A camera on the image file at `path`.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, MockError> {
        Ok(Self::play(decode::read(path.as_ref())?))
    }

    /// Two cameras on the files of a pair: of one size, and with one number of significant bits, so that
    /// equal brightness stays equal.
    pub fn open_pair(left: impl AsRef<Path>, right: impl AsRef<Path>) -> Result<(Self, Self), MockError> {
        let (mut l, mut r) = (Self::open(&left)?, Self::open(&right)?);
        let (left_size, right_size) = ((l.format.width, l.format.height), (r.format.width, r.format.height));
        if left_size != right_size {
            let (left, right) = (left.as_ref().into(), right.as_ref().into());
            return Err(MockError::Sizes { left, left_size, right, right_size });
        }
        let (of_left, of_right) = (bits(l.format.pixel), bits(r.format.pixel));
        (l, r) = (l.with_bits(of_right), r.with_bits(of_left));
        Ok((l, r))
    }

    /// The camera with so many significant bits of 16, if it has fewer: those of the images beside it.
    #[must_use]
    pub fn with_bits(mut self, of_others: Option<u8>) -> Self {
        if let (Some(own), Some(others)) = (bits(self.format.pixel), of_others) {
            self.format.pixel = with_bits(self.format.pixel, own.max(others.min(16)));
        }
        self
    }

    /// A camera on an image in memory; `None` when its samples are floating-point or a side is 0 or over
    /// [`IMAGE_SIDE`].
    pub fn from_image(image: DynamicImage) -> Option<Self> {
        let sides = 1..=u32::from(IMAGE_SIDE);
        if !sides.contains(&image.width()) || !sides.contains(&image.height()) {
            return None;
        }
        decode::lines(image).map(Self::play)
    }

    /// Two cameras on the left and the right half of the picture; `None` when its columns are odd.
    pub fn halves(&self) -> Option<(Self, Self)> {
        let Self { format, had_alpha, .. } = *self;
        let half = LineFormat { width: format.width / 2, ..format };
        let line = format.line_bytes();
        let of = |skip: usize| {
            let lines = self.bytes.chunks_exact(line.max(1));
            let bytes = lines.flat_map(|line| &line[skip..skip + half.line_bytes()]).copied().collect();
            Self::play(Picture { format: half, bytes, had_alpha })
        };
        (format.width >= 2 && format.width.is_multiple_of(2)).then(|| (of(0), of(line / 2)))
    }

    fn play(picture: Picture) -> Self {
        let Picture { format, bytes, had_alpha } = picture;
        Self { format, bytes, had_alpha, frames: 0, row: format.height }
    }

    /// Whether the file had an alpha channel, which was dropped.
    pub fn had_alpha(&self) -> bool {
        self.had_alpha
    }

    /// The picture in grey with 8 bits, colours as luma: 16-bit samples lose their low significant bits.
    pub fn grey_picture(&self) -> GrayImage {
        let (width, height) = (u32::from(self.format.width), u32::from(self.format.height));
        let grey = (self.format.pixel == PixelFormat::Grey8).then(|| self.bytes.clone());
        let image = grey.and_then(|bytes| GrayImage::from_raw(width, height, bytes));
        image.unwrap_or_else(|| luma(&self.picture()))
    }

    /// The picture with 8 bits a channel, for display: 16-bit samples lose their low significant bits.
    pub fn picture(&self) -> RgbImage {
        let size = self.format.pixel.bytes_per_pixel();
        let deep = |at: &[u8], bits: u8| (u16::from_le_bytes([at[0], at[1]]) >> (bits - 8)).min(255) as u8;
        RgbImage::from_fn(u32::from(self.format.width), u32::from(self.format.height), |x, y| {
            let first = (y as usize * usize::from(self.format.width) + x as usize) * size;
            let at = &self.bytes[first..first + size];
            match self.format.pixel {
                PixelFormat::Grey16 { bits } => Rgb([deep(at, bits); 3]),
                PixelFormat::Rgb8 => Rgb([at[0], at[1], at[2]]),
                PixelFormat::Rgb16 { bits } => {
                    Rgb([deep(at, bits), deep(&at[2..], bits), deep(&at[4..], bits)])
                }
                _ => Rgb([at[0]; 3]),
            }
        })
    }
}

/// A picture in grey, as [`GreyLines`](stereopsis::imaging::GreyLines) makes lines of colours grey.
pub fn luma(picture: &RgbImage) -> GrayImage {
    let of = |Rgb([r, g, b]): &Rgb<u8>| {
        let [r, g, b] = [r, g, b].map(|&sample| u32::from(sample));
        Luma([((4899 * r + 9617 * g + 1868 * b + (1 << 13)) >> 14) as u8])
    };
    GrayImage::from_fn(picture.width(), picture.height(), |x, y| of(picture.get_pixel(x, y)))
}

/// The significant bits of the images that have 16 bits a sample: those of the largest sample of all; `None`
/// where there is no such image. Of other images the header is read alone, and those that cannot be read are
/// passed over.
pub fn significant_bits<'a>(files: impl IntoIterator<Item = &'a PathBuf>) -> Option<u8> {
    let deep = files.into_iter().filter(|path| decode::is_deep(path));
    deep.filter_map(|path| bits(MockCamera::open(path).ok()?.format.pixel)).max()
}

/// The significant bits of a 16-bit format.
fn bits(pixel: PixelFormat) -> Option<u8> {
    match pixel {
        PixelFormat::Grey16 { bits } | PixelFormat::Rgb16 { bits } => Some(bits),
        _ => None,
    }
}

fn with_bits(pixel: PixelFormat, bits: u8) -> PixelFormat {
    match pixel {
        PixelFormat::Grey16 { .. } => PixelFormat::Grey16 { bits },
        PixelFormat::Rgb16 { .. } => PixelFormat::Rgb16 { bits },
        other => other,
    }
}

impl ErrorType for MockCamera {
    type Error = Infallible;
}

impl LineSource for MockCamera {
    fn format(&self) -> LineFormat {
        self.format
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        let sequence = self.frames;
        self.frames = self.frames.wrapping_add(1);
        self.row = 0;
        Ok(FrameStart { sequence, ..FrameStart::default() })
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<Infallible>> {
        let needed = self.format.line_bytes();
        if self.row >= self.format.height {
            return Err(CameraError::NoLineLeft);
        }
        let Some(target) = line.get_mut(..needed) else { return Err(CameraError::BufferTooShort { needed }) };
        let row = self.row;
        target.copy_from_slice(&self.bytes[usize::from(row) * needed..][..needed]);
        self.row += 1;
        Ok(LineStart { row, timestamp_us: 0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stereopsis::imaging::GreyLines;

    #[test]
    fn a_picture_is_as_grey_as_its_lines() {
        let picture = RgbImage::from_fn(256, 7, |x, y| {
            let [r, g, b] = [37 * x + 11 * y, 59 * x + 83 * y, x ^ (y * 40)].map(|sample| sample as u8);
            Rgb([r, g, b])
        });
        let camera = MockCamera::from_image(picture.clone().into()).expect("a camera");
        let mut lines = GreyLines::<_, 768>::new(camera).expect("room for a line");
        lines.start_frame().expect("a frame");
        for row in luma(&picture).chunks_exact(256) {
            let mut line = [0; 256];
            lines.next_line(&mut line).expect("a line");
            assert_eq!(row, line);
        }
    }
}
