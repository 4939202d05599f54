//! Seeded frames with every fault at several rates.
//!
//! `STEREOPSIS_FAULT_FRAMES=10000` makes it 10 000 frames of each fault at each rate, instead of a share.

use super::changing::{Changing, HEIGHT, Kept, WIDTH, config, frames, reference};
use stereopsis::camera::{
    CameraError, CameraPair, ErrorType, FrameStart, LineFormat, LineSource, LineStart, StereoSource,
};
use stereopsis::imaging::Noise;
use stereopsis::matching::{Block, Config, ConfigError, Fast, Method, Sgm};
use stereopsis::pipeline::{FaultCounters, Guarded, Pipeline, PipelineError};
use stereopsis::units::PixelFlags;
use stereopsis_host::fault::{Fault, Faulty, Record};

pub const RATES: [f64; 4] = [0.001, 0.01, 0.05, 0.2];

/// What the record says of the counters.
fn expect(counters: &mut FaultCounters, record: &Record, begun: bool) {
    let count = |fault| record.count(fault);
    counters.frames_skipped += record.skipped;
    match record.frame {
        Some(Fault::FrameStale) => counters.frames_stale += 1,
        Some(Fault::FrameTimesOut | Fault::FrameFails) => counters.frames_failed += 1,
        _ => {}
    }
    counters.lines_dropped += count(Fault::LineDropped) + count(Fault::LinePassedOver);
    counters.lines_repeated += record.repeated;
    counters.lines_torn += count(Fault::LineTorn);
    counters.lines_late += count(Fault::LineLate);
    counters.lines_stale += count(Fault::LineStale);
    counters.lines_failed += count(Fault::Bus) + count(Fault::BusBefore);
    counters.lines_timed_out += count(Fault::TimesOut) + count(Fault::Dead);
    counters.lines_short += count(Fault::FrameShort);
    counters.syncs_lost += u32::from(record.ended.is_some());
    if !begun {
        return;
    }
    counters.frames += 1;
    match record {
        Record { ended: Some((row, _)), lost, .. } => {
            counters.frames_broken += 1;
            counters.lines += u32::from(*row) - lost.len() as u32;
        }
        Record { lost, .. } if lost.is_empty() => counters.frames_whole += 1,
        _ => counters.frames_damaged += 1,
    }
    if record.ended.is_none() {
        counters.lines += u32::from(HEIGHT) - record.lost.len() as u32;
    }
}

/// Frames of `faults` at a rate: every row that is not flagged is right, those flagged are those that the
/// record names, the counters are the record's, and a frame without a fault is whole.
fn guarded<S: Method>(
    faults: &[Fault],
    rate: f64,
    frames: usize,
    reference: &[Vec<Kept>; 2],
) -> FaultCounters {
    guarded_by::<S>(&config::<S>(), faults, rate, frames, reference)
}

/// The same by another configuration.
pub fn guarded_by<S: Method>(
    config: &Config,
    faults: &[Fault],
    rate: f64,
    frames: usize,
    reference: &[Vec<Kept>; 2],
) -> FaultCounters {
    let mut source = Faulty::new(Changing::new(), faults, rate, 7 + frames as u64);
    let mut guarded = Box::new(Guarded::<S, 32, 16>::new());
    guarded.start(config).expect("the configuration fits");
    let latency = Pipeline::<S, 32, 16>::LATENCY;
    let window = S::RADIUS_Y + 2;
    let reach_down = guarded.reach_down();
    let mut expected = FaultCounters::default();
    for _ in 0..frames {
        let begun = guarded.begin_frame(&mut source);
        let frame = source.record().frame;
        match &begun {
            Err(PipelineError::StaleFrame { .. }) => assert_eq!(frame, Some(Fault::FrameStale)),
            Err(PipelineError::Camera(CameraError::TimedOut)) => {
                assert_eq!(frame, Some(Fault::FrameTimesOut))
            }
            Err(e) => assert_eq!(frame, Some(Fault::FrameFails), "{e}"),
            Ok(_) => assert!(frame.is_none_or(|fault| fault == Fault::FrameSkipped)),
        }
        let mut rows: Vec<Kept> = Vec::new();
        let mut failed = begun.is_err();
        if begun.is_ok() {
            loop {
                match guarded.next_row(&mut source) {
                    Ok(Some(row)) => {
                        assert_eq!(usize::from(row.index()), rows.len());
                        rows.push(row.into());
                    }
                    Ok(None) => break,
                    Err(_) => {
                        failed = true;
                        break;
                    }
                }
            }
            assert!(matches!(guarded.next_row(&mut source), Ok(None)), "the frame is over");
        }
        let record = source.record();
        assert_eq!(failed, record.ended.is_some() || begun.is_err(), "{record:?}");
        assert!(failed || rows.len() == usize::from(HEIGHT));
        let right = &reference[source.inner().frames as usize % 2];
        let lost: Vec<usize> = record.lost.iter().map(|(row, _)| usize::from(*row)).collect();
        for (y, (row, right)) in rows.iter().zip(right).enumerate() {
            let reaches = |&line: &usize| y + latency >= line && y <= line.saturating_add(reach_down);
            let is_damaged = row.flags[0].contains(PixelFlags::DAMAGED);
            assert!(row.flags.iter().all(|flags| flags.contains(PixelFlags::DAMAGED) == is_damaged));
            assert_eq!(is_damaged, lost.iter().any(reaches), "row {y}: {record:?}");
            if !is_damaged {
                assert_eq!(row, right, "row {y} is not flagged: {record:?}");
            }
            if lost.iter().any(|line| line.abs_diff(y) <= window) {
                assert!(row.disparities.iter().all(|d| d.is_none()), "{} row {y}: {record:?}", S::NAME);
                assert!(
                    row.confidences.iter().all(|c| *c == 0),
                    "{} row {y}: {:?}",
                    S::NAME,
                    row.confidences
                );
            }
            expected.rows += 1;
            expected.rows_damaged += u32::from(is_damaged);
        }
        expect(&mut expected, record, begun.is_ok());
        assert_eq!(guarded.counters(), &expected, "{record:?}");
    }
    expected
}

#[test]
fn every_fault_at_every_rate_is_counted_and_what_it_touches_is_flagged() {
    let (fast, block, sgm) = (reference::<Fast>(), reference::<Block>(), reference::<Sgm>());
    for fault in Fault::ALL {
        let mut seen = FaultCounters::default();
        for rate in RATES {
            let counters = guarded::<Fast>(&[fault], rate, frames(250), &fast);
            seen.frames_whole += counters.frames_whole;
            seen.frames_broken += counters.frames_broken + counters.frames_damaged + counters.lines_repeated;
            seen.frames_failed += counters.frames_failed + counters.frames_stale + counters.frames_skipped;
        }
        assert!(seen.frames_whole > 100, "{}: some frames had no fault", fault.name());
        assert!(seen.frames_broken + seen.frames_failed > 30, "{} happened", fault.name());
    }
    for rate in RATES {
        guarded::<Block>(&Fault::ALL, rate, frames(400), &block);
        guarded::<Sgm>(&Fault::ALL, rate, frames(200), &sgm);
    }
}

/// A pipeline that knows nothing of faults gives right rows until the first one, an error there, and the next
/// frame.
#[test]
fn a_pipeline_gives_right_rows_until_the_first_fault_and_then_an_error() {
    let reference = reference::<Fast>();
    let mut pipeline = Box::new(Pipeline::<Fast, 32, 16>::new());
    pipeline.start(&config::<Fast>()).expect("the configuration fits");
    // All but what only time stamps and frame numbers tell, which a `Guarded` looks at.
    let told = |fault: &Fault| !fault.is_of_frames() && *fault != Fault::LineStale;
    let faults: Vec<_> = Fault::ALL.into_iter().filter(told).collect();
    for rate in RATES {
        let mut source = Faulty::new(Changing::new(), &faults, rate, 3);
        for _ in 0..frames(600) {
            pipeline.begin_frame(&mut source).expect("no fault is of frames");
            let mut rows = Vec::<Kept>::new();
            let error = loop {
                match pipeline.next_row(&mut source) {
                    Ok(Some(row)) => rows.push(row.into()),
                    Ok(None) => break None,
                    Err(e) => break Some(e),
                }
            };
            let record = source.record();
            let has_fault = record.repeated > 0 || !record.lost.is_empty() || record.ended.is_some();
            assert_eq!(error.is_some(), has_fault, "{record:?}");
            assert!(has_fault || rows.len() == usize::from(HEIGHT));
            assert_eq!(rows[..], reference[source.inner().frames as usize % 2][..rows.len()]);
        }
    }
}

/// One camera of the pair.
struct OneSide(Changing, bool);

impl ErrorType for OneSide {
    type Error = core::convert::Infallible;
}

impl LineSource for OneSide {
    fn format(&self) -> LineFormat {
        self.0.format()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.0.start_frame()
    }

    fn next_line(&mut self, line: &mut [u8]) -> Result<LineStart, CameraError<Self::Error>> {
        let mut other = [0; WIDTH as usize];
        if self.1 { self.0.next_lines(&mut other, line) } else { self.0.next_lines(line, &mut other) }
    }
}

/// Two cameras that fail each for itself: what comes out without a flag is right all the same.
#[test]
fn two_cameras_that_fail_each_for_itself_give_no_wrong_row_without_a_flag() {
    let reference = reference::<Fast>();
    let mut guarded = Box::new(Guarded::<Fast, 32, 16>::new());
    for rate in RATES {
        let (mut whole, mut flagged, mut right) = (0, 0, 0);
        guarded.start(&config::<Fast>()).expect("the configuration fits");
        let side = |is_right, seed| Faulty::new(OneSide(Changing::new(), is_right), &Fault::ALL, rate, seed);
        let mut source = CameraPair::new(side(false, 11), side(true, 12), 5).expect("the formats are equal");
        for _ in 0..frames(600) {
            let Ok(start) = guarded.begin_frame(&mut source) else { continue };
            let expected = &reference[start.sequence as usize % 2];
            let mut y = 0;
            while let Ok(Some(row)) = guarded.next_row(&mut source) {
                let row = Kept::from(row);
                if row.flags[0].contains(PixelFlags::DAMAGED) {
                    flagged += 1;
                } else {
                    assert_eq!(row, expected[y], "{rate} row {y} of {start:?}");
                    right += 1;
                }
                y += 1;
            }
            whole += usize::from(guarded.lost_lines() == 0 && y == usize::from(HEIGHT));
        }
        assert!(flagged > 0 && right > 0 && (whole > 0 || rate > 0.1), "{rate}: {whole} {flagged} {right}");
    }
}

#[test]
fn a_limit_on_lost_lines_ends_the_frame_with_what_was_lost() {
    let mut guarded = Box::new(Guarded::<Fast, 32, 16>::new());
    guarded.start(&config::<Fast>()).expect("the configuration fits");
    guarded.set_most_lost(3);
    let mut source = Faulty::new(Changing::new(), &[Fault::Dead], 1.0, 1);
    guarded.begin_frame(&mut source).expect("the frame begins");
    let error = guarded.next_row(&mut source).err();
    assert!(matches!(error, Some(PipelineError::Camera(CameraError::TimedOut))), "{error:?}");
    assert_eq!((source.record().lost.len(), guarded.counters().lines_timed_out), (4, 4));
    assert_eq!((guarded.lost_lines(), guarded.counters().frames_broken), (3, 1));
}

#[test]
fn another_configuration_leaves_the_counters() {
    let mut source = Faulty::new(Changing::new(), &[Fault::LineDropped], 0.05, 4);
    let mut guarded = Box::new(Guarded::<Block, 32, 16>::new());
    let told = config::<Block>();
    guarded.start(&told).expect("the configuration fits");
    guarded.begin_frame(&mut source).expect("a frame");
    while guarded.next_row(&mut source).expect("lines are lost, no frame").is_some() {}
    let first = *guarded.counters();
    assert!(first.lines_dropped > 0 && first.frames == 1, "{first:?}");

    // In a frame that is under way, which goes on when the configuration is refused.
    guarded.begin_frame(&mut source).expect("a frame");
    guarded.next_row(&mut source).expect("a row");
    assert_eq!(
        guarded.restart(&Config { width: 33, ..told }),
        Err(ConfigError::Width { given: 33, most: 32 })
    );
    assert!(guarded.next_row(&mut source).is_ok_and(|row| row.is_some_and(|row| row.index() == 1)));
    let noisy = Config { noise: Noise::High, ..told };
    guarded.restart(&noisy).expect("the configuration fits");
    assert!(guarded.next_row(&mut source).is_ok_and(|row| row.is_none()), "the frame is over");
    assert_eq!((guarded.config(), guarded.counters().frames_broken), (&noisy, 1));

    let mut clean = Changing::new();
    guarded.begin_frame(&mut clean).expect("a frame");
    let mut plain = Box::new(Pipeline::<Block, 32, 16>::new());
    plain.start(&noisy).expect("the configuration fits");
    let mut other = Changing::new();
    plain.begin_frame(&mut other).expect("a frame");
    while let Some(row) = plain.next_row(&mut other).expect("no fault") {
        assert_eq!(guarded.next_row(&mut clean).expect("no fault").map(Kept::from), Some(row.into()));
    }
    assert!(guarded.next_row(&mut clean).is_ok_and(|row| row.is_none()));
    let after = *guarded.counters();
    // Its number is of before: that camera began anew.
    assert_eq!((after.frames, after.restarts, after.frames_whole), (3, 1, 1));
    assert!(after.lines_dropped >= first.lines_dropped && after.rows > first.rows);
}
