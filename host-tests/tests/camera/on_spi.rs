//! The driver of cameras on SPI and its frame: rows are those of a pipeline that is given the same lines,
//! and a camera that fails is named.

use embedded_hal::spi::ErrorType;
use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::spi::{Operation, SpiDevice};
use spi_cameras::frames::{self, Cameras, FrameError, Rows};
use spi_cameras::mega::{CAMERA, LENGTH, Mega, MegaError, SIZE, STATE, grey_level};
use spi_cameras::simulated::{Misuse, Simulated};
use spi_cameras::text;
use std::cell::RefCell;
use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

/// The end of a task; how often it was asked.
fn asked<T>(task: impl Future<Output = T>) -> (T, usize) {
    let mut task = pin!(task);
    for count in 1..1_000_000 {
        if let Poll::Ready(value) = task.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            return (value, count);
        }
    }
    panic!("it never ends");
}

/// Time that passes at once, and is counted.
struct Passing(u32);

impl DelayNs for Passing {
    async fn delay_ns(&mut self, ns: u32) {
        self.0 += ns.div_ceil(1_000_000);
    }
}

/// What a camera sees: a texture that the right one sees 7 px farther left.
fn seen(shift: u32) -> impl FnMut(u16, &mut [u8; SIZE]) {
    move |row, line| {
        for (u, grey) in (0..).zip(line) {
            *grey = (((u + shift) * 64 + u32::from(row)).wrapping_mul(0x9e37_79b1) >> 24) as u8;
        }
    }
}

/// A camera of which one register reads other than it should.
struct Faulty<F> {
    camera: Simulated<F>,
    register: u8,
    reads: fn(u8) -> u8,
}

impl<F> ErrorType for Faulty<F> {
    type Error = Misuse;
}

impl<F: FnMut(u16, &mut [u8; SIZE])> SpiDevice for Faulty<F> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Misuse> {
        self.camera.transaction(operations).await?;
        if let [Operation::TransferInPlace([register, _, value])] = operations
            && *register == self.register
        {
            *value = (self.reads)(*value);
        }
        Ok(())
    }
}

/// A pair whose right camera has a register that reads so.
fn pair(
    register: u8,
    reads: fn(u8) -> u8,
) -> Cameras<impl SpiDevice<Error = Misuse>, impl SpiDevice<Error = Misuse>, Passing> {
    Cameras {
        left: Mega::new(Simulated::new(seen(0))),
        right: Mega::new(Faulty { camera: Simulated::new(seen(7)), register, reads }),
        delays: [Passing(0), Passing(0)],
    }
}

/// A pair without a fault.
fn sound() -> Cameras<impl SpiDevice<Error = Misuse>, impl SpiDevice<Error = Misuse>, Passing> {
    pair(STATE, |value| value)
}

fn started() -> Box<Rows> {
    let mut rows = Box::new(Rows::new());
    rows.start(&frames::config()).expect("within its capacity");
    rows
}

#[test]
fn rows_are_those_of_a_pipeline_with_the_same_lines() {
    // The grey levels that come through five, six and five bits.
    let through = |grey: u8| {
        let grey = u16::from(grey);
        grey_level(((grey >> 3) << 11 | (grey >> 2) << 5 | grey >> 3).to_be_bytes())
    };
    let lines = |shift, row| {
        let mut line = [0; SIZE];
        seen(shift)(row, &mut line);
        line.map(through)
    };
    let mut direct = started();
    direct.begin().expect("a frame");
    let mut expected = Vec::new();
    for row in 0..SIZE as u16 {
        if let Some(row) = direct.push(&lines(0, row), &lines(7, row)).expect("a line") {
            expected.push((row.disparities().to_vec(), row.flags().to_vec()));
        }
    }
    while let Some(row) = direct.flush().expect("all lines are in") {
        expected.push((row.disparities().to_vec(), row.flags().to_vec()));
    }
    assert_eq!(expected.len(), SIZE);
    let (mut cameras, mut rows) = (sound(), started());
    asked(cameras.set_up()).0.expect("both answer");
    for frame in 0..2 {
        let mut found = Vec::new();
        asked(cameras.frame(&mut rows, |row| found.push((row.disparities().to_vec(), row.flags().to_vec()))))
            .0
            .expect("a frame");
        assert!(found == expected, "frame {frame}");
    }
}

#[test]
fn grey_is_black_to_white_and_weighs_colours() {
    assert_eq!([[0, 0], [0xff, 0xff]].map(grey_level), [0, 255]);
    // Red, green and blue alone: .299, .587 and .114 of 256, cut off.
    assert_eq!([[0xf8, 0], [0x07, 0xe0], [0, 0x1f]].map(grey_level), [76, 149, 28]);
}

#[test]
fn a_camera_that_fails_is_named() {
    let set_up = |register, reads| {
        let mut cameras = pair(register, reads);
        let result = asked(cameras.set_up()).0;
        (result, cameras.delays[1].0)
    };
    assert_eq!(set_up(CAMERA, |_| 0x42).0, Err(FrameError::Right(MegaError::Unknown(0x42))));
    // Nobody there: all bits are high.
    assert_eq!(set_up(STATE, |_| 0xff), (Err(FrameError::Right(MegaError::Settings)), 3000));
    let frame = |register, reads| {
        let (mut cameras, mut rows) = (pair(register, reads), started());
        asked(cameras.set_up()).0.expect("both answer");
        let result = asked(cameras.frame(&mut rows, |_| panic!("there are no rows"))).0;
        (result, cameras.delays[1].0)
    };
    // A picture is never done.
    let (result, passed_ms) = frame(STATE, |value| value & !4);
    assert_eq!(result, Err(FrameError::Right(MegaError::Picture)));
    assert!((1000..1010).contains(&passed_ms), "{passed_ms}");
    assert_eq!(frame(LENGTH[1], |_| 0x7f).0, Err(FrameError::Right(MegaError::Short(0x7f00))));
}

#[test]
fn what_is_shown_of_a_fault_says_where_and_what() {
    let words = |error: FrameError<Misuse, Misuse>| error.words();
    assert_eq!(words(FrameError::Left(MegaError::Unknown(0x42))), ("left", "unknown", 66));
    assert_eq!(words(FrameError::Right(MegaError::Settings)), ("right", "settings", 3000));
    assert_eq!(words(FrameError::Right(MegaError::Bus(Misuse::Command))), ("right", "bus", 0));
    assert_eq!(words(FrameError::Left(MegaError::Short(0x7f00))), ("left", "short", 0x7f00));
    let line = |words: (&'static str, &'static str, u32)| text::fault(words).collect::<Vec<_>>();
    assert_eq!(line(words(FrameError::Left(MegaError::Unknown(0x42)))), b"left unknown 66\n");
    assert_eq!(line(words(FrameError::Right(MegaError::Bus(Misuse::Command)))), b"right bus 0\n");
    assert_eq!(text::frame(10, 524).collect::<Vec<_>>(), b"10 524\n");
    let longest = [text::frame(u32::MAX, 65_535).count(), line(("pipeline", "settings", u32::MAX)).len()];
    assert_eq!(longest, [17, 29]);
    assert!(longest.iter().all(|&length| length <= text::LONGEST));
}

#[test]
fn every_module_takes_its_own_code_for_the_size() {
    // The simulated camera takes no picture at the other family's code.
    for camera in 0x81..=0x87 {
        let mut mega = Mega::new(Simulated::of(camera, seen(0)));
        asked(mega.set_up(&mut Passing(0))).0.unwrap_or_else(|e| panic!("{camera:#x}: {e:?}"));
        asked(mega.take()).0.unwrap_or_else(|e| panic!("{camera:#x}: {e:?}"));
        asked(mega.taken(&mut Passing(0))).0.unwrap_or_else(|e| panic!("{camera:#x}: {e:?}"));
    }
    for camera in [0x80, 0x88] {
        let mut mega = Mega::new(Simulated::of(camera, seen(0)));
        assert_eq!(asked(mega.set_up(&mut Passing(0))).0, Err(MegaError::Unknown(camera)));
    }
}

/// What happened, in order.
type Log = Rc<RefCell<Vec<String>>>;

/// A camera whose lines take a while: the task is asked once more after each transfer's beginning.
struct Slow<F> {
    camera: Simulated<F>,
    name: &'static str,
    log: Log,
}

impl<F> ErrorType for Slow<F> {
    type Error = Misuse;
}

impl<F: FnMut(u16, &mut [u8; SIZE])> SpiDevice for Slow<F> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Misuse> {
        for operation in operations {
            let is_line = matches!(operation, Operation::TransferInPlace(bytes) if bytes.len() > 3);
            if is_line {
                self.log.borrow_mut().push(format!("{} begins", self.name));
            }
            let mut is_asked = false;
            std::future::poll_fn(|_| {
                let was_asked = std::mem::replace(&mut is_asked, true);
                if was_asked { Poll::Ready(()) } else { Poll::Pending }
            })
            .await;
            self.camera.transaction(std::slice::from_mut(operation)).await?;
            if is_line {
                self.log.borrow_mut().push(format!("{} ends", self.name));
            }
        }
        Ok(())
    }
}

#[test]
fn rows_are_matched_while_the_next_lines_are_on_their_way() {
    let log = Log::default();
    let slow = |name, shift| Mega::new(Slow { camera: Simulated::new(seen(shift)), name, log: log.clone() });
    let mut cameras =
        Cameras { left: slow("left", 0), right: slow("right", 7), delays: [Passing(0), Passing(0)] };
    let mut rows = started();
    asked(cameras.set_up()).0.expect("both answer");
    let show = |row: &stereopsis::matching::Row<'_>| log.borrow_mut().push(format!("row {}", row.index()));
    asked(cameras.frame(&mut rows, show)).0.expect("a frame");
    let log = log.borrow();
    let at = log.iter().position(|what| what == "row 40").expect("it is matched");
    let around = &log[at - 4..=at + 2];
    assert_eq!(
        around,
        ["left ends", "right ends", "left begins", "right begins", "row 40", "left ends", "right ends"]
    );
}

#[test]
fn a_pipeline_that_was_not_started_is_told() {
    let (mut cameras, mut rows) = (sound(), Box::new(Rows::new()));
    asked(cameras.set_up()).0.expect("both answer");
    assert!(matches!(asked(cameras.frame(&mut rows, |_| ())).0, Err(FrameError::Begin(_))));
}

#[test]
fn what_the_note_does_not_have_is_refused() {
    let said = |bytes: &[u8]| asked(Simulated::new(seen(0)).write(bytes)).0;
    // A setting before the reset, a register that there is not, a burst without a picture.
    assert_eq!(said(&[0xa0, 2]), Err(Misuse::Unsettled));
    assert_eq!(said(&[0x87, 1]), Err(Misuse::Unsettled));
    assert_eq!(said(&[0x20, 2]), Err(Misuse::Command));
}
