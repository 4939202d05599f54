//! A camera whose own time is measured, so that it can be taken off a frame's.

use crate::clock::Clock;
use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};

/// A camera, and the ticks that it took to give its lines.
pub struct Timed<'a, C> {
    camera: C,
    clock: &'a Clock,
    ticks: u64,
}

impl<'a, C> Timed<'a, C> {
    /// A camera that has taken no time yet.
    pub const fn new(camera: C, clock: &'a Clock) -> Self {
        Self { camera, clock, ticks: 0 }
    }

    /// The ticks of all its calls so far.
    pub const fn ticks(&self) -> u64 {
        self.ticks
    }
}

impl<C: ErrorType> ErrorType for Timed<'_, C> {
    type Error = C::Error;
}

impl<C: StereoSource> StereoSource for Timed<'_, C> {
    fn format(&self) -> LineFormat {
        self.camera.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.camera.max_row_skew_us()
    }

    // Not inlined, so that the camera's code is not counted as the pipeline's.
    #[inline(never)]
    fn start_frame(&mut self) -> Result<FrameStart, CameraError<C::Error>> {
        let start = self.clock.now();
        let frame = self.camera.start_frame();
        self.ticks += self.clock.now() - start;
        frame
    }

    #[inline(never)]
    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<C::Error>> {
        let start = self.clock.now();
        let line = self.camera.next_lines(left, right);
        self.ticks += self.clock.now() - start;
        line
    }

    fn mask(&self, row: u16, masks: [&mut [u8]; 2]) -> bool {
        self.camera.mask(row, masks)
    }
}
