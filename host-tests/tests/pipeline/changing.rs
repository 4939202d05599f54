//! A camera of two pictures by turns, and what comes of them without a fault.

use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};
use stereopsis::matching::{Checks, Config, Method, Row};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::scene::SceneCamera;
use stereopsis_host::scene::pattern::Pattern;

pub const WIDTH: u16 = 24;
pub const HEIGHT: u16 = 30;

/// A row that was kept.
#[derive(Clone, PartialEq, Debug)]
pub struct Kept {
    pub disparities: Vec<Disparity>,
    pub flags: Vec<PixelFlags>,
    pub confidences: Vec<u8>,
    pub sigma_px: Vec<Option<u32>>,
}

impl From<Row<'_>> for Kept {
    fn from(row: Row<'_>) -> Self {
        Self {
            disparities: row.disparities().to_vec(),
            flags: row.flags().to_vec(),
            confidences: row.confidences().to_vec(),
            sigma_px: (0..row.disparities().len()).map(|x| row.sigma_px(x).map(f32::to_bits)).collect(),
        }
    }
}

/// Frames of each fault and rate.
pub fn frames(share: usize) -> usize {
    match std::env::var("STEREOPSIS_FAULT_FRAMES") {
        Ok(frames) => frames.parse().expect("STEREOPSIS_FAULT_FRAMES is a number of frames"),
        Err(_) => share,
    }
}

/// Two pictures by turns: a line of the frame before is another line.
pub struct Changing {
    pictures: [SceneCamera; 2],
    pub frames: u32,
}

impl Changing {
    pub fn new() -> Self {
        let camera = |seed| {
            let (left, right) =
                Pattern::Shifted { most: 8, noise_grey: 3.0 }.pair(WIDTH.into(), HEIGHT.into(), seed);
            SceneCamera::new(left, right)
        };
        Self { pictures: [camera(1), camera(2)], frames: 0 }
    }

    fn picture(&mut self) -> &mut SceneCamera {
        // The number of the frame that was started last.
        &mut self.pictures[self.frames as usize % 2]
    }
}

impl ErrorType for Changing {
    type Error = core::convert::Infallible;
}

impl StereoSource for Changing {
    fn format(&self) -> LineFormat {
        self.pictures[0].format()
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.frames += 1;
        let sequence = self.frames;
        self.picture().start_frame()?;
        Ok(FrameStart { sequence, timestamp_us: u64::from(sequence) * 1000, exposure_us: 10 })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        let frame_us = u64::from(self.frames) * 1000;
        let line = self.picture().next_lines(left, right)?;
        Ok(LineStart { row: line.row, timestamp_us: frame_us + u64::from(line.row) })
    }
}

pub fn config<S: Method>() -> Config {
    // Little speckle is asked for: the flag's reach down is that many rows.
    let config = Config::for_method::<S>(WIDTH, HEIGHT, 16);
    let checks = Checks { speckle_pixels: 4, ..config.checks };
    Config { checks, confidence: true, ..config }
}

/// The rows of both pictures without a fault: of odd frames, of even frames.
pub fn reference<S: Method>() -> [Vec<Kept>; 2] {
    let both = reference_of::<S>(&config::<S>());
    let [_, odd] = &both;
    assert!(odd.iter().flat_map(|row| &row.disparities).filter(|d| d.is_some()).count() > 200);
    both
}

/// The same by another configuration.
pub fn reference_of<S: Method>(config: &Config) -> [Vec<Kept>; 2] {
    let mut source = Changing::new();
    let mut pipeline = Box::new(Pipeline::<S, 32, 16>::new());
    pipeline.start(config).expect("the configuration fits");
    let mut frame = || {
        pipeline.begin_frame(&mut source).expect("no fault");
        let mut rows = Vec::new();
        while let Some(row) = pipeline.next_row(&mut source).expect("no fault") {
            rows.push(row.into());
        }
        rows
    };
    let (odd, even) = (frame(), frame());
    assert!(odd != even && odd.len() == usize::from(HEIGHT));
    [even, odd]
}
