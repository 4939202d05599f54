//! A band of rows on each core: its memory, and lines of both cameras in a queue. It knows no hardware: a
//! test runs it under the chip's memory map in an emulator.

use stereopsis::camera::{
    FrameStart, LineFormat, LineListener, LineNotifier, LineProducer, LineSignal, LineSlots, LineStart,
    PixelFormat, PolledLines, SideBySide,
};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::matching::{Block, Config};
use stereopsis::pipeline::{Band, Guarded};

/// Columns of a rectified image, px.
pub const WIDTH: u16 = 160;
/// Rows of a frame, px.
pub const HEIGHT: u16 = 120;
const DISPARITIES: u16 = 32;
/// A line of both cameras.
const LINE: usize = 2 * WIDTH as usize;
/// Slots: lines come in half of a frame's time and are matched in all of it.
const SLOTS: usize = 64;
/// Focal length px, baseline m, principal point px: those of your calibration.
const RIG: (f32, f32, f32, f32) = (170.0, 0.05, 79.5, 59.5);
/// The pipeline of a band.
pub type Bands = Guarded<Block, { WIDTH as usize }, { DISPARITIES as usize }>;
/// Both cameras.
pub type Cameras = SideBySide<PolledLines<'static, 'static, LINE>, LINE>;

/// What a core works in.
pub struct Memory {
    slots: [[u8; LINE]; SLOTS],
    queues: LineSlots<'static, LINE, { SLOTS + 1 }>,
    signal: LineSignal,
    pipeline: Bands,
}

impl Memory {
    /// Memory that nobody works in.
    pub const fn new() -> Self {
        Self {
            slots: [[0; LINE]; SLOTS],
            queues: LineSlots::new(),
            signal: LineSignal::new(),
            pipeline: Guarded::new(),
        }
    }
}

/// The capture's end: where it hands lines on to a core.
pub struct Destination {
    band: Band,
    producer: LineProducer<'static, 'static, LINE>,
    notifier: LineNotifier<'static>,
}

impl Destination {
    /// Hands a line on, if the core's band takes it; without a slot it is lost, which the core sees.
    pub fn hand_on(&mut self, frame: FrameStart, start: LineStart, write: impl FnOnce(&mut [u8; LINE])) {
        let lines = self.band.lines();
        if lines.contains(&start.row)
            && let Some(mut line) = self.producer.begin()
        {
            write(line.bytes());
            let row = start.row - lines.start;
            self.producer.finish(line, frame, LineStart { row, ..start });
            self.notifier.notify();
        }
    }
}

/// A core's end: its band.
pub struct Matching {
    /// Which core.
    pub core: usize,
    /// Its rows of the frame.
    pub band: Band,
    /// What finds them.
    pub pipeline: &'static mut Bands,
    /// The lines that the capture has handed on.
    pub cameras: Cameras,
    /// What tells of them.
    pub lines: LineListener<'static>,
    /// From disparities to depths.
    pub scale: DepthScale,
}

/// The bands of a frame for two cores, of equally many lines.
pub fn bands() -> impl Iterator<Item = (usize, Band)> {
    Band::split::<Block>(&whole(), 2).enumerate()
}

/// The configuration of a frame in one band.
fn whole() -> Config {
    Config::for_method::<Block>(WIDTH, HEIGHT, DISPARITIES)
}

/// Starts a band in its memory.
pub fn start((core, band): (usize, Band), memory: &'static mut Memory) -> (Matching, Destination) {
    let Memory { slots, queues, signal, pipeline } = memory;
    let config = band.config(&whole());
    pipeline.start(&config).expect("a band has fewer lines than the frame");
    let (producer, consumer) = queues.split(slots);
    let (notifier, lines) = signal.split();
    let format = LineFormat { width: LINE as u16, height: config.height, pixel: PixelFormat::Grey8 };
    let both = PolledLines::new(consumer, format).expect("a slot holds a line");
    let cameras = SideBySide::new(both).expect("a line has two halves");
    let (focal_px, baseline_m, u, v) = RIG;
    let rig = RectifiedRig::new(focal_px, baseline_m, u, v).expect("a rig");
    let scale = DepthScale::new(&rig).expect("depths");
    let destination = Destination { band: band.clone(), producer, notifier };
    (Matching { core, band, pipeline, cameras, lines, scale }, destination)
}
