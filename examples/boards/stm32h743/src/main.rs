//! Depth on an STM32H743, from a stereo camera that sends both pictures side by side over DCMI: the README
//! has the wiring.
//!
//! * [`capture`]: above all else, lines by DCMI and DMA into the queue.
//! * The task here matches them, and says the nearest distance of every frame on the UART.
#![no_std]
#![no_main]

mod capture;

use core::panic::PanicInfo;
use embassy_executor::{Executor, InterruptExecutor};
use embassy_stm32::dma::InterruptHandler;
use embassy_stm32::interrupt::{self, InterruptExt, Priority};
use embassy_stm32::mode::Blocking;
use embassy_stm32::peripherals::DMA1_CH0;
use embassy_stm32::rcc;
use embassy_stm32::usart::{Config as UartConfig, UartTx};
use embassy_stm32::{Config as ChipConfig, bind_interrupts};
use embassy_time::{Duration, with_timeout};
use static_cell::{ConstStaticCell, StaticCell};
use stereopsis::camera::{
    LineFormat, LineListener, LineSignal, LineSlots, PixelFormat, PolledLines, SideBySide,
};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::matching::{Block, Config};
use stereopsis::pipeline::Guarded;

/// Columns of an image, px.
const WIDTH: u16 = 160;
/// Rows of a frame, px.
const HEIGHT: u16 = 120;
const DISPARITIES: u16 = 32;
/// A line of both cameras.
const LINE: usize = 2 * WIDTH as usize;
/// Slots: the last rows of a frame come out together, and take as long as so many lines.
const SLOTS: usize = 16;
/// Focal length px, baseline m, principal point px: those of your calibration.
const RIG: (f32, f32, f32, f32) = (170.0, 0.05, 79.5, 59.5);
/// A frame that takes longer has stopped.
const NO_FRAME: Duration = Duration::from_millis(500);

type Rows = Guarded<Block, { WIDTH as usize }, { DISPARITIES as usize }>;
type Cameras = SideBySide<PolledLines<'static, 'static, LINE>, LINE>;

bind_interrupts!(struct Irqs {
    DMA1_STREAM0 => InterruptHandler<DMA1_CH0>;
});

static ABOVE: InterruptExecutor = InterruptExecutor::new();
static BELOW: StaticCell<Executor> = StaticCell::new();
static SLOT_BYTES: ConstStaticCell<[[u8; LINE]; SLOTS]> = ConstStaticCell::new([[0; LINE]; SLOTS]);
static QUEUES: ConstStaticCell<LineSlots<'static, LINE, { SLOTS + 1 }>> =
    ConstStaticCell::new(LineSlots::new());
static SIGNAL: ConstStaticCell<LineSignal> = ConstStaticCell::new(LineSignal::new());
static ROWS: ConstStaticCell<Rows> = ConstStaticCell::new(Guarded::new());

/// Runs the capture above the matcher. No peripheral of this program has this interrupt.
#[embassy_stm32::interrupt]
#[allow(unsafe_code)]
unsafe fn UART5() {
    // SAFETY: this is the interrupt that the executor was started with, and nobody else calls it.
    unsafe { ABOVE.on_interrupt() }
}

/// 400 MHz for the core, 200 MHz for the buses, from the internal oscillator of 64 MHz.
fn clocks() -> ChipConfig {
    let mut config = ChipConfig::default();
    config.rcc.hsi = Some(rcc::HSIPrescaler::DIV1);
    config.rcc.pll1 = Some(rcc::Pll {
        source: rcc::PllSource::HSI,
        prediv: rcc::PllPreDiv::DIV4,
        mul: rcc::PllMul::MUL50,
        fracn: None,
        divp: Some(rcc::PllDiv::DIV2),
        divq: Some(rcc::PllDiv::DIV8),
        divr: None,
    });
    config.rcc.sys = rcc::Sysclk::PLL1_P;
    config.rcc.ahb_pre = rcc::AHBPrescaler::DIV2;
    config.rcc.apb1_pre = rcc::APBPrescaler::DIV2;
    config.rcc.apb2_pre = rcc::APBPrescaler::DIV2;
    config.rcc.apb3_pre = rcc::APBPrescaler::DIV2;
    config.rcc.apb4_pre = rcc::APBPrescaler::DIV2;
    config.rcc.voltage_scale = rcc::VoltageScale::Scale1;
    config
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut core = cortex_m::Peripherals::take().expect("nobody took them before");
    // The code is in flash. The data needs no cache: the matcher's is tightly coupled, and what the DMA
    // writes is read once.
    core.SCB.enable_icache();
    let p = embassy_stm32::init(clocks());

    let pins = capture::Pins {
        low: (p.PC6, p.PC7, p.PC8, p.PC9),
        high: (p.PC11, p.PD3, p.PB8, p.PB9),
        vsync: p.PB7,
        hsync: p.PA4,
        clock: p.PA6,
    };
    let (producer, consumer) = QUEUES.take().split(SLOT_BYTES.take());
    let (notifier, lines) = SIGNAL.take().split();
    let port = capture::Port::new(p.DCMI, p.DMA1_CH0, Irqs, pins, producer, notifier);
    interrupt::UART5.set_priority(Priority::P6);
    ABOVE.start(interrupt::UART5).spawn(capture::run(port).expect("one capture"));

    let format = LineFormat { width: LINE as u16, height: HEIGHT, pixel: PixelFormat::Grey8 };
    let both = PolledLines::new(consumer, format).expect("a slot holds a line");
    let cameras = SideBySide::new(both).expect("a line has two halves");
    let rows = ROWS.take();
    rows.start(&Config::for_method::<Block>(WIDTH, HEIGHT, DISPARITIES)).expect("within its capacity");
    let uart = UartTx::new_blocking(p.USART3, p.PD8, UartConfig::default()).expect("a baud rate that it has");
    BELOW.init(Executor::new()).run(|spawner| {
        spawner.spawn(depth(rows, cameras, lines, uart).expect("one task"));
    })
}

/// Says the nearest distance of every frame, in millimetres, and the lines that were lost: `12 524 0`.
#[embassy_executor::task]
async fn depth(
    rows: &'static mut Rows,
    mut cameras: Cameras,
    mut lines: LineListener<'static>,
    mut uart: UartTx<'static, Blocking>,
) -> ! {
    let (focal_px, baseline_m, u, v) = RIG;
    let rig = RectifiedRig::new(focal_px, baseline_m, u, v).expect("a rig");
    let scale = DepthScale::new(&rig).expect("depths");
    loop {
        let begun = with_timeout(NO_FRAME, rows.begin_frame_async(&mut cameras, &mut lines)).await;
        let Ok(Ok(frame)) = begun else { continue };
        let mut nearest_mm = u16::MAX;
        // A dead camera and a broken frame end it; what was seen by then is told.
        while let Ok(Ok(Some(row))) =
            with_timeout(NO_FRAME, rows.next_row_async(&mut cameras, &mut lines)).await
        {
            let depths = row.disparities().iter().map(|&d| scale.millimetres(d).0);
            nearest_mm = depths.filter(|&mm| mm > 0).fold(nearest_mm, u16::min); // 0 is no answer.
        }
        let lost_lines = rows.lost_lines();
        for (number, end) in [(frame.sequence, b' '), (nearest_mm.into(), b' '), (lost_lines.into(), b'\n')] {
            write(&mut uart, number, end);
        }
    }
}

/// Writes a number and what follows it.
fn write(uart: &mut UartTx<'static, Blocking>, mut number: u32, end: u8) {
    let (mut text, mut first) = ([end; 11], 10);
    for (at, digit) in text.iter_mut().enumerate().rev().skip(1) {
        (*digit, number, first) = (b'0' + (number % 10) as u8, number / 10, at);
        if number == 0 {
            break;
        }
    }
    // Nobody is there to be told when the UART fails.
    let _ = uart.blocking_write(text.get(first..).unwrap_or_default());
}

/// The vendor's library panics where it is misused; the core stops then, and a debugger says where.
#[panic_handler]
fn panic(_info: &PanicInfo<'_>) -> ! {
    cortex_m::interrupt::disable();
    loop {
        cortex_m::asm::wfe();
    }
}
