//! Lines that an interrupt brings while the matcher works: a timer stands for a sensor's DMA, a line of both
//! cameras each time.
//!
//! 1. The built-in scene is rendered into memory, and matched from there without an interrupt: the rows, and
//!    the ticks that they take.
//! 2. The timer brings a line as often as those ticks allow, through [`LineSlots`]: frames of which no line
//!    may be lost.
//! 3. Twice as often: lines are lost, which has to be told, and every row without a flag has to be right all
//!    the same.
//! 4. The rows of a frame of step 2 in `interrupt.bin`, what it took on the console.
//!
//! The sensor does not wait: between two frames there are so many lines' times as a sensor's vertical
//! blanking has.
#![no_std]
#![no_main]

use core::cell::RefCell;
use critical_section::Mutex;
use static_cell::ConstStaticCell;
use stereopsis::camera::{
    FrameStart, HandedLines, LineFormat, LineProducer, LineSlots, LineStart, PixelFormat, SideBySide,
    StereoSource, StreamError,
};
use stereopsis::matching::{Block, Config, ConfigError, Filter, Row};
use stereopsis::pipeline::{Guarded, PipelineError};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_firmware::camera::memory::{Direct, Picture};
use stereopsis_firmware::camera::scene::{Scene, SceneCamera};
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::ticker::Ticker;
use stereopsis_firmware::{runtime, stack};

const WIDTH: usize = 160;
const HEIGHT: usize = 120;
const DISPARITIES: usize = 32;
/// A line of both cameras.
const LINE: usize = 2 * WIDTH;
/// Slots: a row's work takes longer than a line's time now and then, when the last rows of a frame come out.
const SLOTS: usize = 16;
/// Lines' times between two frames.
const BLANKING: usize = 16;
/// Frames at each rate.
const FRAMES: u32 = 4;

/// What the cameras see.
type Seen = Picture<LINE, HEIGHT>;

/// All that it takes besides the stack.
struct Memory {
    picture: Seen,
    slots: [[u8; LINE]; SLOTS],
    queues: LineSlots<'static, LINE, { SLOTS + 1 }>,
    pipeline: Guarded<Block, WIDTH, DISPARITIES>,
    rows: Rows,
}

/// A frame's rows.
struct Rows {
    disparities: [[Disparity; WIDTH]; HEIGHT],
    flags: [[PixelFlags; WIDTH]; HEIGHT],
}

static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory {
    picture: Picture([[0; LINE]; HEIGHT]),
    slots: [[0; LINE]; SLOTS],
    queues: LineSlots::new(),
    pipeline: Guarded::new(),
    rows: Rows {
        disparities: [[Disparity::ZERO; WIDTH]; HEIGHT],
        flags: [[PixelFlags::CLEAR; WIDTH]; HEIGHT],
    },
});

/// The interrupt's own: where it is in its frame, and where lines go.
struct Sensor {
    producer: LineProducer<'static, 'static, LINE>,
    picture: &'static Seen,
    sequence: u32,
    row: usize,
}

static SENSOR: Mutex<RefCell<Option<Sensor>>> = Mutex::new(RefCell::new(None));

impl Sensor {
    /// A line's time has passed.
    fn tick(&mut self) {
        if let Some(bytes) = self.picture.0.get(self.row)
            && let Some(mut line) = self.producer.begin()
        {
            line.bytes().copy_from_slice(bytes);
            let frame_us = u64::from(self.sequence) * 10_000;
            let frame = FrameStart { sequence: self.sequence, timestamp_us: frame_us, exposure_us: 0 };
            let start = LineStart { row: self.row as u16, timestamp_us: frame_us + self.row as u64 };
            self.producer.finish(line, frame, start);
        }
        self.row += 1;
        if self.row >= HEIGHT + BLANKING {
            (self.row, self.sequence) = (0, self.sequence.wrapping_add(1));
        }
    }
}

/// The timer's interrupt: in a product, that of a DMA's line.
#[cfg(target_arch = "arm")]
#[cortex_m_rt::exception]
fn SysTick() {
    critical_section::with(|cs| {
        if let Ok(mut sensor) = SENSOR.borrow(cs).try_borrow_mut() {
            sensor.iter_mut().for_each(Sensor::tick);
        }
    });
}

/// Sleeps until the next interrupt.
fn sleep() -> bool {
    #[cfg(target_arch = "arm")]
    cortex_m::asm::wfi();
    // Without a timer nothing would come.
    cfg!(target_arch = "arm")
}

#[runtime::entry]
fn main() -> ! {
    runtime::run(&MEMORY, run)
}

/// Why there are no frames.
#[derive(defmt::Format)]
enum Failure {
    /// The pipeline cannot do what is asked.
    Config(ConfigError),
    /// The scene gave no line.
    Scene,
    /// A frame broke off.
    Frame,
    /// The stream does not carry two cameras.
    Stream(StreamError),
    /// The slots are too short.
    Slots,
    /// The host did not take the rows.
    Host(HostError),
}

impl From<ConfigError> for Failure {
    fn from(error: ConfigError) -> Self {
        Self::Config(error)
    }
}

impl<E> From<PipelineError<E>> for Failure {
    fn from(_: PipelineError<E>) -> Self {
        Self::Frame
    }
}

/// What came of the frames at one rate.
#[derive(Default)]
struct Told {
    overruns: u32,
    lost: u32,
    rows: u32,
    damaged: u32,
    wrong: u32,
}

fn run(memory: &'static mut Memory) -> Result<(), Failure> {
    let clock = Clock::start();
    let Memory { picture, slots, queues, pipeline, rows } = memory;
    let mut scene = SceneCamera::new(Scene { width: WIDTH as u16, height: HEIGHT as u16 });
    render(&mut scene, picture)?;
    let config = Config::for_method::<Block>(WIDTH as u16, HEIGHT as u16, DISPARITIES as u16)
        .with_filter::<Block>(Filter::Default);
    let calibration = clock.calibrate();

    // Without an interrupt: what the rows are, and how long they take.
    pipeline.start(&config)?;
    let mut direct = Direct::new(picture);
    let start = clock.now();
    pipeline.begin_frame(&mut direct)?;
    let mut y = 0;
    while let Some(row) = pipeline.next_row(&mut direct)? {
        rows.keep(y, &row);
        y += 1;
    }
    let ticks = clock.now() - start;
    // As many lines' times as a frame has, and one in eight more for the interrupt and the copies that it
    // causes.
    let line_ticks = (ticks + ticks / 8) / (HEIGHT + BLANKING) as u64;
    defmt::info!("{=u64} ticks a frame on {=str}, a line every {=u64}", ticks, BOARD.core, line_ticks);

    let picture = &*picture;
    let (producer, consumer) = queues.split(slots);
    critical_section::with(|cs| {
        if let Ok(mut sensor) = SENSOR.borrow(cs).try_borrow_mut() {
            *sensor = Some(Sensor { producer, picture, sequence: 1, row: 0 });
        }
    });
    let format = LineFormat { width: LINE as u16, height: HEIGHT as u16, pixel: PixelFormat::Grey8 };
    let lines = HandedLines::new(consumer, format, sleep).map_err(|_| Failure::Slots)?;
    let mut camera = SideBySide::<_, LINE>::new(lines).map_err(Failure::Stream)?;
    let mut ticker = Ticker::take(clock);
    ticker.every(line_ticks as u32);
    let allowed = frames(pipeline, &config, &mut camera, rows)?;
    ticker.every((line_ticks / 2) as u32);
    let twice = frames(pipeline, &config, &mut camera, rows)?;
    ticker.stop();

    let stack = stack::used();
    rows.write().map_err(Failure::Host)?;
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("ticks", ticks);
    console.figure("line_ticks", line_ticks);
    console.figure("stack_bytes", stack as u64);
    console.figure("overruns_allowed", allowed.overruns.into());
    console.figure("lost_allowed", allowed.lost.into());
    console.figure("rows_allowed", allowed.rows.into());
    console.figure("damaged_allowed", allowed.damaged.into());
    console.figure("wrong_allowed", allowed.wrong.into());
    console.figure("overruns_twice", twice.overruns.into());
    console.figure("lost_twice", twice.lost.into());
    console.figure("rows_twice", twice.rows.into());
    console.figure("damaged_twice", twice.damaged.into());
    console.figure("wrong_twice", twice.wrong.into());
    Ok(())
}

fn render(scene: &mut SceneCamera, picture: &mut Seen) -> Result<(), Failure> {
    scene.start_frame().map_err(|_| Failure::Scene)?;
    for line in &mut picture.0 {
        let (left, right) = line.split_at_mut(WIDTH);
        scene.next_lines(left, right).map_err(|_| Failure::Scene)?;
    }
    Ok(())
}

/// Frames from the interrupt, each row held to what it is without one.
fn frames<F: FnMut() -> bool>(
    pipeline: &mut Guarded<Block, WIDTH, DISPARITIES>,
    config: &Config,
    camera: &mut SideBySide<HandedLines<'static, 'static, F, LINE>, LINE>,
    rows: &Rows,
) -> Result<Told, Failure> {
    pipeline.start(config)?;
    let mut told = Told::default();
    let before = camera.source().overruns();
    for _ in 0..FRAMES {
        pipeline.begin_frame(camera)?;
        let mut y = 0;
        while let Some(row) = pipeline.next_row(camera)? {
            told.rows += 1;
            if row.flags().iter().any(|flags| flags.contains(PixelFlags::DAMAGED)) {
                told.damaged += 1;
            } else if !rows.are(y, &row) {
                told.wrong += 1;
            }
            y += 1;
        }
        told.lost += u32::from(pipeline.lost_lines());
    }
    told.overruns = camera.source().overruns() - before;
    Ok(told)
}

impl Rows {
    fn keep(&mut self, y: usize, row: &Row<'_>) {
        if let (Some(disparities), Some(flags)) = (self.disparities.get_mut(y), self.flags.get_mut(y)) {
            disparities.iter_mut().zip(row.disparities()).for_each(|(to, &from)| *to = from);
            flags.iter_mut().zip(row.flags()).for_each(|(to, &from)| *to = from);
        }
    }

    fn are(&self, y: usize, row: &Row<'_>) -> bool {
        let same = |disparities: &[Disparity; WIDTH]| disparities == row.disparities();
        let as_flagged = |flags: &[PixelFlags; WIDTH]| flags == row.flags();
        self.disparities.get(y).is_some_and(same) && self.flags.get(y).is_some_and(as_flagged)
    }

    /// Of each pixel the disparity's steps, the low byte first, and the flags.
    fn write(&self) -> Result<(), HostError> {
        let file = HostFile::create(c"interrupt.bin")?;
        for (disparities, flags) in self.disparities.iter().zip(&self.flags) {
            let mut bytes = [[0; 3]; WIDTH];
            for ((bytes, disparity), flags) in bytes.iter_mut().zip(disparities).zip(flags) {
                let [low, high] = disparity.raw().to_le_bytes();
                *bytes = [low, high, flags.bits()];
            }
            file.write(bytes.as_flattened())?;
        }
        Ok(())
    }
}
