//! The driver of the MT9V034, against a bus that knows what is to be written.

use embedded_hal::i2c::{ErrorKind, NoAcknowledgeSource};
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::digital::{Mock as PinMock, State, Transaction as PinTransaction};
use embedded_hal_mock::eh1::i2c::{Mock, Transaction};
use stereopsis::camera::{Mt9v034, Mt9v034Binning, Mt9v034Mode, Mt9v034Pattern, Mt9v034Window, SensorError};

pub const CLOCK_HZ: u32 = 26_600_000;
pub const AT: u8 = 0x48;

/// The MT9V034's register as 16 bits, high byte first.
fn w(register: u8, value: u16) -> Transaction {
    Transaction::write(AT, vec![register, (value >> 8) as u8, value as u8])
}

fn identity(value: u16) -> Transaction {
    Transaction::write_read(AT, vec![0x00], value.to_be_bytes().to_vec())
}

/// All that `initialise` says to a MT9V034.
pub fn mt9v034_start() -> Vec<Transaction> {
    vec![
        identity(0x1324),
        w(0x0c, 1),
        w(0x0c, 0),
        // What the data sheet recommends for reserved registers.
        w(0x13, 0x2d2e),
        w(0x20, 0x03c7),
        w(0x24, 0x001b),
        w(0x2b, 0x0003),
        w(0x2f, 0x0003),
        // No automatic exposure or gain, no high dynamic range.
        w(0xaf, 0),
        w(0x0f, 0),
        // The whole array in the shortest rows.
        w(0x0d, 0x0300),
        w(0x01, 1),
        w(0x02, 4),
        w(0x04, 752),
        w(0x03, 480),
        w(0x05, 61),
        // As many blank rows as after a reset, which a frame time set before may have changed.
        w(0x06, 45),
        // Free-running, without the bit 9 that is set after a reset.
        w(0x07, 0x0188),
    ]
}

pub fn reset_pin() -> PinMock {
    PinMock::new(&[PinTransaction::set(State::Low), PinTransaction::set(State::High)])
}

/// All that is said in a session with every setting.
pub fn mt9v034_session() -> Vec<Transaction> {
    let mut expected = mt9v034_start();
    expected.extend([
        w(0x07, 0x0198),
        // 320 of 640 columns in the middle, binned by two: 704 - 640 < 71.
        w(0x0d, 0x0305),
        w(0x01, 57),
        w(0x02, 4),
        w(0x04, 640),
        w(0x03, 480),
        w(0x05, 71),
        w(0x0d, 0x0335),
        w(0x0b, 32_765),
        w(0x35, 64),
        w(0x72, 0x10),
        w(0x7f, 0x2400 | 512),
        w(0x7f, 0x2800),
        w(0x7f, 0x3000),
        w(0x7f, 0x3800),
        w(0x7f, 0),
    ]);
    expected
}

#[test]
fn a_mt9v034_is_set_up_register_by_register() {
    let (mut bus, mut pin) = (Mock::new(&mt9v034_session()), reset_pin());
    let mut sensor = Mt9v034::new(bus.clone(), AT, CLOCK_HZ);
    sensor.initialise(&mut pin, &mut NoopDelay::new()).expect("the bus takes it");
    sensor.set_mode(Mt9v034Mode::Snapshot).expect("the bus takes it");
    let window = Mt9v034Window { left: 56, top: 0, width: 640, height: 480, binning: Mt9v034Binning::Two };
    sensor.set_window(window).expect("the bus takes it");
    sensor.set_flips(true, true).expect("the bus takes it");
    sensor.set_exposure_rows(32_765).expect("the bus takes it");
    sensor.set_gain(64).expect("the bus takes it");
    sensor.set_inverted_pixel_clock(true).expect("the bus takes it");
    for pattern in [
        Mt9v034Pattern::Grey(512),
        Mt9v034Pattern::Vertical,
        Mt9v034Pattern::Horizontal,
        Mt9v034Pattern::Diagonal,
        Mt9v034Pattern::Off,
    ] {
        sensor.set_test_pattern(pattern).expect("the bus takes it");
    }
    sensor.release();
    bus.done();
    pin.done();
}

#[test]
fn a_mt9v034s_times_are_those_of_its_data_sheet() {
    // The defaults: 846 clocks a row, 525 rows and 4 clocks a frame: 444 154 clocks, 16.66 ms at 26.66 MHz
    // (table 4 and 5).
    let sensor = Mt9v034::new(Mock::new(&[]), AT, 26_660_000);
    assert_eq!(sensor.row_time_ns(), 31_732);
    assert_eq!(sensor.frame_time_us(), 16_660);
    sensor.release().done();

    let mut expected = mt9v034_start();
    // 813 clocks a row: 1636 rows are 50 ms less a part of one, of which 480 are read.
    expected.extend([w(0x06, 1155), w(0x0b, 327), w(0x35, 32), w(0x0b, 1), w(0x35, 16)]);
    let (mut bus, mut pin) = (Mock::new(&expected), reset_pin());
    let mut sensor = Mt9v034::new(bus.clone(), AT, CLOCK_HZ);
    sensor.initialise(&mut pin, &mut NoopDelay::new()).expect("the bus takes it");
    sensor.set_frame_time(50_000).expect("the bus takes it");
    assert!((49_960..=50_000).contains(&sensor.frame_time_us()), "{}", sensor.frame_time_us());
    let (least, most) = sensor.exposure_limits_us();
    assert!(least <= 31 && (49_800..sensor.frame_time_us()).contains(&most), "{least} {most}");
    sensor.set_exposure(10_000, 32).expect("the bus takes it");
    sensor.set_exposure(0, 16).expect("the bus takes it");
    bus.done();
    pin.done();
}

#[test]
fn a_mt9v034_that_is_set_up_again_has_its_own_frame_time() {
    let mut expected = mt9v034_start();
    expected.push(w(0x06, 2791));
    expected.extend(mt9v034_start());
    let pins = [State::Low, State::High, State::Low, State::High].map(PinTransaction::set);
    let (mut bus, mut pin) = (Mock::new(&expected), PinMock::new(&pins));
    let mut sensor = Mt9v034::new(bus.clone(), AT, CLOCK_HZ);
    sensor.initialise(&mut pin, &mut NoopDelay::new()).expect("the bus takes it");
    let first_us = sensor.frame_time_us();
    sensor.set_frame_time(100_000).expect("the bus takes it");
    assert!(sensor.frame_time_us() > 99_000);
    sensor.initialise(&mut pin, &mut NoopDelay::new()).expect("the bus takes it");
    assert_eq!(sensor.frame_time_us(), first_us);
    bus.done();
    pin.done();
}

#[test]
fn what_a_mt9v034_has_not_is_refused_before_the_bus() {
    let mut bus = Mock::new(&[]);
    let mut sensor = Mt9v034::new(bus.clone(), AT, CLOCK_HZ);
    let whole = Mt9v034Window::WHOLE;
    let range = |least, most| Err(SensorError::OutOfRange { least, most });
    assert_eq!(sensor.set_window(Mt9v034Window { left: 1, ..whole }), range(1, 751));
    assert_eq!(sensor.set_window(Mt9v034Window { height: 0, ..whole }), range(1, 480));
    assert_eq!(sensor.set_window(Mt9v034Window { top: 600, ..whole }), range(1, 0));
    assert_eq!(sensor.set_exposure_rows(32_766), range(0, 32_765));
    assert_eq!((sensor.set_gain(15), sensor.set_gain(65)), (range(16, 64), range(16, 64)));
    assert_eq!(sensor.set_test_pattern(Mt9v034Pattern::Grey(1024)), range(0, 1023));
    assert!(sensor.set_frame_time(1000).is_err() && sensor.set_frame_time(u32::MAX).is_err());
    bus.done();
}

/// Whatever transaction of a start fails, and how: the error comes up, nothing more is said, and a second
/// start works.
pub fn fails_at_each_step(
    start: &[Transaction],
    initialise: impl Fn(&Mock) -> Result<(), SensorError<ErrorKind>>,
) {
    let faults = [
        ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address),
        ErrorKind::NoAcknowledge(NoAcknowledgeSource::Data),
        ErrorKind::ArbitrationLoss,
        ErrorKind::Bus,
    ];
    for at in 0..start.len() {
        for fault in faults {
            let mut expected = start[..=at].to_vec();
            let last = expected.pop().expect("one at least");
            expected.push(last.with_error(fault));
            expected.extend_from_slice(start);
            let mut bus = Mock::new(&expected);
            assert_eq!(initialise(&bus), Err(SensorError::Bus(fault)), "step {at}");
            assert_eq!(initialise(&bus), Ok(()), "after step {at}");
            bus.done();
        }
    }
}

#[test]
fn a_bus_error_at_any_step_of_a_start_is_reported_and_the_next_start_works() {
    fails_at_each_step(&mt9v034_start(), |bus| {
        let mut pin = reset_pin();
        let done = Mt9v034::new(bus.clone(), AT, CLOCK_HZ).initialise(&mut pin, &mut NoopDelay::new());
        pin.done();
        done
    });
}

#[test]
fn another_chip_at_the_address_is_named_and_left_alone() {
    // 0x1313 is a MT9V032.
    for found in [0x1313, 0, 0xffff] {
        let (mut bus, mut pin) = (Mock::new(&[identity(found)]), reset_pin());
        let error = Mt9v034::new(bus.clone(), AT, CLOCK_HZ).initialise(&mut pin, &mut NoopDelay::new());
        assert_eq!(error, Err(SensorError::Identity { found }));
        bus.done();
        pin.done();
    }
    assert_eq!(
        SensorError::<ErrorKind>::Identity { found: 0x0360 }.to_string(),
        "another chip answers: 0x0360"
    );
}

#[test]
fn a_reset_pin_that_fails_is_reported() {
    let mut bus = Mock::new(&[]);
    let fault = MockError::Io(std::io::ErrorKind::NotConnected);
    let mut pin = PinMock::new(&[PinTransaction::set(State::Low).with_error(fault)]);
    let error = Mt9v034::new(bus.clone(), AT, CLOCK_HZ).initialise(&mut pin, &mut NoopDelay::new());
    assert_eq!(error, Err(SensorError::ResetPin));
    bus.done();
    pin.done();
}

/// In a frame of two rows, one of them blank, no exposure keeps the frame rate: the limits are one row both.
#[test]
fn a_mt9v034s_exposure_limits_are_in_order() {
    let mut bus = Mock::new(&[
        w(0x0d, 0x0305),
        w(0x01, 1),
        w(0x02, 4),
        w(0x04, 640),
        w(0x03, 1),
        w(0x05, 71),
        w(0x06, 2),
    ]);
    let mut sensor = Mt9v034::new(bus.clone(), AT, 26_660_000);
    let window = Mt9v034Window { left: 0, top: 0, width: 640, height: 1, binning: Mt9v034Binning::Two };
    sensor.set_window(window).expect("the bus takes it");
    sensor.set_frame_time(54).expect("the bus takes it");
    // 711 clocks and 4.
    assert_eq!(sensor.exposure_limits_us(), (27, 27));
    bus.done();
}
