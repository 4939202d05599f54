//! Lines through slots: every interleaving of the two sides, two threads, and the camera at the matcher's
//! end.

use std::collections::VecDeque;
use stereopsis::camera::{
    CameraError, EmptyLine, FilledLine, FrameStart, HandedLines, LineConsumer, LineFormat, LineProducer,
    LineSlots, LineSource, LineStart, PixelFormat,
};

const BYTES: usize = 4;

/// What the interrupt does, a step at a time: it begins a line, fills its halves, finishes it.
#[derive(Default)]
struct Filling<'b> {
    line: Option<EmptyLine<'b, BYTES>>,
    step: usize,
    produced: u16,
    lost: u32,
}

impl<'b> Filling<'b> {
    fn step(&mut self, producer: &mut LineProducer<'_, 'b, BYTES>) {
        let value = self.produced as u8 + 1;
        match (self.step, &mut self.line) {
            (0, _) => {
                self.line = producer.begin();
                self.lost += u32::from(self.line.is_none());
            }
            (1, Some(line)) => line.bytes()[..BYTES / 2].fill(value),
            (2, Some(line)) => line.bytes()[BYTES / 2..].fill(value),
            (3, line) => {
                if let Some(line) = line.take() {
                    let start = LineStart { row: self.produced, timestamp_us: u64::from(value) };
                    producer.finish(line, FrameStart::default(), start);
                }
                self.produced += 1;
            }
            _ => {}
        }
        self.step = (self.step + 1) % 4;
    }
}

/// What the matcher does, a step at a time: it takes a line, reads its halves, gives it back.
#[derive(Default)]
struct Reading<'b> {
    line: Option<FilledLine<'b, BYTES>>,
    step: usize,
    rows: Vec<u16>,
    overruns: u32,
}

impl<'b> Reading<'b> {
    fn step(&mut self, consumer: &mut LineConsumer<'_, 'b, BYTES>) {
        if self.line.is_none() {
            self.line = consumer.next();
            self.step = 0;
            return;
        }
        let Some(line) = &self.line else { return };
        let value = line.start().row as u8 + 1;
        match self.step {
            0 => assert_eq!(line.bytes()[..BYTES / 2], [value; BYTES / 2], "half a line"),
            1 => assert_eq!(line.bytes()[BYTES / 2..], [value; BYTES / 2], "half a line"),
            _ => {
                self.rows.push(line.start().row);
                self.overruns = line.overruns();
                if let Some(line) = self.line.take() {
                    consumer.done(line);
                }
            }
        }
        self.step += 1;
    }
}

/// One schedule: bit `i` says whose step the `i`th is. Then both run to their ends.
fn run<const N: usize>(schedule: u32, steps: u32) -> (usize, u32) {
    let mut bytes = [[0; BYTES]; 4];
    let mut slots = LineSlots::<BYTES, N>::new();
    let (mut producer, mut consumer) = slots.split(&mut bytes);
    let (mut filling, mut reading) = (Filling::default(), Reading::default());
    for i in 0..steps {
        if schedule >> i & 1 == 0 { filling.step(&mut producer) } else { reading.step(&mut consumer) }
    }
    while filling.step != 0 {
        filling.step(&mut producer);
    }
    for _ in 0..8 * N + 8 {
        reading.step(&mut consumer);
    }
    assert!(reading.line.is_none());
    assert!(reading.rows.is_sorted_by(|a, b| a < b), "each line once, in order: {:?}", reading.rows);
    assert_eq!(producer.overruns(), filling.lost);
    assert_eq!(
        reading.rows.len() + filling.lost as usize,
        usize::from(filling.produced),
        "none is lost untold"
    );
    // What is told with a line is what was lost before it.
    if let Some(&last) = reading.rows.last() {
        assert_eq!(u32::from(last) + 1 - reading.rows.len() as u32, reading.overruns);
    }
    // All slots are back.
    let mut free = VecDeque::new();
    while let Some(line) = producer.begin() {
        free.push_back(line);
    }
    assert_eq!(free.len(), N - 1, "no slot is lost");
    (reading.rows.len(), filling.lost)
}

#[test]
fn every_interleaving_gives_each_line_once_whole_and_in_order_or_counts_it() {
    const STEPS: u32 = 16;
    let (mut most_read, mut most_lost) = (0, 0);
    for schedule in 0..1 << STEPS {
        let two = run::<2>(schedule, STEPS);
        let three = run::<3>(schedule, STEPS);
        assert!(three.1 <= two.1, "another slot loses no more");
        (most_read, most_lost) = (most_read.max(three.0), most_lost.max(two.1));
    }
    assert!(most_read >= 2 && most_lost >= 3, "{most_read} {most_lost}");
}

#[test]
fn two_threads_lose_no_line_that_is_not_counted() {
    const LINES: u16 = 20_000;
    let mut bytes = [[0; 64]; 7];
    let mut slots = LineSlots::<64, 8>::new();
    let (mut producer, mut consumer) = slots.split(&mut bytes);
    let over = std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            for row in 0..LINES {
                if let Some(mut line) = producer.begin() {
                    line.bytes().fill(row as u8);
                    producer.finish(line, FrameStart::default(), LineStart { row, timestamp_us: 0 });
                }
                if row % 16 == 0 {
                    std::thread::yield_now();
                }
            }
            over.store(true, std::sync::atomic::Ordering::Release);
        });
        let (mut read, mut newest) = (0, None);
        loop {
            let was_over = over.load(std::sync::atomic::Ordering::Acquire);
            let Some(line) = consumer.next() else {
                if was_over {
                    break;
                }
                std::thread::yield_now();
                continue;
            };
            let row = line.start().row;
            assert!(newest.is_none_or(|newest| row > newest));
            assert_eq!(line.bytes(), &[row as u8; 64]);
            (read, newest) = (read + 1, Some(row));
            assert_eq!(u32::from(row) + 1, read + line.overruns());
            consumer.done(line);
        }
        assert!(read > 0);
    });
    assert!(producer.overruns() < u32::from(LINES));
}

const FORMAT: LineFormat = LineFormat { width: 4, height: 3, pixel: PixelFormat::Grey8 };

fn frame(sequence: u32) -> FrameStart {
    FrameStart { sequence, timestamp_us: u64::from(sequence) * 100, exposure_us: 0 }
}

fn send(producer: &mut LineProducer<'_, '_, BYTES>, sequence: u32, row: u16) {
    if let Some(mut line) = producer.begin() {
        line.bytes().fill(10 * sequence as u8 + row as u8);
        let timestamp_us = u64::from(sequence) * 100 + u64::from(row);
        producer.finish(line, frame(sequence), LineStart { row, timestamp_us });
    }
}

#[test]
fn handed_lines_are_a_camera_that_reports_what_it_lost() {
    let mut bytes = [[0; BYTES]; 8];
    let mut slots = LineSlots::<BYTES, 9>::new();
    let (mut producer, consumer) = slots.split(&mut bytes);
    // Frame 1 whole, frame 2 without row 1, frame 3 short: what the interrupt sends while the camera waits.
    let mut to_come =
        VecDeque::from([(1, 0), (1, 1), (1, 2), (2, 0), (2, 2), (3, 0), (3, 1), (4, 0), (4, 1), (4, 2)]);
    let mut waits = 0;
    let wait = || {
        waits += 1;
        let next = to_come.pop_front();
        if let Some((sequence, row)) = next {
            send(&mut producer, sequence, row);
        }
        next.is_some()
    };
    let mut camera = HandedLines::new(consumer, FORMAT, wait).expect("a slot holds a line");
    let mut line = [0; 6];
    assert_eq!(camera.next_line(&mut line), Err(CameraError::NoLineLeft), "no frame was started");
    assert_eq!(camera.start_frame(), Ok(frame(1)));
    assert_eq!(camera.next_line(&mut line[..3]), Err(CameraError::BufferTooShort { needed: 4 }));
    for row in 0..3 {
        assert_eq!(camera.next_line(&mut line).map(|start| start.row), Ok(row));
        assert_eq!(line, [10 + row as u8, 10 + row as u8, 10 + row as u8, 10 + row as u8, 0, 0]);
    }
    assert_eq!(camera.next_line(&mut line), Err(CameraError::NoLineLeft));
    assert_eq!(camera.start_frame(), Ok(frame(2)));
    assert_eq!([0, 1].map(|_| camera.next_line(&mut line).map(|start| start.row)), [Ok(0), Ok(2)]);
    assert_eq!(camera.next_line(&mut line), Err(CameraError::NoLineLeft));
    assert_eq!(camera.start_frame(), Ok(frame(3)));
    assert_eq!([0, 1].map(|_| camera.next_line(&mut line).map(|start| start.row)), [Ok(0), Ok(1)]);
    assert_eq!(camera.next_line(&mut line), Err(CameraError::NoLineLeft), "the frame was short");
    assert_eq!(camera.start_frame(), Ok(frame(4)), "the line that told is the next frame's");
    assert_eq!(camera.next_line(&mut line).map(|start| start.row), Ok(0));
    assert_eq!(camera.start_frame(), Err(CameraError::TimedOut), "the rest of frame 4, and then nothing");
    assert_eq!(camera.overruns(), 0);
}

#[test]
fn frames_that_nobody_counts_are_told_apart_by_their_times() {
    let mut bytes = [[0; BYTES]; 8];
    let mut slots = LineSlots::<BYTES, 9>::new();
    let (mut producer, consumer) = slots.split(&mut bytes);
    // Frames 1 and 3 whole, frame 2 without its last row.
    let frame = |number: u64| FrameStart { sequence: 0, timestamp_us: 1000 * number, exposure_us: 0 };
    let mut to_come = VecDeque::from([(1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (3, 0), (3, 1), (3, 2)]);
    let wait = || {
        let Some((number, row)) = to_come.pop_front() else { return false };
        let Some(line) = producer.begin() else { return false };
        let timestamp_us = 1000 * number + u64::from(row);
        producer.finish(line, frame(number), LineStart { row, timestamp_us });
        true
    };
    let mut camera = HandedLines::new(consumer, FORMAT, wait).expect("a slot holds a line");
    for (number, height) in [(1, 3), (2, 2), (3, 3)] {
        assert_eq!(camera.start_frame(), Ok(frame(number)));
        let rows = [0; 3].map(|_| camera.next_line(&mut [0; BYTES]).map(|start| start.row).ok());
        assert_eq!(rows, [Some(0), Some(1), Some(2).filter(|_| height == 3)], "frame {number}");
    }
    assert_eq!(camera.start_frame(), Err(CameraError::TimedOut));
}

#[test]
fn lines_longer_than_a_slot_are_refused() {
    let mut bytes = [[0; BYTES]; 2];
    let mut slots = LineSlots::<BYTES, 3>::new();
    let (_, consumer) = slots.split(&mut bytes);
    let refused = HandedLines::new(consumer, LineFormat { width: 5, ..FORMAT }, || false).err();
    assert_eq!(refused, Some(CameraError::BufferTooShort { needed: 5 }));
}

#[test]
fn a_line_that_comes_while_the_time_ends_has_come() {
    let mut bytes = [[0; BYTES]; 4];
    let mut slots = LineSlots::<BYTES, 5>::new();
    let (mut producer, consumer) = slots.split(&mut bytes);
    let mut rows = 0..2;
    let wait = || {
        rows.next().into_iter().for_each(|row| send(&mut producer, 1, row));
        false
    };
    let mut camera = HandedLines::new(consumer, FORMAT, wait).expect("a slot holds a line");
    assert_eq!(camera.start_frame(), Ok(frame(1)));
    let rows = [(); 3].map(|()| camera.next_line(&mut [0; BYTES]).map(|start| start.row));
    assert_eq!(rows, [Ok(0), Ok(1), Err(CameraError::TimedOut)]);
}
