//! The driver of the HM01B0, against a bus that knows what is to be written.

use super::sensors::fails_at_each_step;
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::i2c::{Mock, Transaction};
use stereopsis::camera::{Hm01b0, Hm01b0Mode, Hm01b0Size, SensorError};

/// The HM01B0's register of 8 bits at an address of 16.
fn hw(register: u16, value: u8) -> Transaction {
    Transaction::write(0x24, vec![(register >> 8) as u8, register as u8, value])
}

fn hr(register: u16, value: u8) -> Transaction {
    Transaction::write_read(0x24, register.to_be_bytes().to_vec(), vec![value])
}

/// A size's registers: how columns and rows are read, the window, the lines of a frame, an exposure within
/// them, and that they count.
fn size(readout: u8, binning: u8, window: u8, lines: u16) -> Vec<Transaction> {
    let [high, low] = lines.to_be_bytes();
    // A start asks for what its 260 lines have room for.
    let [exposure_high, exposure_low] = (lines - 2).min(258).to_be_bytes();
    let registers = [
        (0x0383, readout),
        (0x0387, readout),
        (0x0390, binning),
        (0x3010, window),
        (0x0340, high),
        (0x0341, low),
        (0x0202, exposure_high),
        (0x0203, exposure_low),
        (0x0104, 1),
    ];
    registers.map(|(register, value)| hw(register, value)).to_vec()
}

pub fn hm01b0_start() -> Vec<Transaction> {
    let mut all = vec![hw(0x0103, 1), hr(0x0100, 0), hr(0x0000, 0x01), hr(0x0001, 0xb0)];
    let settings = [
        (0x1003, 0x08),
        (0x1007, 0x08),
        (0x3044, 0x0a),
        (0x3045, 0x00),
        (0x3047, 0x0a),
        (0x3050, 0xc0),
        (0x3051, 0x42),
        (0x3052, 0x50),
        (0x3053, 0x00),
        (0x3054, 0x03),
        (0x3055, 0xf7),
        (0x3056, 0xf8),
        (0x3057, 0x29),
        (0x3058, 0x1f),
        (0x3064, 0x00),
        (0x3065, 0x04),
        (0x3067, 0x00),
        (0x1000, 0x43),
        (0x1001, 0x43),
        (0x1002, 0x43),
        (0x0350, 0x7f),
        (0x1006, 0x01),
        (0x1008, 0x01),
        (0x1009, 0xa0),
        (0x100a, 0x60),
        (0x100b, 0x90),
        (0x100c, 0x40),
        (0x1012, 0x00),
        (0x3059, 0x02),
        // Eight bits a pixel; an eighth of the master clock.
        (0x3011, 0x70),
        (0x3060, 0x08),
        (0x2100, 0x00),
        (0x0342, 0x01),
        (0x0343, 0x78),
    ];
    all.extend(settings.map(|(register, value)| hw(register, value)));
    all.extend(size(1, 0, 1, 260));
    all
}

/// All that is said in a session with every setting.
pub fn hm01b0_session() -> Vec<Transaction> {
    let mut expected = hm01b0_start();
    expected.extend([size(3, 3, 1, 132), size(1, 0, 0, 346)].concat());
    expected.extend([
        hw(0x0100, 5),
        hw(0x0100, 1),
        hw(0x0100, 0),
        hw(0x0101, 3),
        hw(0x0104, 1),
        hw(0x0601, 1),
        // 100 ms are 797 lines of 376 clocks at 3 MHz.
        hw(0x0340, 0x03),
        hw(0x0341, 0x1d),
        hw(0x0202, 1),
        hw(0x0203, 2),
        hw(0x0104, 1),
        // 20 ms are 159 lines; gains are 1, 2, 4, 8.
        hw(0x0202, 0),
        hw(0x0203, 159),
        hw(0x0205, 0x20),
        hw(0x0104, 1),
    ]);
    expected
}

#[test]
fn a_hm01b0_is_set_up_register_by_register() {
    let mut bus = Mock::new(&hm01b0_session());
    let mut sensor = Hm01b0::new(bus.clone(), 3_000_000);
    sensor.initialise(&mut NoopDelay::new()).expect("the bus takes it");
    sensor.set_size(Hm01b0Size::Qqvga).expect("the bus takes it");
    sensor.set_size(Hm01b0Size::Whole).expect("the bus takes it");
    for mode in [Hm01b0Mode::Triggered, Hm01b0Mode::Streaming, Hm01b0Mode::Standby] {
        sensor.set_mode(mode).expect("the bus takes it");
    }
    sensor.set_flips(true, true).expect("the bus takes it");
    sensor.set_test_pattern(true).expect("the bus takes it");
    sensor.set_frame_time(100_000).expect("the bus takes it");
    assert!((99_800..=100_000).contains(&sensor.frame_time_us()));
    assert!(sensor.set_frame_time(10_000).is_err(), "346 lines take 43.4 ms");
    sensor.set_exposure(20_000, 16 * 7).expect("the bus takes it");
    assert!(sensor.set_exposure(20_000, 15).is_err());
    assert_eq!(Hm01b0Size::Qqvga.pixels(), (162, 122));
    bus.done();
}

#[test]
fn a_hm01b0s_exposure_stays_within_its_frame() {
    let (lines, exposure) = (
        |lines: u16| [hw(0x0340, (lines >> 8) as u8), hw(0x0341, lines as u8)],
        |lines: u16| [hw(0x0202, (lines >> 8) as u8), hw(0x0203, lines as u8)],
    );
    let group = [hw(0x0104, 1)];
    let with =
        |size: Vec<Transaction>, lines: u16| [&size[..size.len() - 3], &exposure(lines), &group].concat();
    let mut expected = hm01b0_start();
    // 100 ms, of which 90 ms are 718 lines.
    expected
        .extend([&lines(797)[..], &exposure(258), &group, &exposure(718), &[hw(0x0205, 0)], &group].concat());
    // 50 ms are 398 lines, and 60 ms are 478; a small picture has 132.
    expected.extend([&lines(398)[..], &exposure(396), &group].concat());
    expected.extend([&lines(478)[..], &exposure(476), &group].concat());
    expected.extend(with(size(3, 3, 1, 132), 130));
    expected.extend([&lines(797)[..], &exposure(718), &group].concat());
    // A start has the longest exposure of its frames, whatever was before.
    expected.extend(hm01b0_start());
    let mut bus = Mock::new(&expected);
    let mut sensor = Hm01b0::new(bus.clone(), 3_000_000);
    sensor.initialise(&mut NoopDelay::new()).expect("the bus takes it");
    sensor.set_frame_time(100_000).expect("the bus takes it");
    sensor.set_exposure(90_000, 16).expect("the bus takes it");
    sensor.set_frame_time(50_000).expect("the bus takes it");
    sensor.set_frame_time(60_000).expect("the bus takes it");
    sensor.set_size(Hm01b0Size::Qqvga).expect("the bus takes it");
    sensor.set_frame_time(100_000).expect("the bus takes it");
    sensor.initialise(&mut NoopDelay::new()).expect("the bus takes it");
    bus.done();
}

#[test]
fn a_hm01b0_that_stays_in_reset_is_given_up() {
    let mut expected = vec![hw(0x0103, 1)];
    expected.extend((0..10).map(|_| hr(0x0100, 0xff)));
    let mut bus = Mock::new(&expected);
    let error = Hm01b0::new(bus.clone(), 3_000_000).initialise(&mut NoopDelay::new());
    assert_eq!(error, Err(SensorError::NoReset));
    bus.done();
}

#[test]
fn a_bus_error_at_any_step_of_a_start_is_reported_and_the_next_start_works() {
    fails_at_each_step(&hm01b0_start(), |bus| {
        Hm01b0::new(bus.clone(), 3_000_000).initialise(&mut NoopDelay::new())
    });
}

#[test]
fn another_chip_at_the_address_is_named_and_left_alone() {
    let mut expected = hm01b0_start()[..2].to_vec();
    expected.extend([hr(0x0000, 0x03), hr(0x0001, 0x60)]);
    let mut bus = Mock::new(&expected);
    let error = Hm01b0::new(bus.clone(), 3_000_000).initialise(&mut NoopDelay::new());
    assert_eq!(error, Err(SensorError::Identity { found: 0x0360 }));
    bus.done();
}
