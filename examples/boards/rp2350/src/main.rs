//! Depth on both cores of an RP2350, from two HM01B0 over PIO and DMA: the README has the wiring.
//!
//! * [`sensors`]: both sensors set up alike, over an I2C bus each, on one master clock.
//! * [`capture`]: on core 0, above all else: a trigger for every frame, a line of both cameras by PIO and
//!   DMA, handed to the cores whose bands take it.
//! * [`matching`]: on both cores, a band of rows each.
//! * The nearest distance of every frame goes out by the UART.
#![no_std]
#![no_main]

mod capture;
mod matching;
mod sensors;

use board_matchers::Decimal;
use board_matchers::two_cores::{Memory, bands, start};
use capture::{Camera, Capture};
use core::panic::PanicInfo;
use embassy_executor::{Executor, InterruptExecutor};
use embassy_rp::dma::{Channel, InterruptHandler as DmaHandler};
use embassy_rp::gpio::{Level, Output};
use embassy_rp::interrupt::{self, InterruptExt, Priority};
use embassy_rp::multicore::{Stack, spawn_core1};
use embassy_rp::peripherals::{DMA_CH0, DMA_CH1, PIO0};
use embassy_rp::pio::{InterruptHandler as PioHandler, Pio};
use embassy_rp::uart::{Blocking, Config as UartConfig, UartTx};
use embassy_rp::{bind_interrupts, i2c, pwm};
use matching::Seen;
use static_cell::{ConstStaticCell, StaticCell};

bind_interrupts!(struct Irqs {
    PIO0_IRQ_0 => PioHandler<PIO0>;
    DMA_IRQ_0 => DmaHandler<DMA_CH0>, DmaHandler<DMA_CH1>;
});

static ABOVE: InterruptExecutor = InterruptExecutor::new();
static CORE_0: StaticCell<Executor> = StaticCell::new();
static CORE_1: StaticCell<Executor> = StaticCell::new();
/// The matcher takes 2 KB, the executor and the interrupts the rest.
static STACK_1: ConstStaticCell<Stack<8192>> = ConstStaticCell::new(Stack::new());
static MEMORIES: [ConstStaticCell<Memory>; 2] = [const { ConstStaticCell::new(Memory::new()) }; 2];

/// Runs the capture above whatever core 0 does.
#[embassy_rp::interrupt]
#[allow(unsafe_code)]
unsafe fn SWI_IRQ_0() {
    // SAFETY: this is the interrupt that the executor was started with, and nobody else calls it.
    unsafe { ABOVE.on_interrupt() }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let p = embassy_rp::init(embassy_rp::config::Config::default());

    // 150 MHz / 12 for both sensors, which divide by 8 and count a line in 376 of those: 241 us.
    let mut clock = pwm::Config::default();
    (clock.top, clock.compare_b) = (11, 6);
    let clock = pwm::Pwm::new_output_b(p.PWM_SLICE2, p.PIN_21, clock);
    let left = i2c::I2c::new_blocking(p.I2C0, p.PIN_17, p.PIN_16, i2c::Config::default());
    let right = i2c::I2c::new_blocking(p.I2C1, p.PIN_19, p.PIN_18, i2c::Config::default());
    sensors::start(left).expect("the left sensor answers");
    sensors::start(right).expect("the right sensor answers");

    let Pio { mut common, sm0, sm1, .. } = Pio::new(p.PIO0, Irqs);
    let program = capture::load(&mut common);
    let pins = [
        common.make_pio_pin(p.PIN_0),
        common.make_pio_pin(p.PIN_1),
        common.make_pio_pin(p.PIN_2),
        common.make_pio_pin(p.PIN_3),
        common.make_pio_pin(p.PIN_4),
        common.make_pio_pin(p.PIN_5),
        common.make_pio_pin(p.PIN_6),
    ];
    let left = Camera::new(sm0, &program, &pins, Channel::new(p.DMA_CH0, Irqs));
    let pins = [
        common.make_pio_pin(p.PIN_7),
        common.make_pio_pin(p.PIN_8),
        common.make_pio_pin(p.PIN_9),
        common.make_pio_pin(p.PIN_10),
        common.make_pio_pin(p.PIN_11),
        common.make_pio_pin(p.PIN_12),
        common.make_pio_pin(p.PIN_13),
    ];
    let right = Camera::new(sm1, &program, &pins, Channel::new(p.DMA_CH1, Irqs));

    // A band of the frame for each core, with memory of its own.
    let mut bands = bands().zip(&MEMORIES).map(|(band, memory)| start(band, memory.take()));
    let (first, to_first) = bands.next().expect("a frame has rows");
    let (second, to_second) = bands.next().expect("there are rows for two cores");

    interrupt::SWI_IRQ_0.set_priority(Priority::P2);
    let trigger = Output::new(p.PIN_22, Level::Low);
    let capture = Capture { left, right, trigger, to: [to_first, to_second], clock };
    ABOVE.start(interrupt::SWI_IRQ_0).spawn(capture::run(capture).expect("one capture"));
    spawn_core1(p.CORE1, STACK_1.take(), move || {
        let executor = CORE_1.init(Executor::new());
        executor.run(|spawner| spawner.spawn(matching::run(second).expect("one of two tasks")))
    });
    let uart = UartTx::new_blocking(p.UART0, p.PIN_28, UartConfig::default());
    CORE_0.init(Executor::new()).run(|spawner| {
        spawner.spawn(matching::run(first).expect("one of two tasks"));
        spawner.spawn(show(uart).expect("one display"));
    })
}

/// Says the nearest distance of every frame, in millimetres, and the lines that were lost: `12 524 0`.
#[embassy_executor::task]
async fn show(mut uart: UartTx<'static, Blocking>) -> ! {
    let mut cores: [Option<Seen>; 2] = [None; 2];
    loop {
        let seen = matching::SEEN.receive().await;
        if let Some(core) = cores.get_mut(seen.core) {
            *core = Some(seen);
        }
        if let [Some(one), Some(other)] = cores
            && one.sequence == other.sequence
        {
            let nearest_mm = one.nearest_mm.min(other.nearest_mm);
            let lost_lines = u32::from(one.lost_lines) + u32::from(other.lost_lines);
            for (number, end) in [(one.sequence, b' '), (nearest_mm.into(), b' '), (lost_lines, b'\n')] {
                // Nobody is there to be told when the UART fails.
                let _ = uart.blocking_write(Decimal::new(number, end).bytes());
            }
        }
    }
}

/// The vendor's library panics where it is misused; both cores stop then, and a debugger says where.
#[panic_handler]
fn panic(_info: &PanicInfo<'_>) -> ! {
    cortex_m::interrupt::disable();
    loop {
        cortex_m::asm::wfe();
    }
}
