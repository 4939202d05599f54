//! Matchers of boards with a camera port: an interrupt puts lines of both cameras into a queue, a task
//! matches them. No hardware is known here: a test runs them under the chips' memory maps in an emulator.
//!
//! * [`one_core`]: the whole frame.
//! * [`two_cores`]: a band of its rows on each core.
//! * [`Decimal`]: what is said of a frame, as text.
#![no_std]

mod decimal;
pub mod one_core;
pub mod two_cores;

pub use decimal::Decimal;

use stereopsis::camera::{
    LineFormat, LineListener, LineNotifier, LineProducer, LineSignal, LineSlots, PixelFormat, PolledLines,
    SideBySide,
};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::matching::{Block, Config};
use stereopsis::pipeline::Guarded;

/// Columns of a rectified image, px.
pub const WIDTH: u16 = 160;
/// Rows of a frame, px.
pub const HEIGHT: u16 = 120;
/// Bytes of a line of both cameras.
pub const LINE: usize = 2 * WIDTH as usize;
const DISPARITIES: u16 = 32;
/// Focal length px, baseline m, principal point px: those of your calibration.
const RIG: (f32, f32, f32, f32) = (170.0, 0.05, 79.5, 59.5);

/// The pipeline, which replaces lines that are lost and flags what rests on them.
pub type Rows = Guarded<Block, { WIDTH as usize }, { DISPARITIES as usize }>;
/// Both cameras: the halves of the lines in a queue.
pub type Cameras = SideBySide<PolledLines<'static, 'static, LINE>, LINE>;

/// The configuration of a whole frame.
fn config() -> Config {
    Config::for_method::<Block>(WIDTH, HEIGHT, DISPARITIES)
}

/// What a core works in: slots for lines, one place more in the queues than there are slots, and the matcher.
pub struct Memory<const SLOTS: usize, const PLACES: usize> {
    slots: [[u8; LINE]; SLOTS],
    queues: LineSlots<'static, LINE, PLACES>,
    signal: LineSignal,
    rows: Rows,
}

/// The parts of a core's memory: the matcher with what it takes lines from, and where they are handed on.
struct Parts {
    rows: &'static mut Rows,
    cameras: Cameras,
    lines: LineListener<'static>,
    producer: LineProducer<'static, 'static, LINE>,
    notifier: LineNotifier<'static>,
}

impl<const SLOTS: usize, const PLACES: usize> Memory<SLOTS, PLACES> {
    /// Creates memory that nobody works in.
    #[expect(clippy::new_without_default, reason = "a default value of it would be made on the stack")]
    pub const fn new() -> Self {
        Self {
            slots: [[0; LINE]; SLOTS],
            queues: LineSlots::new(),
            signal: LineSignal::new(),
            rows: Rows::new(),
        }
    }

    /// Starts the matcher.
    fn start(&'static mut self, config: &Config) -> Parts {
        let Self { slots, queues, signal, rows } = self;
        rows.start(config).expect("within its capacity");
        let (producer, consumer) = queues.split(slots);
        let (notifier, lines) = signal.split();
        let format = LineFormat { width: LINE as u16, height: config.height, pixel: PixelFormat::Grey8 };
        let both = PolledLines::new(consumer, format).expect("a slot holds a line");
        let cameras = SideBySide::new(both).expect("a line has two halves");
        Parts { rows, cameras, lines, producer, notifier }
    }
}

/// From disparities to depths.
fn depth_scale() -> DepthScale {
    let (focal_px, baseline_m, u, v) = RIG;
    let rig = RectifiedRig::new(focal_px, baseline_m, u, v).expect("a rig");
    DepthScale::new(&rig).expect("depths")
}
