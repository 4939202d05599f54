//! Two pictures in memory as a camera.

use core::convert::Infallible;
use core::ops::Range;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource,
};

/// Two grey pictures of one size, row by row.
pub struct Pair<'a> {
    format: LineFormat,
    pictures: [&'a [u8]; 2],
    /// 1 where the pictures show something, else 0; none where all of them does.
    masks: Option<[&'a [u8]; 2]>,
    row: u16,
}

impl<'a> Pair<'a> {
    /// Pictures of so many pixels, `width` in a row.
    pub fn new(width: u16, height: u16, pictures: [&'a [u8]; 2]) -> Self {
        let format = LineFormat { width, height, pixel: PixelFormat::Grey8 };
        Self { format, pictures, masks: None, row: height }
    }

    /// The same with masks of both pictures, as a remap leaves them.
    pub fn with_masks(self, masks: [&'a [u8]; 2]) -> Self {
        Self { masks: Some(masks), ..self }
    }

    /// The pixels of a row.
    fn pixels(&self, row: u16) -> Range<usize> {
        let width = usize::from(self.format.width);
        let first = usize::from(row) * width;
        first..first + width
    }
}

impl ErrorType for Pair<'_> {
    type Error = Infallible;
}

impl StereoSource for Pair<'_> {
    fn format(&self) -> LineFormat {
        self.format
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.row = 0;
        Ok(FrameStart::default())
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        let row = self.row;
        if row >= self.format.height {
            return Err(CameraError::NoLineLeft);
        }
        let width = usize::from(self.format.width);
        let here = self.pixels(row);
        for (line, picture) in [left, right].into_iter().zip(self.pictures) {
            let too_short = CameraError::BufferTooShort { needed: width };
            let line = line.get_mut(..width).ok_or(too_short)?;
            line.copy_from_slice(picture.get(here.clone()).ok_or(CameraError::NoLineLeft)?);
        }
        self.row = row + 1;
        Ok(LineStart { row, timestamp_us: 0 })
    }

    fn mask(&self, row: u16, out: [&mut [u8]; 2]) -> bool {
        let Some(masks) = self.masks else { return false };
        let here = self.pixels(row);
        for (out, mask) in out.into_iter().zip(masks) {
            for (to, from) in out.iter_mut().zip(mask.get(here.clone()).unwrap_or_default()) {
                *to = *from;
            }
        }
        true
    }
}
