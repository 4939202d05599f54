//! Lines out of the halves of a circular DMA buffer, and into slots.

use stereopsis::camera::{FrameStart, Half, LineFault, LineSlots, LineStart, PingPong};

const BYTES: usize = 4;

#[test]
fn halves_tell_lost_interrupts_and_torn_lines() {
    let mut ping_pong = PingPong::new();
    let mut line = [0; 4];
    assert_eq!(ping_pong.take(Half::First, &[1; 4], &mut line, || Half::Second), Ok(0));
    assert_eq!(line, [1; 4]);
    assert_eq!(ping_pong.take(Half::Second, &[2; 4], &mut line, || Half::First), Ok(0));
    assert_eq!(ping_pong.take(Half::First, &[3; 4], &mut line, || Half::First), Err(LineFault::Torn));
    // The interrupt of the second half was lost.
    assert_eq!(ping_pong.take(Half::First, &[5; 4], &mut line, || Half::Second), Ok(1));
    assert_eq!((ping_pong.missed(), ping_pong.torn(), line), (1, 1, [5; 4]));
    // An interrupt is lost and the next one is late: the line after these two tells of the first.
    assert_eq!(ping_pong.take(Half::First, &[7; 4], &mut line, || Half::First), Err(LineFault::Torn));
    assert_eq!(ping_pong.take(Half::Second, &[8; 4], &mut line, || Half::First), Ok(1));
    assert_eq!(ping_pong.take(Half::First, &[9; 4], &mut line, || Half::Second), Ok(0));
    assert_eq!((ping_pong.missed(), ping_pong.torn()), (2, 2));
    ping_pong.restart();
    assert_eq!(ping_pong.take(Half::First, &[6; 4], &mut line, || Half::Second), Ok(0));
    assert_eq!(Half::Second.other().other(), Half::Second);
}

#[test]
fn the_slot_of_a_torn_line_is_the_next_lines() {
    let mut bytes = [[0; BYTES]; 4];
    let mut slots = LineSlots::<BYTES, 5>::new();
    let (mut producer, mut consumer) = slots.split(&mut bytes);
    let (mut ping_pong, mut due, mut rows) = (PingPong::new(), Half::First, Vec::new());
    // As many lines in a row are torn as there are slots, twice.
    for row in 0..20_u16 {
        let (done, is_torn) = (due, row % 10 < 4);
        due = due.other();
        let mut line = producer.begin().expect("the program frees every slot");
        match ping_pong
            .take(done, &[row as u8; BYTES], line.bytes(), || if is_torn { done } else { done.other() })
        {
            Ok(missed) => {
                assert_eq!(missed, 0);
                producer.finish(line, FrameStart::default(), LineStart { row, timestamp_us: 0 });
            }
            Err(fault) => {
                assert_eq!(fault, LineFault::Torn);
                producer.give_back(line);
            }
        }
        if let Some(line) = consumer.next() {
            assert_eq!(line.bytes(), &[row as u8; BYTES]);
            rows.push(line.start().row);
            consumer.done(line);
        }
    }
    assert!(rows.iter().copied().eq((4..10).chain(14..20)), "{rows:?}");
    assert_eq!((ping_pong.torn(), producer.overruns()), (8, 0));
    // All slots are there, the one that was given back last too.
    let line = producer.begin().expect("four are free");
    producer.give_back(line);
    let lines = [(); 5].map(|()| producer.begin());
    assert_eq!(lines.map(|line| line.is_some()), [true, true, true, true, false]);
}
