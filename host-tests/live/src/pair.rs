//! Two pictures in memory as a camera.

use core::convert::Infallible;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource,
};

/// Two grey pictures of one size, row by row.
pub struct Pair<'a> {
    format: LineFormat,
    pictures: [&'a [u8]; 2],
    row: u16,
}

impl<'a> Pair<'a> {
    /// Pictures of so many pixels, `width` in a row.
    pub fn new(width: u16, height: u16, pictures: [&'a [u8]; 2]) -> Self {
        Self { format: LineFormat { width, height, pixel: PixelFormat::Grey8 }, pictures, row: height }
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
        let first = usize::from(row) * width;
        for (line, picture) in [left, right].into_iter().zip(self.pictures) {
            let too_short = CameraError::BufferTooShort { needed: width };
            let line = line.get_mut(..width).ok_or(too_short)?;
            line.copy_from_slice(picture.get(first..first + width).ok_or(CameraError::NoLineLeft)?);
        }
        self.row = row + 1;
        Ok(LineStart { row, timestamp_us: 0 })
    }
}
