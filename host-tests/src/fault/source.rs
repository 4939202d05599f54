//! What stands before a camera or a pair is one.

use super::{Faulty, FaultyError};
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineSource, LineStart, StereoSource,
};

impl<S: ErrorType> ErrorType for Faulty<S> {
    type Error = FaultyError<S::Error>;
}

impl<S: LineSource> LineSource for Faulty<S> {
    fn format(&self) -> LineFormat {
        self.inner.format()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.start(|inner| inner.start_frame())
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<Self::Error>> {
        let format = self.format();
        self.next(format.height, format.line_bytes(), &mut [line], |inner, lines| match lines {
            [line] => inner.next_line(line),
            _ => Err(CameraError::NoLineLeft),
        })
    }
}

impl<S: StereoSource> StereoSource for Faulty<S> {
    fn format(&self) -> LineFormat {
        self.inner.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.inner.max_row_skew_us()
    }

    fn mask(&self, row: u16, masks: [&mut [u8]; 2]) -> bool {
        self.inner.mask(row, masks)
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.start(|inner| inner.start_frame())
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        let format = self.inner.format();
        self.next(format.height, format.line_bytes(), &mut [left, right], |inner, lines| match lines {
            [left, right] => inner.next_lines(left, right),
            _ => Err(CameraError::NoLineLeft),
        })
    }
}
