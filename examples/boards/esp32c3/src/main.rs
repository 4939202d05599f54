//! Depth on an ESP32-C3, from two cameras on one SPI bus: the README has the wiring.
//!
//! The frame itself is in `spi_cameras`; here are the chip's peripherals. The nearest distance of every frame
//! goes out by the UART.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use embassy_embedded_hal::shared_bus::asynch::spi::SpiDevice;
use embassy_executor::Executor;
use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::mutex::Mutex;
use esp_hal::clock::CpuClock;
use esp_hal::dma::{DmaRxBuf, DmaTxBuf};
use esp_hal::gpio::{Level, Output, OutputConfig};
use esp_hal::spi::Mode;
use esp_hal::spi::master::{Config as SpiConfig, Spi, SpiDmaBus};
use esp_hal::time::Rate;
use esp_hal::timer::OneShotTimer;
use esp_hal::timer::timg::TimerGroup;
use esp_hal::uart::{Config as UartConfig, Uart};
use esp_hal::{Async, Blocking};
use spi_cameras::frames::{self, Cameras, Rows};
use spi_cameras::mega::{BURST_BYTES, Mega};
use spi_cameras::text;
use static_cell::{ConstStaticCell, StaticCell};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;

/// Focal length px, baseline m, principal point px: those of your calibration.
const RIG: (f32, f32, f32, f32) = (130.0, 0.05, 63.5, 63.5);

/// The bus of both cameras, one at a time.
type Bus = Mutex<NoopRawMutex, SpiDmaBus<'static, Async>>;
/// A camera's place on it.
type Device = SpiDevice<'static, NoopRawMutex, SpiDmaBus<'static, Async>, Output<'static>>;
type Pair = Cameras<Device, Device, OneShotTimer<'static, Async>>;

static EXECUTOR: StaticCell<Executor> = StaticCell::new();
static BUS: StaticCell<Bus> = StaticCell::new();
static ROWS: ConstStaticCell<Rows> = ConstStaticCell::new(Rows::new());

// What the second-stage bootloader wants to know of the program.
esp_bootloader_esp_idf::esp_app_desc!();

#[esp_hal::main]
fn main() -> ! {
    let p = esp_hal::init(esp_hal::Config::default().with_cpu_clock(CpuClock::max()));

    let config = SpiConfig::default().with_frequency(Rate::from_mhz(8)).with_mode(Mode::_0);
    let spi = Spi::new(p.SPI2, config).expect("a frequency that it has");
    let spi = spi.with_sck(p.GPIO6).with_mosi(p.GPIO7).with_miso(p.GPIO2).with_dma(p.DMA_CH0);
    // The longest transfer goes through both at once.
    let (received, receive, sent, send) = esp_hal::dma_buffers!(BURST_BYTES);
    let received = DmaRxBuf::new(receive, received).expect("a descriptor for a line");
    let sent = DmaTxBuf::new(send, sent).expect("a descriptor for a line");
    let bus = BUS.init(Mutex::new(spi.with_buffers(received, sent).into_async()));
    let select = |pin: Output<'static>| Mega::new(SpiDevice::new(&*bus, pin));
    let timers = TimerGroup::new(p.TIMG0);
    let more_timers = TimerGroup::new(p.TIMG1);
    let cameras = Cameras {
        left: select(Output::new(p.GPIO10, Level::High, OutputConfig::default())),
        right: select(Output::new(p.GPIO3, Level::High, OutputConfig::default())),
        delays: [timers.timer0, more_timers.timer0].map(|timer| OneShotTimer::new(timer).into_async()),
    };

    let rows = ROWS.take();
    rows.start(&frames::config()).expect("within its capacity");
    let uart = Uart::new(p.UART0, UartConfig::default()).expect("a baud rate that it has").with_tx(p.GPIO21);
    EXECUTOR.init(Executor::new()).run(|spawner| {
        spawner.spawn(depth(cameras, rows, uart).expect("one task"));
    })
}

/// Says the nearest distance of every frame, in millimetres: `12 524`; 65535 without an answer.
#[embassy_executor::task]
async fn depth(mut cameras: Pair, rows: &'static mut Rows, mut uart: Uart<'static, Blocking>) -> ! {
    let (focal_px, baseline_m, u, v) = RIG;
    let rig = RectifiedRig::new(focal_px, baseline_m, u, v).expect("a rig");
    let scale = DepthScale::new(&rig).expect("depths");
    let (mut sequence, mut is_set_up) = (0u32, false);
    loop {
        // After a fault both begin anew.
        if !is_set_up && let Err(error) = cameras.set_up().await {
            write(&mut uart, text::fault(error.words()));
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
            write(&mut uart, text::fault(words));
        } else {
            sequence = sequence.wrapping_add(1);
            write(&mut uart, text::frame(sequence, nearest_mm));
        }
    }
}

/// Writes a line.
fn write(uart: &mut Uart<'static, Blocking>, line: impl Iterator<Item = u8>) {
    for byte in line {
        // Nobody is there to be told when the UART fails.
        let _ = uart.write(&[byte]);
    }
}

/// The vendor's library panics where it is misused; the core stops then, and a debugger says where.
#[panic_handler]
fn panic(_info: &PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
