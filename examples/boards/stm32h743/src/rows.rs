//! The memory of the matcher, and lines of both cameras in a queue. It knows no hardware: a test runs it
//! under the chip's memory map in an emulator.

use stereopsis::camera::{
    LineFormat, LineListener, LineNotifier, LineProducer, LineSignal, LineSlots, PixelFormat, PolledLines,
    SideBySide,
};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::matching::{Block, Config};
use stereopsis::pipeline::Guarded;

/// Columns of an image, px.
pub const WIDTH: u16 = 160;
/// Rows of a frame, px.
pub const HEIGHT: u16 = 120;
const DISPARITIES: u16 = 32;
/// A line of both cameras.
pub const LINE: usize = 2 * WIDTH as usize;
/// Slots: the last rows of a frame come out together, and take as long as so many lines.
const SLOTS: usize = 16;
/// Focal length px, baseline m, principal point px: those of your calibration.
const RIG: (f32, f32, f32, f32) = (170.0, 0.05, 79.5, 59.5);
/// The pipeline.
pub type Rows = Guarded<Block, { WIDTH as usize }, { DISPARITIES as usize }>;
/// Both cameras.
pub type Cameras = SideBySide<PolledLines<'static, 'static, LINE>, LINE>;

/// What the matcher works in.
pub struct Memory {
    slots: [[u8; LINE]; SLOTS],
    queues: LineSlots<'static, LINE, { SLOTS + 1 }>,
    signal: LineSignal,
    rows: Rows,
}

impl Memory {
    /// Memory that nobody works in.
    pub const fn new() -> Self {
        Self {
            slots: [[0; LINE]; SLOTS],
            queues: LineSlots::new(),
            signal: LineSignal::new(),
            rows: Guarded::new(),
        }
    }
}

/// The capture's end: where it hands lines on.
pub struct Destination {
    /// Slots for lines.
    pub producer: LineProducer<'static, 'static, LINE>,
    /// What tells the task of them.
    pub notifier: LineNotifier<'static>,
}

/// The task's end.
pub struct Matching {
    /// What finds the rows.
    pub rows: &'static mut Rows,
    /// The lines that the capture has handed on.
    pub cameras: Cameras,
    /// What tells of them.
    pub lines: LineListener<'static>,
    /// From disparities to depths.
    pub scale: DepthScale,
}

/// Starts the matcher in its memory.
pub fn start(memory: &'static mut Memory) -> (Matching, Destination) {
    let Memory { slots, queues, signal, rows } = memory;
    let (producer, consumer) = queues.split(slots);
    let (notifier, lines) = signal.split();
    let format = LineFormat { width: LINE as u16, height: HEIGHT, pixel: PixelFormat::Grey8 };
    let both = PolledLines::new(consumer, format).expect("a slot holds a line");
    let cameras = SideBySide::new(both).expect("a line has two halves");
    rows.start(&Config::for_method::<Block>(WIDTH, HEIGHT, DISPARITIES)).expect("within its capacity");
    let (focal_px, baseline_m, u, v) = RIG;
    let rig = RectifiedRig::new(focal_px, baseline_m, u, v).expect("a rig");
    let scale = DepthScale::new(&rig).expect("depths");
    (Matching { rows, cameras, lines, scale }, Destination { producer, notifier })
}
