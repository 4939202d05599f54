//! Frame numbers, row numbers and time stamps that a source makes up: what a guarded pipeline takes each for.

use super::changing::{HEIGHT, Kept, WIDTH, config};
use std::collections::VecDeque;
use std::convert::Infallible;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource,
};
use stereopsis::matching::Fast;
use stereopsis::pipeline::{FaultCounters, Guarded, PipelineError};
use stereopsis::units::PixelFlags;

/// Frames and lines with these numbers; each line shows its own.
struct Numbered {
    frames: VecDeque<FrameStart>,
    lines: VecDeque<LineStart>,
}

impl Numbered {
    /// Frames of a number and a time, whose lines do not matter.
    fn of_frames(frames: &[(u32, u64)]) -> Self {
        let start = |&(sequence, timestamp_us)| FrameStart { sequence, timestamp_us, exposure_us: 0 };
        Self { frames: frames.iter().map(start).collect(), lines: VecDeque::new() }
    }

    /// A frame that began at 1000 us, with lines of a row and a time.
    fn of_lines(lines: impl IntoIterator<Item = (u16, u64)>) -> Self {
        let line = |(row, timestamp_us)| LineStart { row, timestamp_us };
        Self { lines: lines.into_iter().map(line).collect(), ..Self::of_frames(&[(1, 1000)]) }
    }
}

impl ErrorType for Numbered {
    type Error = Infallible;
}

impl StereoSource for Numbered {
    fn format(&self) -> LineFormat {
        LineFormat { width: WIDTH, height: HEIGHT, pixel: PixelFormat::Grey8 }
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.frames.pop_front().ok_or(CameraError::TimedOut)
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        let line = self.lines.pop_front().ok_or(CameraError::NoLineLeft)?;
        for (u, (left, right)) in left.iter_mut().zip(right).enumerate() {
            let grey = |u: usize| (((u * 64 + usize::from(line.row)) * 0x9e37) >> 4) as u8;
            (*left, *right) = (grey(u), grey(u + 3));
        }
        Ok(line)
    }
}

type Guard = Guarded<Fast, 32, 16>;

fn started() -> Box<Guard> {
    let mut guarded = Box::new(Guard::new());
    guarded.start(&config::<Fast>()).expect("the configuration fits");
    guarded
}

/// The rows of a frame up to its end or an error, and the counters.
fn frame(
    guarded: &mut Guard,
    mut source: Numbered,
) -> (Vec<Kept>, Option<PipelineError<Infallible>>, FaultCounters) {
    guarded.begin_frame(&mut source).expect("the frame begins");
    let mut rows = Vec::new();
    let error = loop {
        match guarded.next_row(&mut source) {
            Ok(Some(row)) => rows.push(row.into()),
            Ok(None) => break None,
            Err(e) => break Some(e),
        }
    };
    (rows, error, *guarded.counters())
}

/// A line of every row, a microsecond after the other.
fn in_order() -> Vec<(u16, u64)> {
    (0..HEIGHT).map(|row| (row, 1001 + u64::from(row))).collect()
}

#[test]
fn a_frame_is_the_one_before_by_its_number_or_by_its_time() {
    for (before, after, is_repeated) in [
        ((7, 100), (7, 100), true),
        ((7, 100), (7, 200), true),
        ((7, 0), (7, 0), true),
        ((7, 100), (8, 100), false),
        // Without numbers the time decides, and without either nothing is known.
        ((0, 100), (0, 100), true),
        ((0, 100), (0, 200), false),
        ((0, 0), (0, 0), false),
    ] {
        let (mut guarded, mut source) = (started(), Numbered::of_frames(&[before, after]));
        guarded.begin_frame(&mut source).expect("the first frame");
        let second = guarded.begin_frame(&mut source);
        assert_eq!(
            matches!(second, Err(PipelineError::StaleFrame { .. })),
            is_repeated,
            "{before:?} {after:?}"
        );
        let counters = guarded.counters();
        assert_eq!(
            [counters.frames_stale, counters.frames],
            [u32::from(is_repeated), 2 - u32::from(is_repeated)]
        );
    }
}

#[test]
fn gaps_of_frame_numbers_are_skipped_frames_and_steps_back_are_restarts() {
    for (before, after, [skipped, restarts]) in [
        (1, 2, [0, 0]),
        (1, 3, [1, 0]),
        (1, 9, [7, 0]),
        (u32::MAX, 0, [0, 0]),
        (u32::MAX - 1, 2, [3, 0]),
        (9, 8, [0, 1]),
        (9, 1, [0, 1]),
    ] {
        let (mut guarded, mut source) = (started(), Numbered::of_frames(&[(before, 0), (after, 0)]));
        for _ in 0..2 {
            guarded.begin_frame(&mut source).expect("another frame");
        }
        let counters = guarded.counters();
        assert_eq!([counters.frames_skipped, counters.restarts], [skipped, restarts], "{before} {after}");
    }
}

#[test]
fn rows_that_come_again_are_ignored_and_those_of_another_frame_end_it() {
    let (expected, error, _) = frame(&mut started(), Numbered::of_lines(in_order()));
    assert!(error.is_none() && expected.len() == usize::from(HEIGHT));
    for again in [0, 11, HEIGHT - 1] {
        let mut lines = in_order();
        lines.insert(usize::from(again) + 1, (again, 5000));
        let (rows, error, counters) = frame(&mut started(), Numbered::of_lines(lines));
        assert!(error.is_none() && rows == expected, "{again}: {error:?}");
        // Behind the last line nothing is read.
        assert_eq!((counters.lines_repeated, counters.lines_stale), (u32::from(again + 1 < HEIGHT), 0));
    }
    for (at, given) in [(12, 10), (12, 0), (12, HEIGHT), (2, 0), (29, HEIGHT + 3)] {
        let mut lines = in_order();
        lines.insert(usize::from(at), (given, 5000));
        let (rows, error, counters) = frame(&mut started(), Numbered::of_lines(lines));
        assert_eq!(error, Some(PipelineError::RowOrder { expected: at, given }));
        assert_eq!((counters.syncs_lost, counters.frames_broken, counters.lines_repeated), (1, 1, 0));
        assert_eq!(rows[..], expected[..rows.len()]);
    }
}

#[test]
fn skipped_rows_are_those_of_the_line_below_and_so_many_may_be_lost() {
    for passed in 1..=4_u16 {
        let mut lines = in_order();
        lines.drain(8..8 + usize::from(passed));
        let mut guarded = started();
        guarded.set_most_lost(3);
        let (rows, error, counters) = frame(&mut guarded, Numbered::of_lines(lines));
        assert_eq!(counters.lines_dropped, u32::from(passed));
        if passed > 3 {
            assert_eq!(error, Some(PipelineError::RowOrder { expected: 8, given: 8 + passed }));
            assert_eq!(guarded.lost_lines(), 0);
            continue;
        }
        assert!(error.is_none() && rows.len() == usize::from(HEIGHT), "{passed}: {error:?}");
        assert_eq!((guarded.lost_lines(), counters.lines), (passed, u32::from(HEIGHT - passed)));
        let flagged = rows.iter().filter(|row| row.flags[0].contains(PixelFlags::DAMAGED)).count();
        assert!(flagged > usize::from(passed) && flagged < rows.len(), "{flagged}");
    }
}

#[test]
fn a_line_is_stale_before_the_newest_time_of_its_frame() {
    // A time of 0 is none, and one that was is no older.
    for (time, is_stale) in [(999, true), (1008, true), (1009, false), (0, false)] {
        let mut lines = in_order();
        lines[9].1 = time;
        let (rows, error, counters) = frame(&mut started(), Numbered::of_lines(lines));
        assert!(error.is_none() && rows.len() == usize::from(HEIGHT), "{time}: {error:?}");
        assert_eq!(counters.lines_stale, u32::from(is_stale), "{time}");
        assert_eq!(counters.lines, u32::from(HEIGHT) - u32::from(is_stale), "{time}");
    }
    // The frame's own time is the first.
    let mut lines = in_order();
    (lines[0].1, lines[1].1) = (999, 1000);
    let (_, error, counters) = frame(&mut started(), Numbered::of_lines(lines));
    assert_eq!((error, counters.lines_stale), (None, 1));
}

#[test]
fn a_stale_line_below_skipped_ones_is_lost_with_them() {
    // Three stale lines one by one: the line above replaces them all.
    let mut lines = in_order();
    lines[8..11].iter_mut().for_each(|line| line.1 = 1003);
    let (expected, _, _) = frame(&mut started(), Numbered::of_lines(lines));
    let mut lines = in_order();
    lines.drain(8..10);
    lines[8].1 = 1003;
    let mut guarded = started();
    let (rows, error, counters) = frame(&mut guarded, Numbered::of_lines(lines.clone()));
    assert_eq!((error, guarded.lost_lines()), (None, 3));
    assert_eq!((counters.lines_dropped, counters.lines_stale, counters.frames_broken), (2, 1, 0));
    assert_eq!(counters.lines, u32::from(HEIGHT) - 3);
    assert!(rows == expected);
    // All three count.
    for most in [2, 3] {
        let mut guarded = started();
        guarded.set_most_lost(most);
        let (_, error, _) = frame(&mut guarded, Numbered::of_lines(lines.clone()));
        let refused = PipelineError::RowOrder { expected: 8, given: 10 };
        assert_eq!(error, Some(refused).filter(|_| most < 3));
    }
}
