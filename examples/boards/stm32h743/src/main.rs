//! Depth on an STM32H743, from a stereo camera that sends both pictures side by side over DCMI: the README
//! has the wiring.
//!
//! * [`capture`]: above all else, lines by DCMI and DMA into the queue.
//! * [`board_matchers`]: the memory of the queue and of the pipeline.
//! * The task here matches them, and says the nearest distance of every frame on the UART.
#![no_std]
#![no_main]

mod capture;

use board_matchers::Decimal;
use board_matchers::one_core::{Matching, Memory, start};
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

/// A frame that takes longer has stopped.
const NO_FRAME: Duration = Duration::from_millis(500);

bind_interrupts!(struct Irqs {
    DMA1_STREAM0 => InterruptHandler<DMA1_CH0>;
});

static ABOVE: InterruptExecutor = InterruptExecutor::new();
static BELOW: StaticCell<Executor> = StaticCell::new();
static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());

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
    let (matching, destination) = start(MEMORY.take());
    let port = capture::Port::new(p.DCMI, p.DMA1_CH0, Irqs, pins, destination);
    interrupt::UART5.set_priority(Priority::P6);
    ABOVE.start(interrupt::UART5).spawn(capture::run(port).expect("one capture"));

    let uart = UartTx::new_blocking(p.USART3, p.PD8, UartConfig::default()).expect("a baud rate that it has");
    BELOW.init(Executor::new()).run(|spawner| {
        spawner.spawn(depth(matching, uart).expect("one task"));
    })
}

/// Says the nearest distance of every frame, in millimetres, and the lines that were lost: `12 524 0`.
#[embassy_executor::task]
async fn depth(matching: Matching, mut uart: UartTx<'static, Blocking>) -> ! {
    let Matching { rows, mut cameras, mut lines, scale } = matching;
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
            // Nobody is there to be told when the UART fails.
            let _ = uart.blocking_write(Decimal::new(number, end).bytes());
        }
    }
}

/// The vendor's library panics where it is misused; the core stops then, and a debugger says where.
#[panic_handler]
fn panic(_info: &PanicInfo<'_>) -> ! {
    cortex_m::interrupt::disable();
    loop {
        cortex_m::asm::wfe();
    }
}
