//! Depth on the application core of an nRF5340, from two cameras with an SPI bus each: the README has the
//! wiring.
//!
//! The frame itself is in `spi_cameras`; here are the chip's peripherals. The nearest distance of every frame
//! goes out by the UART.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use embassy_embedded_hal::shared_bus::asynch::spi::SpiDevice;
use embassy_executor::Executor;
use embassy_nrf::config::{Config as ChipConfig, HfclkSource};
use embassy_nrf::gpio::{Level, Output, OutputDrive};
use embassy_nrf::pac;
use embassy_nrf::pac::clock::vals::Hclk;
use embassy_nrf::peripherals::{SERIAL0, SERIAL1, SERIAL2};
use embassy_nrf::spim::{Config as SpiConfig, Frequency, Spim};
use embassy_nrf::uarte::{Config as UartConfig, UarteTx};
use embassy_nrf::{bind_interrupts, spim, uarte};
use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::mutex::Mutex;
use embassy_time::Delay;
use spi_cameras::frames::{self, Cameras, Rows};
use spi_cameras::mega::Mega;
use spi_cameras::text;
use static_cell::{ConstStaticCell, StaticCell};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;

/// Focal length px, baseline m, principal point px: those of your calibration.
const RIG: (f32, f32, f32, f32) = (130.0, 0.05, 63.5, 63.5);

/// A camera's bus, and the camera's place on it.
type Bus = Mutex<NoopRawMutex, Spim<'static>>;
type Device = SpiDevice<'static, NoopRawMutex, Spim<'static>, Output<'static>>;
type Pair = Cameras<Device, Device, Delay>;

bind_interrupts!(struct Irqs {
    SERIAL0 => spim::InterruptHandler<SERIAL0>;
    SERIAL1 => spim::InterruptHandler<SERIAL1>;
    SERIAL2 => uarte::InterruptHandler<SERIAL2>;
});

static EXECUTOR: StaticCell<Executor> = StaticCell::new();
static BUSES: [StaticCell<Bus>; 2] = [const { StaticCell::new() }; 2];
static ROWS: ConstStaticCell<Rows> = ConstStaticCell::new(Rows::new());

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut chip = ChipConfig::default();
    // The buses' clocks come from the crystal.
    chip.hfclk_source = HfclkSource::ExternalXtal;
    let p = embassy_nrf::init(chip);
    // After a reset the core has half of its speed, and reads the flash without its cache.
    pac::CLOCK.hfclkctrl().write(|clock| clock.set_hclk(Hclk::Div1));
    pac::CACHE.enable().write(|cache| cache.set_enable(true));

    let mut config = SpiConfig::default();
    config.frequency = Frequency::M8;
    let left = Spim::new(p.SERIAL0, Irqs, p.P1_15, p.P1_14, p.P1_13, config.clone());
    let right = Spim::new(p.SERIAL1, Irqs, p.P1_08, p.P1_07, p.P1_06, config);
    let [left_bus, right_bus] = &BUSES;
    let (left, right) = (left_bus.init(Mutex::new(left)), right_bus.init(Mutex::new(right)));
    let left_select = Output::new(p.P1_12, Level::High, OutputDrive::Standard);
    let right_select = Output::new(p.P1_05, Level::High, OutputDrive::Standard);
    let cameras = Cameras {
        left: Mega::new(SpiDevice::new(&*left, left_select)),
        right: Mega::new(SpiDevice::new(&*right, right_select)),
        delays: [Delay, Delay],
    };

    let rows = ROWS.take();
    rows.start(&frames::config()).expect("within its capacity");
    let uart = UarteTx::new(p.SERIAL2, Irqs, p.P0_20, UartConfig::default());
    EXECUTOR.init(Executor::new()).run(|spawner| {
        spawner.spawn(depth(cameras, rows, uart).expect("one task"));
    })
}

/// Says the nearest distance of every frame, in millimetres: `12 524`; 65535 without an answer.
#[embassy_executor::task]
async fn depth(mut cameras: Pair, rows: &'static mut Rows, mut uart: UarteTx<'static>) -> ! {
    let (focal_px, baseline_m, u, v) = RIG;
    let rig = RectifiedRig::new(focal_px, baseline_m, u, v).expect("a rig");
    let scale = DepthScale::new(&rig).expect("depths");
    let (mut sequence, mut is_set_up) = (0u32, false);
    loop {
        // After a fault both begin anew.
        if !is_set_up && let Err(error) = cameras.set_up().await {
            write(&mut uart, text::fault(error.words())).await;
            cameras.rest().await;
            continue;
        }
        let mut nearest_mm = u16::MAX;
        let taken = cameras.frame(rows, |row| {
            let depths = row.disparities().iter().map(|&d| scale.millimetres(d).0);
            nearest_mm = depths.filter(|&mm| mm > 0).fold(nearest_mm, u16::min); // 0 is no answer.
        });
        let fault = taken.await.err().map(|error| error.words());
        is_set_up = fault.is_none();
        if let Some(words) = fault {
            write(&mut uart, text::fault(words)).await;
        } else {
            sequence = sequence.wrapping_add(1);
            write(&mut uart, text::frame(sequence, nearest_mm)).await;
        }
    }
}

/// Writes a line.
async fn write(uart: &mut UarteTx<'static>, line: impl Iterator<Item = u8>) {
    let (mut text, mut length) = ([0; text::LONGEST], 0);
    for (to, byte) in text.iter_mut().zip(line) {
        (*to, length) = (byte, length + 1);
    }
    // Nobody is there to be told when the UART fails.
    let _ = uart.write_from_ram(text.get(..length).unwrap_or_default()).await;
}

/// The vendor's library panics where it is misused; the core stops then, and a debugger says where.
#[panic_handler]
fn panic(_info: &PanicInfo<'_>) -> ! {
    cortex_m::interrupt::disable();
    loop {
        cortex_m::asm::wfe();
    }
}
