//! Lines through the slots of an interrupt, in any order of both sides.

use arbitrary::{Result, Unstructured};
use std::collections::VecDeque;
use stereopsis::camera::{
    CameraError, FrameStart, HandedLines, LineConsumer, LineFormat, LineProducer, LineSlots, LineSource,
    LineStart, PixelFormat,
};

const BYTES: usize = 8;
const SLOTS: usize = 3;

/// A line that was handed over.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Sent {
    byte: u8,
    sequence: u32,
    row: u16,
    overruns: u32,
}

/// Each line comes once, whole and in order, or is counted; a source of them ends.
pub fn come_once_or_are_counted(u: &mut Unstructured<'_>) -> Result<()> {
    let mut bytes = [[0; BYTES]; SLOTS];
    let mut slots = LineSlots::<BYTES, { SLOTS + 1 }>::new();
    let (mut producer, consumer) = slots.split(&mut bytes);
    if u.arbitrary()? { sides(u, &mut producer, consumer) } else { source(u, &mut producer, consumer) }
}

fn frame(sequence: u32) -> FrameStart {
    FrameStart { sequence, ..FrameStart::default() }
}

/// Hands a line over, if there is a slot.
fn hand_over(u: &mut Unstructured<'_>, producer: &mut LineProducer<'_, '_, BYTES>) -> Result<Option<Sent>> {
    let (byte, sequence, row) = (u.arbitrary()?, u.int_in_range(0..=2)?, u.int_in_range(0..=5)?);
    let before = producer.overruns();
    let Some(mut line) = producer.begin() else {
        assert_eq!(producer.overruns(), before + 1, "a line that found no slot is counted");
        return Ok(None);
    };
    line.bytes().fill(byte);
    producer.finish(line, frame(sequence), LineStart { row, timestamp_us: u64::from(byte) });
    Ok(Some(Sent { byte, sequence, row, overruns: before }))
}

fn sides<'b>(
    u: &mut Unstructured<'_>,
    producer: &mut LineProducer<'_, 'b, BYTES>,
    mut consumer: LineConsumer<'_, 'b, BYTES>,
) -> Result<()> {
    let (mut waiting, mut read, mut begun) = (VecDeque::new(), VecDeque::new(), None);
    for _ in 0..u.int_in_range(1..=60)? {
        let taken = waiting.len() + read.len() + usize::from(begun.is_some());
        match u.int_in_range(0..=4)? {
            0 if begun.is_none() => {
                begun = producer.begin();
                assert_eq!(begun.is_some(), taken < SLOTS, "a slot is free, or none is");
            }
            1 if let Some(mut line) = begun.take() => {
                let sent = Sent { byte: u.arbitrary()?, sequence: 7, row: 3, overruns: producer.overruns() };
                line.bytes().fill(sent.byte);
                producer.finish(line, frame(7), LineStart { row: 3, timestamp_us: 0 });
                waiting.push_back(sent);
            }
            2 if begun.is_none() => waiting.extend(hand_over(u, producer)?),
            3 => match (consumer.next(), waiting.pop_front()) {
                (Some(line), Some(sent)) => {
                    let Sent { byte, sequence, row, overruns } = sent;
                    assert_eq!((line.bytes(), line.frame().sequence), (&[byte; BYTES], sequence));
                    assert_eq!((line.start().row, line.overruns()), (row, overruns));
                    read.push_back(line);
                }
                (None, None) => {}
                (line, sent) => panic!("{} came where {sent:?} waited", line.is_some()),
            },
            _ => read.pop_front().into_iter().for_each(|line| consumer.done(line)),
        }
    }
    Ok(())
}

fn source<'b>(
    u: &mut Unstructured<'_>,
    producer: &mut LineProducer<'_, 'b, BYTES>,
    consumer: LineConsumer<'_, 'b, BYTES>,
) -> Result<()> {
    let format = LineFormat { width: BYTES as u16, height: 4, pixel: PixelFormat::Grey8 };
    let mut waits = 0;
    let mut given = VecDeque::new();
    let mut ended = false;
    let wait = || {
        waits += 1;
        // A line may come while the time ends.
        let sent = hand_over(u, producer);
        ended |= waits > 200 || u.is_empty() || sent.is_err();
        given.extend(sent.ok().flatten());
        !ended
    };
    let mut lines = HandedLines::new(consumer, format, wait).expect("a line fits a slot");
    let mut taken = 0;
    'frames: for _ in 0..20 {
        match lines.start_frame() {
            Ok(_) => {}
            Err(CameraError::LostSync) => continue,
            Err(_) => break,
        }
        for _ in 0..=format.height {
            let mut to = [0; BYTES];
            match lines.next_line(&mut to) {
                Ok(start) => {
                    taken += 1;
                    assert!(to.iter().all(|&byte| byte == to[0]), "a whole line");
                    assert_eq!(start.timestamp_us, u64::from(to[0]));
                }
                Err(CameraError::NoLineLeft) => continue 'frames,
                Err(_) => break 'frames,
            }
        }
    }
    assert!(taken <= given.len());
    Ok(())
}
