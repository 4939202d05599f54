//! The common trigger pin.

use super::{Camera, LineFault, SMALL, pair, small};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType as PinErrorType, OutputPin};
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::delay::{CheckedDelay, NoopDelay, Transaction as DelayTransaction};
use embedded_hal_mock::eh1::digital::{Mock as PinMock, State, Transaction as PinTransaction};
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PairError, StereoSource, TriggerError,
    Triggered,
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
