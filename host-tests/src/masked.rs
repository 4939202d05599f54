//! A pair whose cameras do not see all of their pictures: masks beside any source.

use image::GrayImage;
use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};

/// A source with a mask for each camera, 0 where it does not see.
#[derive(Debug)]
pub struct MaskedPair<S> {
    source: S,
    valid: [GrayImage; 2],
}

impl<S: StereoSource> MaskedPair<S> {
    /// A source whose pictures have the size of both masks; what a mask lacks is not seen.
    pub fn new(source: S, valid: [GrayImage; 2]) -> Self {
        Self { source, valid }
    }
}

impl<S: ErrorType> ErrorType for MaskedPair<S> {
    type Error = S::Error;
}

impl<S: StereoSource> StereoSource for MaskedPair<S> {
    fn format(&self) -> LineFormat {
        self.source.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.source.max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<S::Error>> {
        self.source.start_frame()
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        self.source.next_lines(left, right)
    }

    fn mask(&self, row: u16, masks: [&mut [u8]; 2]) -> bool {
        for (valid, mask) in self.valid.iter().zip(masks) {
            let pixels = valid.chunks_exact(valid.width() as usize).nth(row.into()).unwrap_or_default();
            mask.fill(0);
            for (mask, &pixel) in mask.iter_mut().zip(pixels) {
                *mask = u8::from(pixel != 0);
            }
        }
        true
    }
}
