//! What the camera sees, and what was done to each of its frames.

use super::{HEIGHT, WIDTH};
use crate::steps::{Failure, Outcome};
use std::convert::Infallible;
use std::sync::mpsc::Sender;
use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};
use stereopsis_host::fault::{Fault, Faulty, FaultyError, Record};
use stereopsis_host::run::MemoryPair;
use stereopsis_host::scene::pattern::Pattern;

/// Two pairs by turns, so that a line of the frame before is another line.
pub struct ByTurns {
    pairs: [MemoryPair; 2],
    frames: u32,
}

impl ByTurns {
    /// No frame has begun.
    pub fn new() -> Outcome<Self> {
        let pair = |seed| {
            let pattern = Pattern::Shifted { most: 20, noise_grey: 3.0 };
            let (left, right) = pattern.pair(WIDTH.into(), HEIGHT.into(), seed);
            let pair = MemoryPair::new(WIDTH, left.into_raw(), right.into_raw());
            pair.ok_or_else(|| Failure::new("the pictures are empty"))
        };
        Ok(Self { pairs: [pair(1)?, pair(2)?], frames: 0 })
    }

    /// Which of the two pairs the frame shows that began last.
    pub fn turn(&self) -> usize {
        self.frames as usize % 2
    }

    fn pair(&mut self) -> &mut MemoryPair {
        let turn = self.turn();
        &mut self.pairs[turn]
    }
}

impl ErrorType for ByTurns {
    type Error = Infallible;
}

impl StereoSource for ByTurns {
    fn format(&self) -> LineFormat {
        self.pairs[0].format()
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.frames += 1;
        let sequence = self.frames;
        self.pair().start_frame()?;
        Ok(FrameStart { sequence, timestamp_us: u64::from(sequence) * 1000, exposure_us: 10 })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        let frame_us = u64::from(self.frames) * 1000;
        let line = self.pair().next_lines(left, right)?;
        Ok(LineStart { row: line.row, timestamp_us: frame_us + u64::from(line.row) })
    }
}

/// Which pair a frame showed, and what was done to it.
pub type Done = (usize, Record);

/// A camera with every fault that reports what was done to a frame as soon as the next one begins.
pub struct Reporting {
    inner: Faulty<ByTurns>,
    to: Sender<Done>,
    has_begun: bool,
}

impl Reporting {
    /// A camera of which each line and each frame has a fault with the probability `rate`.
    pub fn new(rate: f64, seed: u64, to: Sender<Done>) -> Outcome<Self> {
        Ok(Self { inner: Faulty::new(ByTurns::new()?, &Fault::ALL, rate, seed), to, has_begun: false })
    }

    /// Reports the frame that began last.
    pub fn report(&mut self) {
        if std::mem::replace(&mut self.has_begun, true) {
            // Nobody listens any more when a row was wrong.
            let _ = self.to.send((self.inner.inner().turn(), self.inner.record().clone()));
        }
    }
}

impl ErrorType for Reporting {
    type Error = FaultyError<Infallible>;
}

impl StereoSource for Reporting {
    fn format(&self) -> LineFormat {
        self.inner.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.report();
        self.inner.start_frame()
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        self.inner.next_lines(left, right)
    }
}
