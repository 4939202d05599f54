//! Rows that a task awaits are those of a caller that blocks: with a source that pauses anywhere, and with
//! lines of another thread.

use super::changing::{Changing, HEIGHT, Kept, WIDTH, config, reference};
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::task::{Context, Poll, Wake, Waker};
use std::thread::{self, Thread};
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineListener, LineNotifier, LineSignal, LineSlots,
    LineStart, PixelFormat, PolledLines, SideBySide, StereoSource,
};
use stereopsis::imaging::BalancedPair;
use stereopsis::matching::{Block, Method, Sgm};
use stereopsis::pipeline::{Guarded, Pipeline, PipelineError};
use stereopsis_host::fault::{Fault, Faulty};

/// The executor: one task, polled when it is woken.
struct Executor {
    thread: Thread,
    polls: AtomicUsize,
}

impl Wake for Executor {
    fn wake(self: Arc<Self>) {
        self.thread.unpark();
    }
}

/// Runs a task to its end, and says how often it was polled.
fn block_on<T>(task: impl Future<Output = T>) -> (T, usize) {
    let executor = Arc::new(Executor { thread: thread::current(), polls: AtomicUsize::new(0) });
    let waker = Waker::from(executor.clone());
    let mut task = pin!(task);
    loop {
        executor.polls.fetch_add(1, Ordering::Relaxed);
        if let Poll::Ready(done) = task.as_mut().poll(&mut Context::from_waker(&waker)) {
            return (done, executor.polls.load(Ordering::Relaxed));
        }
        thread::park();
    }
}

/// A source that has nothing yet so often before each frame and line; then the interrupt brings it.
struct Reluctant<'a, S> {
    source: S,
    notifier: LineNotifier<'a>,
    pauses: usize,
    left: usize,
}

impl<'a, S> Reluctant<'a, S> {
    fn new(source: S, notifier: LineNotifier<'a>, pauses: usize) -> Self {
        Self { source, notifier, pauses, left: pauses }
    }

    fn pause<E>(&mut self) -> Result<(), CameraError<E>> {
        match self.left.checked_sub(1) {
            Some(left) => {
                self.left = left;
                self.notifier.notify();
                Err(CameraError::WouldBlock)
            }
            None => {
                self.left = self.pauses;
                Ok(())
            }
        }
    }
}

impl<S: ErrorType> ErrorType for Reluctant<'_, S> {
    type Error = S::Error;
}

impl<S: StereoSource> StereoSource for Reluctant<'_, S> {
    fn format(&self) -> LineFormat {
        self.source.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.source.max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<S::Error>> {
        self.pause()?;
        self.source.start_frame()
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<S::Error>> {
        self.pause()?;
        self.source.next_lines(left, right)
    }
}

async fn rows<S: Method, C: StereoSource>(
    pipeline: &mut Pipeline<S, 32, 16>,
    camera: &mut C,
    lines: &mut LineListener<'_>,
) -> Vec<Kept> {
    pipeline.begin_frame_async(camera, lines).await.expect("a frame");
    let mut rows = Vec::new();
    while let Some(row) = pipeline.next_row_async(camera, lines).await.expect("a row") {
        rows.push(row.into());
    }
    rows
}

fn awaited_rows_are_the_same<S: Method>() {
    let [even, odd] = reference::<S>();
    for pauses in [0, 1, 2, 3] {
        let mut signal = LineSignal::new();
        let (notifier, mut lines) = signal.split();
        let mut camera = Reluctant::new(Changing::new(), notifier, pauses);
        let mut pipeline = Box::new(Pipeline::<S, 32, 16>::new());
        pipeline.start(&config::<S>()).expect("the configuration fits");
        for expected in [&odd, &even] {
            let (rows, polls) = block_on(rows(&mut pipeline, &mut camera, &mut lines));
            assert!(rows == *expected, "{pauses} pauses");
            // A poll asks twice, the second time after the waker is in place: at most so many.
            let waits = (usize::from(HEIGHT) + 1) * pauses;
            assert!(polls <= waits + 1, "{pauses} pauses: {polls} polls");
            assert!(pauses < 2 || polls > usize::from(HEIGHT), "{pauses} pauses: {polls} polls");
        }
    }
}

#[test]
fn awaited_rows_are_those_of_a_caller_that_blocks() {
    awaited_rows_are_the_same::<Block>();
    awaited_rows_are_the_same::<Sgm>();
}

/// As a time-out around it does: every future is dropped where it has to wait.
#[test]
fn a_future_that_is_dropped_loses_no_row() {
    let mut signal = LineSignal::new();
    let (notifier, mut lines) = signal.split();
    let mut camera = Reluctant::new(Changing::new(), notifier, 3);
    let mut pipeline = Box::new(Pipeline::<Block, 32, 16>::new());
    pipeline.start(&config::<Block>()).expect("the configuration fits");
    let mut context = Context::from_waker(Waker::noop());
    let mut dropped = 0;
    while pin!(pipeline.begin_frame_async(&mut camera, &mut lines)).poll(&mut context).is_pending() {
        dropped += 1;
    }
    let mut rows = Vec::<Kept>::new();
    loop {
        match pin!(pipeline.next_row_async(&mut camera, &mut lines)).poll(&mut context) {
            Poll::Pending => dropped += 1,
            Poll::Ready(row) => match row.expect("a row") {
                Some(row) => rows.push(row.into()),
                None => break,
            },
        }
    }
    assert!(rows == reference::<Block>()[1]);
    assert!(dropped > usize::from(HEIGHT), "{dropped}");
}

/// Faults by seed: what blocks and what is awaited see the same ones, count them alike, and give the same
/// rows.
#[test]
fn a_guarded_pipeline_counts_the_same_faults() {
    let faults = [
        Fault::LineDropped,
        Fault::LinePassedOver,
        Fault::LineRepeated,
        Fault::LineTorn,
        Fault::LineStale,
        Fault::Bus,
        Fault::BusBefore,
        Fault::FrameShort,
        Fault::SyncLost,
    ];
    let source = || Faulty::new(Changing::new(), &faults, 0.04, 5);
    let start = || {
        let mut pipeline = Box::new(Guarded::<Block, 32, 16>::new());
        pipeline.start(&config::<Block>()).expect("the configuration fits");
        pipeline
    };
    let (mut blocking, mut camera, mut expected) = (start(), source(), Vec::new());
    for _ in 0..40 {
        let mut rows = Vec::<Kept>::new();
        let begun = blocking.begin_frame(&mut camera).map_err(|e| e.to_string());
        while let Ok(Some(row)) = blocking.next_row(&mut camera) {
            rows.push(row.into());
        }
        expected.push((begun, rows));
    }
    let mut signal = LineSignal::new();
    let (notifier, mut lines) = signal.split();
    let (mut awaited, mut camera) = (start(), Reluctant::new(source(), notifier, 2));
    for (begun, rows) in expected {
        let task = async {
            let begun = awaited.begin_frame_async(&mut camera, &mut lines).await.map_err(|e| e.to_string());
            let mut rows = Vec::<Kept>::new();
            while let Ok(Some(row)) = awaited.next_row_async(&mut camera, &mut lines).await {
                rows.push(row.into());
            }
            (begun, rows)
        };
        assert!(block_on(task).0 == (begun, rows));
    }
    assert_eq!(awaited.counters(), blocking.counters());
    let counted = blocking.counters();
    let kinds = [
        counted.lines_dropped,
        counted.lines_stale,
        counted.lines_repeated,
        counted.lines_short,
        counted.frames_broken,
    ];
    assert!(kinds.iter().all(|&count| count > 0), "{counted:?}");
}

/// Without an executor: the call is repeated, and the frame goes on.
#[test]
fn a_call_that_would_block_is_repeated() {
    let mut signal = LineSignal::new();
    let (notifier, _listener) = signal.split();
    let mut camera = BalancedPair::new(Reluctant::new(Changing::new(), notifier, 1));
    let mut pipeline = Box::new(Pipeline::<Block, 32, 16>::new());
    pipeline.start(&config::<Block>()).expect("the configuration fits");
    let would_block = Err(PipelineError::Camera(CameraError::WouldBlock));
    assert_eq!(pipeline.begin_frame(&mut camera).map(|_| ()), would_block);
    assert_eq!(pipeline.begin_frame(&mut camera).map(|_| ()), Ok(()));
    let (mut rows, mut waits) = (Vec::<Kept>::new(), 0);
    loop {
        match pipeline.next_row(&mut camera) {
            Err(PipelineError::Camera(CameraError::WouldBlock)) => waits += 1,
            Ok(Some(row)) => rows.push(row.into()),
            Ok(None) => break,
            Err(e) => panic!("{e}"),
        }
    }
    assert!(rows == reference::<Block>()[1]);
    assert_eq!(waits, usize::from(HEIGHT));
}

/// Lines of both cameras, from a thread that sleeps as it likes, through slots: the whole way of a product.
#[test]
fn lines_of_another_thread_wake_the_task() {
    const LINE: usize = 2 * WIDTH as usize;
    let [even, odd] = reference::<Block>();
    let mut bytes = [[0; LINE]; 4];
    let (mut slots, mut signal) = (LineSlots::<LINE, 5>::new(), LineSignal::new());
    let (mut producer, consumer) = slots.split(&mut bytes);
    let (mut notifier, mut lines) = signal.split();
    let format = LineFormat { width: LINE as u16, height: HEIGHT, pixel: PixelFormat::Grey8 };
    let both = PolledLines::new(consumer, format).expect("a slot holds a line");
    let mut camera = SideBySide::<_, LINE>::new(both).expect("two cameras");
    let mut pipeline = Box::new(Pipeline::<Block, 32, 16>::new());
    pipeline.start(&config::<Block>()).expect("the configuration fits");
    let frames = 30;
    thread::scope(|scope| {
        scope.spawn(move || {
            let mut seen = Changing::new();
            for _ in 0..frames {
                let frame = seen.start_frame().expect("a frame");
                for _ in 0..HEIGHT {
                    // This sensor waits where a real one would lose the line.
                    let mut line = loop {
                        match producer.begin() {
                            Some(line) => break line,
                            None => thread::yield_now(),
                        }
                    };
                    let (left, right) = line.bytes().split_at_mut(WIDTH.into());
                    let start = seen.next_lines(left, right).expect("a line");
                    producer.finish(line, frame, start);
                    notifier.notify();
                }
            }
        });
        for frame in 1..=frames {
            let expected = if frame % 2 == 0 { &even } else { &odd };
            assert!(block_on(rows(&mut pipeline, &mut camera, &mut lines)).0 == *expected, "frame {frame}");
        }
    });
}
