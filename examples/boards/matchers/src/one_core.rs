//! The matcher of a whole frame.

use crate::{Cameras, LINE, Parts, Rows};
use stereopsis::camera::{LineListener, LineNotifier, LineProducer};
use stereopsis::depth::DepthScale;

/// Slots: the last rows of a frame come out together, and take as long as so many lines.
const SLOTS: usize = 16;

/// What the matcher works in.
pub type Memory = crate::Memory<SLOTS, { SLOTS + 1 }>;

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
    let Parts { rows, cameras, lines, producer, notifier } = memory.start(&crate::config());
    (Matching { rows, cameras, lines, scale: crate::depth_scale() }, Destination { producer, notifier })
}
