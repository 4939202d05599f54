//! Line hand-off from an interrupt to the matcher: a lock-free single-producer, single-consumer queue of
//! slots.

use super::queue::{Queue, Receiver, Sender};
use super::{FrameStart, LineStart};

/// Slots of `B` bytes through which lines go from one producer, an interrupt or DMA, to one consumer.
///
/// A slot is free, being filled, waiting, or being read. It is handed on by value, so that a line is read
/// once, whole, and nobody writes into it meanwhile. There is no lock; either side may interrupt the other.
///
/// ```text
///              begin              finish               next
///  free ──────────────> EmptyLine ───────> waiting ──────────> FilledLine
///    ^                     │ give_back                            │ done
///    └─────────────────────┴──────────────────────────────────────┘
/// ```
///
/// The queues of length `N` take `N - 1` slots. A slot that is dropped instead of handed on is lost.
///
/// ```
/// use stereopsis::camera::{FrameStart, LineSlots, LineStart};
/// let mut bytes = [[0; 4]; 2]; // two statics in firmware
/// let mut slots = LineSlots::<4, 3>::new();
/// let (mut producer, mut consumer) = slots.split(&mut bytes);
/// let frame = FrameStart::default();
/// for row in 0..3 {
///     // In the interrupt. The third line finds no slot.
///     let Some(mut line) = producer.begin() else { continue };
///     line.bytes().fill(row as u8);
///     producer.finish(line, frame, LineStart { row, timestamp_us: 0 });
/// }
/// assert_eq!(producer.overruns(), 1);
/// let line = consumer.next().expect("two lines wait");
/// assert_eq!((line.start().row, line.bytes()), (0, &[0; 4]));
/// consumer.done(line);
/// ```
///
/// A line that is torn is given back, and its slot serves the next one. With a circular DMA over two lines:
///
/// ```
/// use stereopsis::camera::{FrameStart, Half, LineSlots, LineStart, PingPong};
/// let mut bytes = [[0; 4]; 2]; // two statics in firmware
/// let mut slots = LineSlots::<4, 3>::new();
/// let (mut producer, mut consumer) = slots.split(&mut bytes);
/// let (mut ping_pong, frame, mut due) = (PingPong::new(), FrameStart::default(), Half::First);
/// for row in 0..6 {
///     // In the interrupt of a half. The DMA overtakes the first three copies.
///     let (done, dma) = (due, [row as u8; 4]);
///     due = due.other();
///     let Some(mut line) = producer.begin() else { continue };
///     let writing = || if row < 3 { done } else { done.other() };
///     match ping_pong.take(done, &dma, line.bytes(), writing) {
///         Ok(_) => producer.finish(line, frame, LineStart { row, timestamp_us: 0 }),
///         Err(_) => producer.give_back(line),
///     }
///     // In the program.
///     if let Some(line) = consumer.next() {
///         assert_eq!((line.start().row, line.bytes()), (row, &[row as u8; 4]));
///         consumer.done(line);
///     }
/// }
/// assert_eq!((ping_pong.torn(), producer.overruns()), (3, 0));
/// ```
#[derive(Debug)]
pub struct LineSlots<'b, const B: usize, const N: usize> {
    free: Queue<&'b mut [u8; B], N>,
    waiting: Queue<FilledLine<'b, B>, N>,
}

impl<'b, const B: usize, const N: usize> LineSlots<'b, B, N> {
    /// Creates queues without slots.
    pub const fn new() -> Self {
        Self { free: Queue::new(), waiting: Queue::new() }
    }

    /// Splits the queue into producer and consumer; the first `N - 1` of `slots` go between them.
    pub fn split<'a>(
        &'a mut self,
        slots: &'b mut [[u8; B]],
    ) -> (LineProducer<'a, 'b, B>, LineConsumer<'a, 'b, B>) {
        // What an earlier pair of ends left here goes.
        self.free.clear();
        self.waiting.clear();
        let (mut give, free) = self.free.split();
        let (fill, waiting) = self.waiting.split();
        for slot in slots {
            // What is too many stays out.
            let _ = give.send(slot);
        }
        (
            LineProducer { free, returned: None, waiting: fill, overruns: 0 },
            LineConsumer { waiting, free: give },
        )
    }
}

impl<const B: usize, const N: usize> Default for LineSlots<'_, B, N> {
    fn default() -> Self {
        Self::new()
    }
}

/// A slot that is being filled.
#[derive(Debug)]
#[must_use = "a slot that is dropped is lost"]
pub struct EmptyLine<'b, const B: usize>(&'b mut [u8; B]);

impl<const B: usize> EmptyLine<'_, B> {
    /// Returns the buffer for the line.
    pub fn bytes(&mut self) -> &mut [u8; B] {
        self.0
    }
}

/// A slot with a whole line.
#[derive(Debug)]
#[must_use = "a slot that is dropped is lost"]
pub struct FilledLine<'b, const B: usize> {
    bytes: &'b mut [u8; B],
    frame: FrameStart,
    start: LineStart,
    overruns: u32,
}

impl<const B: usize> FilledLine<'_, B> {
    /// Returns the line's bytes.
    pub fn bytes(&self) -> &[u8; B] {
        self.bytes
    }

    /// Returns the frame that the line belongs to.
    pub fn frame(&self) -> FrameStart {
        self.frame
    }

    /// Returns the line's row and time.
    pub fn start(&self) -> LineStart {
        self.start
    }

    /// Total number of lines that had found no slot when this one was finished.
    pub fn overruns(&self) -> u32 {
        self.overruns
    }
}

/// The interrupt's end of the queue.
pub struct LineProducer<'a, 'b, const B: usize> {
    free: Receiver<'a, &'b mut [u8; B]>,
    /// A slot that was given back unfinished: the next line's.
    returned: Option<&'b mut [u8; B]>,
    waiting: Sender<'a, FilledLine<'b, B>>,
    overruns: u32,
}

impl<'b, const B: usize> LineProducer<'_, 'b, B> {
    /// Takes a slot for the line that comes now; with none the line is lost, which is counted.
    pub fn begin(&mut self) -> Option<EmptyLine<'b, B>> {
        let slot = self.returned.take().or_else(|| self.free.receive()).map(EmptyLine);
        if slot.is_none() {
            self.overruns = self.overruns.saturating_add(1);
        }
        slot
    }

    /// Hands a whole line to the consumer. All lines of a frame bear the same `frame`, and those of the next
    /// one another: a source that does not count frames tells them apart by their time stamps.
    pub fn finish(&mut self, line: EmptyLine<'b, B>, frame: FrameStart, start: LineStart) {
        // There are no more slots than the queue has room for.
        let line = FilledLine { bytes: line.0, frame, start, overruns: self.overruns };
        let _ = self.waiting.send(line);
    }

    /// Takes a slot back whose line is not finished, for the line that is begun next. It keeps one slot: one
    /// that was given back before and not begun since is lost.
    pub fn give_back(&mut self, line: EmptyLine<'b, B>) {
        self.returned = Some(line.0);
    }

    /// Number of lines that found no slot.
    pub fn overruns(&self) -> u32 {
        self.overruns
    }
}

/// The matcher's end of the queue.
pub struct LineConsumer<'a, 'b, const B: usize> {
    waiting: Receiver<'a, FilledLine<'b, B>>,
    free: Sender<'a, &'b mut [u8; B]>,
}

impl<'b, const B: usize> LineConsumer<'_, 'b, B> {
    /// Takes the line that has waited longest.
    #[allow(clippy::should_implement_trait, reason = "an iterator's items need not be given back")]
    pub fn next(&mut self) -> Option<FilledLine<'b, B>> {
        self.waiting.receive()
    }

    /// Frees the slot of a line that was read.
    pub fn done(&mut self, line: FilledLine<'b, B>) {
        // There are no more slots than the queue has room for.
        let _ = self.free.send(line.bytes);
    }
}
