//! The matcher of an nRF5340 or an ESP32-C3, by the driver of cameras on an SPI bus.
#![no_std]
#![no_main]

use embassy_futures::block_on;
use embedded_hal_async::delay::DelayNs;
use emulated_boards::{Checksum, entry};
use firmware_scenes::scene::{Scene, SceneCamera};
use spi_cameras::frames::{self, Cameras, Rows};
use spi_cameras::mega::{Mega, SIZE};
use spi_cameras::simulated::Simulated;
use static_cell::ConstStaticCell;
use stereopsis::camera::StereoSource;

static ROWS: ConstStaticCell<Rows> = ConstStaticCell::new(Rows::new());

/// A simulated camera is done after some questions, not after some time.
struct NoDelay;

impl DelayNs for NoDelay {
    async fn delay_ns(&mut self, _: u32) {}
}

/// One of the scene's two cameras.
fn camera(is_right: bool) -> Mega<Simulated<impl FnMut(u16, &mut [u8; SIZE])>> {
    let mut scene = SceneCamera::new(Scene { width: SIZE as u16, height: SIZE as u16 });
    Mega::new(Simulated::new(move |row, line: &mut [u8; SIZE]| {
        if row == 0 {
            scene.start_frame().expect("the scene begins");
        }
        let mut other = [0; SIZE];
        let (left, right) = if is_right { (&mut other, line) } else { (line, &mut other) };
        scene.next_lines(left, right).expect("the scene has so many lines");
    }))
}

#[entry]
fn main() -> ! {
    let mut cameras = Cameras { left: camera(false), right: camera(true), delays: [NoDelay, NoDelay] };
    let rows = ROWS.take();
    rows.start(&frames::config()).expect("within its capacity");
    let mut checksum = Checksum::new();
    block_on(async {
        cameras.set_up().await.expect("both cameras answer");
        cameras.frame(rows, |row| checksum.add(row)).await.expect("a frame");
    });
    checksum.end()
}
