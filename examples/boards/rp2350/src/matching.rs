//! A band of rows on each core: lines from the capture, the pipeline, the nearest distance.

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_time::{Duration, with_timeout};
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
/// A frame that takes longer has stopped.
const NO_FRAME: Duration = Duration::from_millis(200);

/// What a core has of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Which core.
    pub core: usize,
    /// The frame.
    pub sequence: u32,
    /// The nearest answer of the band, millimetres; `u16::MAX` without one.
    pub nearest_mm: u16,
    /// Lines that were replaced.
    pub lost_lines: u16,
}

/// What the cores have seen.
pub static SEEN: Channel<CriticalSectionRawMutex, Seen, 4> = Channel::new();

type Bands = Guarded<Block, { WIDTH as usize }, { DISPARITIES as usize }>;
type Cameras = SideBySide<PolledLines<'static, 'static, LINE>, LINE>;

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
    core: usize,
    band: Band,
    pipeline: &'static mut Bands,
    cameras: Cameras,
    lines: LineListener<'static>,
    scale: DepthScale,
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

/// Matches a band, frame by frame.
#[embassy_executor::task(pool_size = 2)]
pub async fn run(matching: Matching) -> ! {
    let Matching { core, band, pipeline, mut cameras, mut lines, scale } = matching;
    loop {
        let begun = with_timeout(NO_FRAME, pipeline.begin_frame_async(&mut cameras, &mut lines)).await;
        let Ok(Ok(frame)) = begun else { continue };
        let mut nearest_mm = u16::MAX;
        // A dead camera and a broken frame end it; what was seen by then is told.
        while let Ok(Ok(Some(row))) =
            with_timeout(NO_FRAME, pipeline.next_row_async(&mut cameras, &mut lines)).await
        {
            // The rows of the overlap are the other core's.
            if band.row(row.index()).is_some() {
                let depths = row.disparities().iter().map(|&d| scale.millimetres(d).0);
                nearest_mm = depths.filter(|&mm| mm > 0).fold(nearest_mm, u16::min); // 0 is no answer.
            }
        }
        let lost_lines = pipeline.lost_lines();
        SEEN.send(Seen { core, sequence: frame.sequence, nearest_mm, lost_lines }).await;
    }
}
