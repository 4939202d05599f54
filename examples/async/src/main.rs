//! Depth in one task of embassy's executor and other work in a second one, on a Cortex-M4: `cargo run
//! --release` prints the nearest distance of each frame, in QEMU. SysTick stands for the DMA's interrupt that
//! brings a line of both cameras; put yours in its place, and your board's memory in memory.x.
//!
//! It does not link when a panic is left in it.
#![no_std]
#![no_main]

use core::cell::{Cell, RefCell};
use core::ffi::CStr;
use core::panic::PanicInfo;
use cortex_m::peripheral::{Peripherals, syst::SystClkSource};
use critical_section::Mutex;
use embassy_executor::{Executor, Spawner};
use embassy_futures::yield_now;
use semihosting::{process, sys::arm_compat::sys_write0};
use static_cell::{ConstStaticCell, StaticCell};
use stereopsis::camera::{
    FrameStart, LineFormat, LineListener, LineNotifier, LineProducer, LineSignal, LineSlots, LineStart,
    PixelFormat, PolledLines, SideBySide,
};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::matching::{Block, Config};
use stereopsis::pipeline::Guarded;

const WIDTH: usize = 160;
const HEIGHT: u16 = 120;
/// A line of both cameras.
const LINE: usize = 2 * WIDTH;
/// Slots: the last rows of a frame come out together, and take as long as so many lines.
const SLOTS: usize = 16;
/// Lines' times between two frames, as in a sensor's vertical blanking.
const BLANKING: u16 = 16;
/// Ticks of the 25 MHz timer from line to line. QEMU counts 40 instructions a tick: a row takes 59 400.
const LINE_TICKS: u32 = 2500;
/// Frames that are shown.
const FRAMES: u32 = 3;

/// Lines of both cameras, to the task that matches them.
type Lines = SideBySide<PolledLines<'static, 'static, LINE>, LINE>;

static EXECUTOR: StaticCell<Executor> = StaticCell::new();
static SLOT_BYTES: ConstStaticCell<[[u8; LINE]; SLOTS]> = ConstStaticCell::new([[0; LINE]; SLOTS]);
static QUEUES: ConstStaticCell<LineSlots<'static, LINE, { SLOTS + 1 }>> =
    ConstStaticCell::new(LineSlots::new());
static SIGNAL: ConstStaticCell<LineSignal> = ConstStaticCell::new(LineSignal::new());
/// All the memory that matching takes: lines of up to 160 pixels, 32 disparities.
static PIPELINE: ConstStaticCell<Guarded<Block, WIDTH, 32>> = ConstStaticCell::new(Guarded::new());
static SENSOR: Mutex<RefCell<Option<Sensor>>> = Mutex::new(RefCell::new(None));
/// Turns of the task that does other work.
static TURNS: Mutex<Cell<u32>> = Mutex::new(Cell::new(0));

/// Two cameras before a wall (disparity 4 px) with a box in front of it (16 px), as an interrupt sees them.
struct Sensor {
    producer: LineProducer<'static, 'static, LINE>,
    notifier: LineNotifier<'static>,
    frame: FrameStart,
    row: u16,
}

impl Sensor {
    /// A line's time has passed.
    fn tick(&mut self) {
        let row = self.row;
        if row < HEIGHT
            && let Some(mut line) = self.producer.begin()
        {
            let grey = |u: usize| ((u as u32 * 64 + u32::from(row)).wrapping_mul(0x9e37_79b1) >> 24) as u8;
            let on_box = |u: usize| (40..80).contains(&row) && (60..100).contains(&u);
            let (left, right) = line.bytes().split_at_mut(WIDTH);
            for (u, (l, r)) in left.iter_mut().zip(right).enumerate() {
                (*l, *r) = (grey(u), grey(u + if on_box(u + 16) { 16 } else { 4 }));
            }
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

#[cortex_m_rt::exception]
fn SysTick() {
    critical_section::with(|cs| {
        if let Ok(mut sensor) = SENSOR.borrow(cs).try_borrow_mut() {
            sensor.iter_mut().for_each(Sensor::tick);
        }
    });
}

/// Shows the nearest distance of each frame.
#[embassy_executor::task]
async fn depth(
    pipeline: &'static mut Guarded<Block, WIDTH, 32>,
    mut cameras: Lines,
    mut lines: LineListener<'static>,
    scale: DepthScale,
) -> ! {
    for _ in 0..FRAMES {
        // In a product `embassy_time::with_timeout` stands around what is awaited: the cameras may be dead.
        let Ok(frame) = pipeline.begin_frame_async(&mut cameras, &mut lines).await else { process::exit(1) };
        let mut nearest = u16::MAX;
        loop {
            match pipeline.next_row_async(&mut cameras, &mut lines).await {
                Ok(Some(row)) => {
                    let depths = row.disparities().iter().map(|&d| scale.millimetres(d).0);
                    nearest = depths.filter(|&mm| mm > 0).fold(nearest, u16::min); // 0 is no answer.
                }
                Ok(None) => break,
                Err(_) => process::exit(1),
            }
        }
        // The time that matching leaves is the other task's.
        let turns = critical_section::with(|cs| TURNS.borrow(cs).take());
        let had_turns =
            if turns > 0 { c"; the other task had turns\n" } else { c"; the other task had no turn\n" };
        figure(c"frame ", frame.sequence);
        figure(c": nearest mm ", nearest.into());
        figure(c", lines lost ", cameras.source().overruns());
        sys_write0(had_turns);
    }
    process::exit(0)
}

/// A name and a number on the host's console; `core::fmt` may panic.
fn figure(name: &CStr, number: u32) {
    sys_write0(name);
    let (mut digits, mut rest) = ([0; 11], number);
    let mut first = digits.len() - 1; // The last byte is the end of a C string.
    for (at, digit) in digits.iter_mut().enumerate().rev().skip(1) {
        (*digit, rest, first) = (b'0' + (rest % 10) as u8, rest / 10, at);
        if rest == 0 {
            break;
        }
    }
    if let Ok(text) = CStr::from_bytes_with_nul(digits.get(first..).unwrap_or_default()) {
        sys_write0(text);
    }
}

/// Other work, which gives way at every turn.
#[embassy_executor::task]
async fn other_work() -> ! {
    loop {
        critical_section::with(|cs| TURNS.borrow(cs).set(TURNS.borrow(cs).get().wrapping_add(1)));
        yield_now().await;
    }
}

/// Puts everything in its place and starts both tasks; `None` where something was not there.
fn start(spawner: Spawner) -> Option<()> {
    let rig = RectifiedRig::new(140.0, 0.06, 79.5, 59.5).ok()?; // px, m, principal point px
    let scale = DepthScale::new(&rig).ok()?;
    let pipeline = PIPELINE.try_take()?;
    pipeline.start(&Config::for_method::<Block>(WIDTH as u16, HEIGHT, 32)).ok()?;
    let (producer, consumer) = QUEUES.try_take()?.split(SLOT_BYTES.try_take()?);
    let (notifier, listener) = SIGNAL.try_take()?.split();
    let format = LineFormat { width: LINE as u16, height: HEIGHT, pixel: PixelFormat::Grey8 };
    let cameras = SideBySide::new(PolledLines::new(consumer, format).ok()?).ok()?;
    spawner.spawn(depth(pipeline, cameras, listener, scale).ok()?);
    spawner.spawn(other_work().ok()?);
    let frame = FrameStart { sequence: 1, timestamp_us: 10_000, exposure_us: 0 };
    critical_section::with(|cs| {
        if let Ok(mut sensor) = SENSOR.borrow(cs).try_borrow_mut() {
            *sensor = Some(Sensor { producer, notifier, frame, row: 0 });
        }
    });
    let mut timer = Peripherals::take()?.SYST;
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(LINE_TICKS - 1);
    timer.clear_current();
    timer.enable_interrupt();
    timer.enable_counter();
    Some(())
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(executor) = EXECUTOR.try_init(Executor::new()) else { process::exit(1) };
    executor.run(|spawner| {
        if start(spawner).is_none() {
            process::exit(1)
        }
    })
}

/// There is no panic: this handler calls a function that does not exist, so that a program with one panic
/// left in it does not link, and the linker's error says who panics.
#[panic_handler]
#[allow(unsafe_code)]
fn panic(_info: &PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn this_firmware_can_panic() -> !;
    }
    // SAFETY: it is never called, because what calls it does not link.
    unsafe { this_firmware_can_panic() }
}
