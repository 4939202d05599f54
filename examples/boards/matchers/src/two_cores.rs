//! A band of the frame's rows on each of two cores.

use crate::{Cameras, LINE, Parts, Rows};
use stereopsis::camera::{FrameStart, LineListener, LineNotifier, LineProducer, LineStart};
use stereopsis::depth::DepthScale;
use stereopsis::matching::Block;
use stereopsis::pipeline::Band;

/// Slots: lines come in half of a frame's time and are matched in all of it.
const SLOTS: usize = 64;

/// What a core works in.
pub type Memory = crate::Memory<SLOTS, { SLOTS + 1 }>;

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
    pub rows: &'static mut Rows,
    /// The lines that the capture has handed on.
    pub cameras: Cameras,
    /// What tells of them.
    pub lines: LineListener<'static>,
    /// From disparities to depths.
    pub scale: DepthScale,
}

/// The bands of a frame for two cores, of equally many lines.
pub fn bands() -> impl Iterator<Item = (usize, Band)> {
    Band::split::<Block>(&crate::config(), 2).enumerate()
}

/// Starts a band in its memory.
pub fn start((core, band): (usize, Band), memory: &'static mut Memory) -> (Matching, Destination) {
    let Parts { rows, cameras, lines, producer, notifier } = memory.start(&band.config(&crate::config()));
    let destination = Destination { band: band.clone(), producer, notifier };
    (Matching { core, band, rows, cameras, lines, scale: crate::depth_scale() }, destination)
}
