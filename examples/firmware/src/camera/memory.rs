//! A picture in memory as a pair of cameras, at once: what lines cost without an interrupt.

use core::convert::Infallible;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource,
};

/// What two cameras see, line by line, the left one's half first.
pub struct Picture<const LINE: usize, const HEIGHT: usize>(pub [[u8; LINE]; HEIGHT]);

/// The picture as a camera.
pub struct Direct<'a, const LINE: usize, const HEIGHT: usize> {
    picture: &'a Picture<LINE, HEIGHT>,
    row: usize,
    sequence: u32,
}

impl<'a, const LINE: usize, const HEIGHT: usize> Direct<'a, LINE, HEIGHT> {
    /// A camera that has not begun a frame yet.
    pub const fn new(picture: &'a Picture<LINE, HEIGHT>) -> Self {
        Self { picture, row: HEIGHT, sequence: 0 }
    }
}

impl<const LINE: usize, const HEIGHT: usize> ErrorType for Direct<'_, LINE, HEIGHT> {
    type Error = Infallible;
}

impl<const LINE: usize, const HEIGHT: usize> StereoSource for Direct<'_, LINE, HEIGHT> {
    fn format(&self) -> LineFormat {
        LineFormat { width: (LINE / 2) as u16, height: HEIGHT as u16, pixel: PixelFormat::Grey8 }
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        (self.row, self.sequence) = (0, self.sequence.wrapping_add(1));
        Ok(FrameStart { sequence: self.sequence, ..FrameStart::default() })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        let line = self.picture.0.get(self.row).ok_or(CameraError::NoLineLeft)?;
        let (l, r) = line.split_at_checked(LINE / 2).ok_or(CameraError::NoLineLeft)?;
        left.iter_mut().zip(l).for_each(|(to, &from)| *to = from);
        right.iter_mut().zip(r).for_each(|(to, &from)| *to = from);
        self.row += 1;
        Ok(LineStart { row: (self.row - 1) as u16, timestamp_us: 0 })
    }
}
