//! Two cameras before a wall (disparity 4 px) with a box in front of it (16 px): as an interrupt's lines, and
//! as a source that is never late.

use core::convert::Infallible;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineNotifier, LineProducer, LineStart, PixelFormat,
    StereoSource,
};

/// Columns of a picture.
pub const WIDTH: usize = 160;
/// Rows of a picture.
pub const HEIGHT: u16 = 120;
/// A line of both cameras.
pub const LINE: usize = 2 * WIDTH;
/// Lines' times between two frames, as in a sensor's vertical blanking.
const BLANKING: u16 = 16;

/// What both cameras see in a row.
fn see(row: u16, left: &mut [u8], right: &mut [u8]) {
    let grey = |u: usize| ((u as u32 * 64 + u32::from(row)).wrapping_mul(0x9e37_79b1) >> 24) as u8;
    let on_box = |u: usize| (40..80).contains(&row) && (60..100).contains(&u);
    for (u, (l, r)) in left.iter_mut().zip(right).enumerate() {
        (*l, *r) = (grey(u), grey(u + if on_box(u + 16) { 16 } else { 4 }));
    }
}

/// The cameras as an interrupt sees them.
pub struct Sensor {
    producer: LineProducer<'static, 'static, LINE>,
    notifier: LineNotifier<'static>,
    frame: FrameStart,
    row: u16,
}

impl Sensor {
    /// Cameras at the start of their first frame.
    pub fn new(producer: LineProducer<'static, 'static, LINE>, notifier: LineNotifier<'static>) -> Self {
        let frame = FrameStart { sequence: 1, timestamp_us: 10_000, exposure_us: 0 };
        Self { producer, notifier, frame, row: 0 }
    }

    /// A line's time has passed.
    pub fn tick(&mut self) {
        let row = self.row;
        if row < HEIGHT
            && let Some(mut line) = self.producer.begin()
        {
            let (left, right) = line.bytes().split_at_mut(WIDTH);
            see(row, left, right);
            let timestamp_us = self.frame.timestamp_us + u64::from(row);
            self.producer.finish(line, self.frame, LineStart { row, timestamp_us });
            self.notifier.notify();
        }
        self.row += 1;
        if self.row >= HEIGHT + BLANKING {
            self.row = 0;
            self.frame.sequence = self.frame.sequence.wrapping_add(1);
            self.frame.timestamp_us += 10_000;
        }
    }
}

/// The cameras as a source that always has the next line.
#[derive(Default)]
pub struct Waiting {
    row: u16,
}

impl ErrorType for Waiting {
    type Error = Infallible;
}

impl StereoSource for Waiting {
    fn format(&self) -> LineFormat {
        LineFormat { width: WIDTH as u16, height: HEIGHT, pixel: PixelFormat::Grey8 }
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
        see(row, left, right);
        self.row += 1;
        Ok(LineStart { row, timestamp_us: u64::from(row) })
    }
}
