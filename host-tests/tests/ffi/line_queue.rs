//! Lines handed over by the functions for C: those of `LineSlots` in Rust, and whole between two threads.

use super::*;
use std::sync::atomic::{AtomicBool, Ordering};
use stereopsis::camera::{FrameStart, LineSlots, LineStart};
use stereopsis::ffi::{CLine, LineQueueHandle, line_queue_bytes};
use stereopsis_host::scene::Random;

const NO_LINE: CLine = CLine { bytes: null(), timestamp_us: 0, frame: 0, overruns: 0, row: 0 };

/// A queue of `slots` lines in memory that outlives it.
fn queue(memory: &mut Vec<u64>, line_bytes: usize, slots: usize) -> *mut LineQueueHandle {
    let length = line_queue_bytes(line_bytes, slots);
    *memory = vec![0xA5A5_A5A5_A5A5_A5A5; length.div_ceil(8)];
    let mut handle = null_mut();
    // SAFETY: as many bytes are there.
    let status = unsafe {
        stereopsis_line_queue_init(memory.as_mut_ptr().cast(), length, line_bytes, &raw mut handle)
    };
    assert_eq!(status, Status::Ok);
    handle
}

/// Fills the next slot; whether there was one.
fn give(handle: *mut LineQueueHandle, content: &[u8], frame: u32, row: u16) -> bool {
    let mut bytes = null_mut();
    // SAFETY: the queue is there, and its lines are as long as the content.
    unsafe {
        let status = stereopsis_line_queue_begin(handle, &raw mut bytes);
        if status == Status::NoSlot {
            return false;
        }
        assert_eq!(status, Status::Ok);
        slice::from_raw_parts_mut(bytes, content.len()).copy_from_slice(content);
        assert_eq!(stereopsis_line_queue_finish(handle, frame, row, row.into()), Status::Ok);
    }
    true
}

/// The next line and its first bytes.
fn take(handle: *mut LineQueueHandle, bytes: usize) -> Option<(CLine, Vec<u8>)> {
    let mut line = NO_LINE;
    // SAFETY: the queue is there, and lines have as many bytes.
    unsafe {
        match stereopsis_line_queue_next(handle, &raw mut line) {
            Status::NoLineYet => return None,
            status => assert_eq!(status, Status::Ok),
        }
        let content = slice::from_raw_parts(line.bytes, bytes).to_vec();
        assert_eq!(stereopsis_line_queue_done(handle), Status::Ok);
        Some((line, content))
    }
}

/// Null is written to the place of a handle: never into the memory that is refused.
#[test]
fn a_place_inside_of_memory_that_will_not_do_is_an_overlap() {
    let mut memory = vec![0xA5A5_A5A5_A5A5_A5A5_u64; 16];
    let before = memory.clone();
    let start = memory.as_mut_ptr();
    for (length, line_bytes) in [(16, 7), (128, 0), (128, 65_536), (128, 60_000)] {
        // SAFETY: the memory has these bytes, and the place is in it.
        let status =
            unsafe { stereopsis_line_queue_init(start.cast(), length, line_bytes, start.add(1).cast()) };
        assert_eq!(status, Status::Overlap, "{length} {line_bytes}");
    }
    assert!(memory == before);
}

#[test]
fn lines_are_those_of_the_slots_in_rust() {
    let mut random = Random::new(11);
    let mut memory = Vec::new();
    // Four lines wait in five slots here, and in four there.
    let handle = queue(&mut memory, 7, 5);
    let mut bytes = [[0; 7]; 4];
    let mut slots = LineSlots::<7, 5>::new();
    let (mut producer, mut consumer) = slots.split(&mut bytes);
    let (mut lost, mut came) = (0, 0);
    for step in 0..4000_u32 {
        // Now the interrupt is ahead, now the program.
        if random.below(100) < if step / 100 % 2 == 0 { 70 } else { 30 } {
            let content: [u8; 7] = std::array::from_fn(|_| random.byte());
            let (sequence, row) = (step / 64, step as u16 % 64);
            let given = give(handle, &content, sequence, row);
            let slot = producer.begin();
            assert_eq!(given, slot.is_some(), "step {step}");
            lost += u32::from(!given);
            if let Some(mut slot) = slot {
                *slot.bytes() = content;
                let start = LineStart { row, timestamp_us: row.into() };
                producer.finish(slot, FrameStart { sequence, ..FrameStart::default() }, start);
            }
        } else {
            let (found, expected) = (take(handle, 7), consumer.next());
            assert_eq!(found.is_some(), expected.is_some(), "step {step}");
            if let (Some((line, content)), Some(expected)) = (found, expected) {
                assert_eq!(content, expected.bytes());
                let start = LineStart { row: line.row, timestamp_us: line.timestamp_us };
                assert_eq!((start, line.frame), (expected.start(), expected.frame().sequence));
                assert_eq!(line.overruns, expected.overruns());
                consumer.done(expected);
                came += 1;
            }
        }
    }
    let mut overruns = 0;
    // SAFETY: the queue is there.
    assert_eq!(unsafe { stereopsis_line_queue_overruns(handle, &raw mut overruns) }, Status::Ok);
    assert!(overruns == lost && lost > 100 && came > 1000, "{lost} lost, {came} came");
}

#[test]
fn lines_between_two_threads_are_whole_and_in_order() {
    const LINES: u32 = 20_000;
    struct Shared(*mut LineQueueHandle);
    // SAFETY: one thread calls the interrupt's functions, the other one the program's.
    unsafe impl Sync for Shared {}
    let mut memory = Vec::new();
    let shared = Shared(queue(&mut memory, 64, 4));
    let (shared, is_over) = (&shared, &AtomicBool::new(false));
    let (given, taken) = std::thread::scope(|scope| {
        let giver = scope.spawn(move || {
            let given = (0..LINES).filter(|n| {
                // Every fiftieth line waits for room, so that lines are taken however the threads are run.
                let tries = if n % 50 == 0 { 1_000_000 } else { 1 };
                (0..tries).any(|_| {
                    let given = give(shared.0, &[*n as u8; 64], *n, *n as u16);
                    if !given {
                        std::thread::yield_now();
                    }
                    given
                })
            });
            let given = given.count();
            is_over.store(true, Ordering::Release);
            given
        });
        let (mut taken, mut last) = (0, None);
        loop {
            let ended = is_over.load(Ordering::Acquire);
            match take(shared.0, 64) {
                Some((line, content)) => {
                    assert!(content.iter().all(|byte| *byte == line.frame as u8), "a torn line");
                    assert!(last < Some(line.frame) && line.row == line.frame as u16, "out of order");
                    (taken, last) = (taken + 1, Some(line.frame));
                }
                None if ended => break,
                None => std::thread::yield_now(),
            }
        }
        (giver.join().expect("it does not panic"), taken)
    });
    assert!(given == taken && taken > 100, "{given} given, {taken} taken");
}
