//! A pair of pictures as a stereo source.

use core::convert::Infallible;
use image::GrayImage;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource,
};

/// Two pictures of one size, handed out row by row as 8-bit grey, frame after frame.
///
/// The sequence number counts the frames from 0. The clock is simulated: 30 frames per second, the lines
/// evenly spread.
#[derive(Clone, Debug)]
pub struct SceneCamera {
    left: GrayImage,
    right: GrayImage,
    /// Frames that were started.
    frames: u32,
    /// The row that the next line has; `height` when none is left.
    row: u32,
}

/// Time from a frame to the next, us.
const FRAME_US: u64 = 33_333;

impl SceneCamera {
    /// A camera that sees these pictures.
    ///
    /// # Panics
    ///
    /// When the pictures differ in size or a side is over 65535 px.
    pub fn new(left: GrayImage, right: GrayImage) -> Self {
        assert_eq!(left.dimensions(), right.dimensions(), "the pictures of a pair have one size");
        assert!(left.width() <= 65_535 && left.height() <= 65_535, "a side is over 65535 px");
        let row = left.height();
        Self { left, right, frames: 0, row }
    }

    /// The pictures, left and right.
    pub fn pictures(&self) -> (&GrayImage, &GrayImage) {
        (&self.left, &self.right)
    }

    fn frame_us(&self) -> u64 {
        u64::from(self.frames.saturating_sub(1)) * FRAME_US
    }
}

impl ErrorType for SceneCamera {
    type Error = Infallible;
}

impl StereoSource for SceneCamera {
    fn format(&self) -> LineFormat {
        // `new` has checked that both sides fit.
        LineFormat {
            width: self.left.width() as u16,
            height: self.left.height() as u16,
            pixel: PixelFormat::Grey8,
        }
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        let sequence = self.frames;
        self.frames = self.frames.wrapping_add(1);
        self.row = 0;
        Ok(FrameStart { sequence, timestamp_us: self.frame_us(), exposure_us: 0 })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        if self.row >= self.left.height() {
            return Err(CameraError::NoLineLeft);
        }
        let width = self.left.width() as usize;
        if left.len() < width || right.len() < width {
            return Err(CameraError::BufferTooShort { needed: width });
        }
        let start = self.row as usize * width;
        left[..width].copy_from_slice(&self.left.as_raw()[start..start + width]);
        right[..width].copy_from_slice(&self.right.as_raw()[start..start + width]);
        let line_us = FRAME_US * u64::from(self.row) / u64::from(self.left.height());
        let row = self.row as u16;
        self.row += 1;
        Ok(LineStart { row, timestamp_us: self.frame_us() + line_us })
    }
}
