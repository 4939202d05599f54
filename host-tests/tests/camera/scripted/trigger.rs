//! The common trigger pin.

use super::{Camera, LineFault, SMALL, pair, small};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType as PinErrorType, OutputPin};
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::delay::{CheckedDelay, NoopDelay, Transaction as DelayTransaction};
use embedded_hal_mock::eh1::digital::{Mock as PinMock, State, Transaction as PinTransaction};
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::convert::Infallible;
use std::rc::Rc;
use stereopsis::camera::{
    CameraError, CameraPair, ErrorType, FrameStart, LineFormat, LineSource, LineStart, PairError,
    StereoSource, TriggerError, Triggered,
};
use stereopsis_host::scene::{Scene, SceneCamera};

#[test]
fn every_frame_has_one_pulse_of_the_length_asked_for() {
    let mut pin = PinMock::new(&[
        PinTransaction::set(State::High),
        PinTransaction::set(State::Low),
        PinTransaction::set(State::High),
        PinTransaction::set(State::Low),
    ]);
    let mut delay = CheckedDelay::new(&[DelayTransaction::delay_us(250), DelayTransaction::delay_us(250)]);
    let mut triggered = Triggered::new(pair(small(0), small(50)), pin.clone(), delay.clone(), 250);
    assert_eq!((triggered.format(), triggered.max_row_skew_us()), (SMALL, 5));
    for sequence in 0..2 {
        assert_eq!(triggered.start_frame().expect("all works").sequence, sequence);
        let (mut left, mut right) = ([0; 4], [0; 4]);
        for row in 0..3 {
            assert_eq!(triggered.next_lines(&mut left, &mut right).expect("all works").row, row);
        }
        assert_eq!((left, right), ([8, 9, 10, 11], [58, 59, 60, 61]));
    }
    pin.done();
    delay.done();
}

#[test]
fn a_pin_that_fails_starts_no_frame() {
    let fault = MockError::Io(std::io::ErrorKind::NotConnected);
    let stuck = [
        vec![PinTransaction::set(State::High).with_error(fault.clone())],
        vec![PinTransaction::set(State::High), PinTransaction::set(State::Low).with_error(fault.clone())],
    ];
    for transactions in stuck {
        let mut pin = PinMock::new(&transactions);
        let mut triggered = Triggered::new(pair(small(0), small(50)), pin.clone(), NoopDelay::new(), 10);
        let error = triggered.start_frame().expect_err("the pin fails");
        assert_eq!(error, CameraError::Hardware(TriggerError::Pin(fault.clone())));
        let (source, ..) = triggered.release();
        let (left, right) = source.release();
        assert_eq!((left.starts, right.starts), (0, 0));
        pin.done();
    }
}

#[test]
fn errors_of_the_source_come_through_the_trigger() {
    let mut pin = PinMock::new(&[PinTransaction::set(State::High), PinTransaction::set(State::Low)]);
    let source = pair(Camera { fault: Some(0), ..small(0) }, small(50));
    let mut triggered = Triggered::new(source, pin.clone(), NoopDelay::new(), 10);
    triggered.start_frame().expect("the frame starts");
    let error = triggered.next_lines(&mut [0; 4], &mut [0; 4]).expect_err("line 0 fails");
    assert_eq!(error, CameraError::Hardware(TriggerError::Source(PairError::Left(LineFault(0)))));
    assert_eq!(
        triggered.next_lines(&mut [0; 1], &mut [0; 4]),
        Err(CameraError::BufferTooShort { needed: 4 }),
        "what is no hardware's error stays what it is"
    );
    pin.done();
}

/// Who did what, in order.
type Log = Rc<RefCell<Vec<&'static str>>>;

struct LoggedPin(Log);

impl PinErrorType for LoggedPin {
    type Error = Infallible;
}

impl OutputPin for LoggedPin {
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().push("high");
        Ok(())
    }

    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().push("low");
        Ok(())
    }
}

struct LoggedDelay(Log);

impl DelayNs for LoggedDelay {
    fn delay_ns(&mut self, _ns: u32) {
        self.0.borrow_mut().push("wait");
    }
}

struct LoggedSource(Log, SceneCamera);

impl ErrorType for LoggedSource {
    type Error = Infallible;
}

impl StereoSource for LoggedSource {
    fn format(&self) -> LineFormat {
        self.1.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.0.borrow_mut().push("frame");
        self.1.start_frame()
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        self.1.next_lines(left, right)
    }
}

#[test]
fn the_pulse_is_over_before_the_frame_is_waited_for() {
    let log = Log::default();
    let source = LoggedSource(log.clone(), Scene::small(8, 6).camera());
    let mut triggered = Triggered::new(source, LoggedPin(log.clone()), LoggedDelay(log.clone()), 3);
    triggered.start_frame().expect("nothing can fail");
    assert_eq!(*log.borrow(), ["high", "wait", "low", "frame"]);
}

/// A sensor on the trigger pin. Its frames wait until they are asked for.
struct Pulsed<'a> {
    pulses: &'a Cell<u32>,
    /// Pulses that there were when it was asked last.
    seen: u32,
    /// Pulses of which it makes no frame.
    misses: std::ops::Range<u32>,
    /// Whether its numbers are those of its own frames, or of the pulses.
    counts_frames: bool,
    frames: u32,
    waiting: VecDeque<FrameStart>,
    pulse: u32,
}

impl ErrorType for Pulsed<'_> {
    type Error = Infallible;
}

impl LineSource for Pulsed<'_> {
    fn format(&self) -> LineFormat {
        LineFormat { height: 1, ..SMALL }
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        while self.seen < self.pulses.get() {
            self.seen += 1;
            if !self.misses.contains(&self.seen) {
                self.frames += 1;
                let sequence = if self.counts_frames { self.frames } else { self.seen };
                let timestamp_us = u64::from(self.seen) * 1000;
                self.waiting.push_back(FrameStart { sequence, timestamp_us, exposure_us: 0 });
            }
        }
        let frame = self.waiting.pop_front().ok_or(CameraError::TimedOut)?;
        self.pulse = (frame.timestamp_us / 1000) as u32;
        Ok(frame)
    }

    fn next_line(&mut self, _line: &mut [u8]) -> Result<LineStart, CameraError<Infallible>> {
        Ok(LineStart { row: 0, timestamp_us: u64::from(self.pulse) * 1000 + 7 })
    }
}

struct Counted<'a>(&'a Cell<u32>);

impl PinErrorType for Counted<'_> {
    type Error = Infallible;
}

impl OutputPin for Counted<'_> {
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.set(self.0.get() + 1);
        Ok(())
    }

    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

#[test]
fn a_sensor_that_misses_pulses_is_paired_again() {
    // Which pulses each misses, what its numbers are of, and which frames fail.
    let table = [
        (3..4, 9..9, true, vec![3, 4]),
        (9..9, 3..4, true, vec![3, 4]),
        (3..5, 9..9, true, vec![3, 4, 5]),
        (3..5, 4..6, true, vec![3, 4, 5]),
        (3..4, 8..9, true, vec![3, 4, 8, 9]),
        (1..2, 9..9, true, vec![1, 2]),
        // Numbers of pulses need nothing.
        (3..4, 9..9, false, vec![3]),
        (9..9, 3..5, false, vec![3, 4]),
    ];
    for (left, right, counts_frames, expected) in table {
        let pulses = Cell::new(0);
        let camera = |misses| Pulsed {
            pulses: &pulses,
            seen: 0,
            misses,
            counts_frames,
            frames: 0,
            waiting: VecDeque::new(),
            pulse: 0,
        };
        let words = format!("{left:?} {right:?} {counts_frames}");
        let source = CameraPair::new(camera(left), camera(right), 5).expect("the formats are equal");
        let mut triggered = Triggered::new(source, Counted(&pulses), NoopDelay::new(), 10);
        let mut failed = Vec::new();
        for pulse in 1..=14_u32 {
            match triggered.start_frame() {
                Ok(_) => {
                    let line = triggered.next_lines(&mut [0; 4], &mut [0; 4]);
                    let timestamp_us = u64::from(pulse) * 1000 + 7;
                    assert_eq!(line, Ok(LineStart { row: 0, timestamp_us }), "{words}");
                }
                Err(error) => {
                    assert_eq!(error, CameraError::TimedOut, "{words}");
                    failed.push(pulse);
                }
            }
        }
        assert_eq!(failed, expected, "{words}");
    }
}
