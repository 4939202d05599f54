//! Depth from two cameras on a Cortex-M4: `cargo run --release` prints the nearest distance, in QEMU.
//! Put your cameras in place of `Cameras`, and your board's memory in memory.x.
#![no_std]
#![no_main]

use core::{convert::Infallible, ops::Range, result};
use semihosting::{println, process};
use static_cell::ConstStaticCell;
use stereopsis::camera::{CameraError, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource};
use stereopsis::matching::{Block, Config};
use stereopsis::{depth::DepthScale, geometry::camera::RectifiedRig, pipeline::Pipeline};

/// All the memory that matching takes: lines of up to 160 pixels, 32 disparities.
static PIPELINE: ConstStaticCell<Pipeline<Block, 160, 32>> = ConstStaticCell::new(Pipeline::new());

/// Two cameras before a wall (disparity 4 px) with a box in front of it (16 px), and the rows to come.
struct Cameras(Range<u16>);

impl stereopsis::camera::ErrorType for Cameras {
    type Error = Infallible; // Yours is what the bus or the DMA reports.
}
type Result<T> = result::Result<T, CameraError<Infallible>>;

impl StereoSource for Cameras {
    fn format(&self) -> LineFormat {
        LineFormat { width: 160, height: 120, pixel: PixelFormat::Grey8 }
    }
    fn max_row_skew_us(&self) -> u32 {
        0
    }
    fn start_frame(&mut self) -> Result<FrameStart> {
        self.0 = 0..120;
        Ok(FrameStart::default())
    }
    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart> {
        let row = self.0.next().ok_or(CameraError::NoLineLeft)?;
        let grey = |u: usize| ((u as u32 * 64 + u32::from(row)).wrapping_mul(0x9e37_79b1) >> 24) as u8;
        let on_box = |u: usize| (40..80).contains(&row) && (60..100).contains(&u);
        for (u, (l, r)) in left.iter_mut().zip(right).enumerate() {
            (*l, *r) = (grey(u), grey(u + if on_box(u + 16) { 16 } else { 4 }));
        }
        Ok(LineStart { row, timestamp_us: 0 })
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(pipeline) = PIPELINE.try_take() else { process::exit(1) };
    let rig = RectifiedRig::new(140.0, 0.06, 79.5, 59.5).expect("a rig"); // px, m, principal point px
    let (scale, mut cameras) = (DepthScale::new(&rig).expect("a scale"), Cameras(0..0));
    pipeline.start(&Config::for_method::<Block>(160, 120, 32)).expect("a search that fits the pipeline");
    pipeline.begin_frame(&mut cameras).expect("a frame");
    let mut nearest = u16::MAX;
    while let Some(row) = pipeline.next_row(&mut cameras).expect("a row") {
        let depths = row.disparities().iter().map(|&d| scale.millimetres(d).0);
        nearest = depths.filter(|&mm| mm > 0).fold(nearest, u16::min); // 0 is no answer.
    }
    println!("nearest: {nearest} mm"); // The box: about 140 px * 60 mm / 16 px.
    process::exit(0)
}
