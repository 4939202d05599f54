//! Depth in a software task of RTIC, on lines that a hardware task brings, on a Cortex-M3: `cargo run
//! --release` prints the nearest distance of each frame and holds its depths to those of the blocking calls,
//! in QEMU. SysTick stands for the DMA's interrupt that brings a line of both cameras; put yours in its
//! place, your chip's crate in that of `lm3s6965` (the names of a Cortex-M3's interrupts are all that is used
//! of it), and your board's memory in memory.x.
//!
//! It does not link when a panic is left in it.
#![no_std]
#![no_main]

mod cameras;
mod console;

use core::panic::PanicInfo;

/// The tasks: SysTick brings lines, `depth` awaits rows, and the idle task has the time that is left.
#[rtic::app(device = lm3s6965, dispatchers = [SSI0])]
mod app {
    use crate::cameras::{HEIGHT, LINE, Sensor, WIDTH, Waiting};
    use crate::console::{figure, text};
    use cortex_m::peripheral::syst::SystClkSource;
    use semihosting::process;
    use stereopsis::camera::{
        LineFormat, LineListener, LineSignal, LineSlots, PixelFormat, PolledLines, SideBySide,
    };
    use stereopsis::depth::DepthScale;
    use stereopsis::geometry::camera::RectifiedRig;
    use stereopsis::matching::{Block, Config, Row};
    use stereopsis::pipeline::Guarded;

    /// Slots: the last rows of a frame come out together, and take as long as so many lines.
    const SLOTS: usize = 16;
    /// Ticks of the 25 MHz timer from line to line. QEMU counts 40 instructions a tick: a row takes 107 000.
    const LINE_TICKS: u32 = 3750;
    /// Frames that are shown.
    const FRAMES: u32 = 3;

    /// Lines of both cameras, to the task that matches them.
    type Lines = SideBySide<PolledLines<'static, 'static, LINE>, LINE>;
    /// All the memory that matching takes: lines of up to 160 pixels, 32 disparities.
    type Depths = Guarded<Block, WIDTH, 32>;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        sensor: Sensor,
        matching: Matching,
    }

    /// What the task that matches works with.
    pub struct Matching {
        pipeline: &'static mut Depths,
        cameras: Lines,
        lines: LineListener<'static>,
        scale: DepthScale,
        /// The checksum of a frame's depths by the blocking calls.
        blocking: u32,
    }

    /// The nearest depth of a frame, mm, and the checksum of all.
    #[derive(Clone, Copy)]
    struct Summary {
        nearest: u16,
        checksum: u32,
    }

    impl Summary {
        /// Of no row.
        const EMPTY: Self = Self { nearest: u16::MAX, checksum: 0x811c_9dc5 };

        /// With one more row; FNV-1a over the millimetres.
        fn with(self, row: &Row<'_>, scale: &DepthScale) -> Self {
            row.disparities().iter().map(|&d| scale.millimetres(d).0).fold(self, |so_far, mm| Self {
                nearest: if mm > 0 { so_far.nearest.min(mm) } else { so_far.nearest }, // 0 is no answer.
                checksum: (so_far.checksum ^ u32::from(mm)).wrapping_mul(0x0100_0193),
            })
        }
    }

    #[init(local = [
        slots: [[u8; LINE]; SLOTS] = [[0; LINE]; SLOTS],
        queues: LineSlots<'static, LINE, { SLOTS + 1 }> = LineSlots::new(),
        signal: LineSignal = LineSignal::new(),
        pipeline: Depths = Guarded::new(),
    ])]
    fn init(cx: init::Context) -> (Shared, Local) {
        let init::LocalResources { slots, queues, signal, pipeline, .. } = cx.local;
        let Some((scale, blocking)) = prepare(pipeline) else { process::exit(1) };
        let (producer, consumer) = queues.split(slots);
        let (notifier, lines) = signal.split();
        let format = LineFormat { width: LINE as u16, height: HEIGHT, pixel: PixelFormat::Grey8 };
        let Ok(polled) = PolledLines::new(consumer, format) else { process::exit(1) };
        let Ok(cameras) = SideBySide::new(polled) else { process::exit(1) };
        if depth::spawn().is_err() {
            process::exit(1)
        }
        let mut timer = cx.core.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(LINE_TICKS - 1);
        timer.clear_current();
        timer.enable_interrupt();
        timer.enable_counter();
        let matching = Matching { pipeline, cameras, lines, scale, blocking };
        (Shared {}, Local { sensor: Sensor::new(producer, notifier), matching })
    }

    /// Starts the pipeline and takes a frame by the blocking calls: the scale of its depths, their checksum.
    fn prepare(pipeline: &mut Depths) -> Option<(DepthScale, u32)> {
        let rig = RectifiedRig::new(140.0, 0.06, 79.5, 59.5).ok()?; // px, m, principal point px
        let scale = DepthScale::new(&rig).ok()?;
        pipeline.start(&Config::for_method::<Block>(WIDTH as u16, HEIGHT, 32)).ok()?;
        let (mut cameras, mut summary) = (Waiting::default(), Summary::EMPTY);
        pipeline.begin_frame(&mut cameras).ok()?;
        while let Some(row) = pipeline.next_row(&mut cameras).ok()? {
            summary = summary.with(&row, &scale);
        }
        Some((scale, summary.checksum))
    }

    /// A line of both cameras has come.
    #[task(binds = SysTick, priority = 2, local = [sensor])]
    fn line(cx: line::Context) {
        cx.local.sensor.tick();
    }

    /// Shows the nearest distance of each frame.
    #[task(priority = 1, local = [matching])]
    async fn depth(cx: depth::Context) -> ! {
        let Matching { pipeline, cameras, lines, scale, blocking } = cx.local.matching;
        for _ in 0..FRAMES {
            // In a product a time-out stands around what is awaited: the cameras may be dead.
            let Ok(frame) = pipeline.begin_frame_async(cameras, lines).await else { process::exit(1) };
            let mut summary = Summary::EMPTY;
            loop {
                match pipeline.next_row_async(cameras, lines).await {
                    Ok(Some(row)) => summary = summary.with(&row, scale),
                    Ok(None) => break,
                    Err(_) => process::exit(1),
                }
            }
            figure(c"frame ", frame.sequence);
            figure(c": nearest mm ", summary.nearest.into());
            figure(c", lines lost ", cameras.source().overruns());
            let is_same = summary.checksum == *blocking;
            text(if is_same { c"; depths as blocking\n" } else { c"; other depths than blocking\n" });
        }
        process::exit(0)
    }

    /// Waits for interrupts.
    #[idle]
    fn idle(_: idle::Context) -> ! {
        loop {
            cortex_m::asm::wfi();
        }
    }
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
