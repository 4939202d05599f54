//! The driver of the DW9714, against a bus that knows what is to be written.

use embedded_hal::i2c::ErrorKind;
use embedded_hal_mock::eh1::i2c::{Mock, Transaction};
use stereopsis::focus::{ActuatorLimits, Dw9714, LensActuator, Slew};

const ADDRESS: u8 = 0x0c;

#[test]
fn positions_are_two_bytes() {
    let mut bus = Mock::new(&[
        // The slew's clock: unlocked, two registers, locked.
        Transaction::write(ADDRESS, vec![0xec, 0xa3]),
        Transaction::write(ADDRESS, vec![0xa1, 0x00]),
        Transaction::write(ADDRESS, vec![0xf2, 0x00]),
        Transaction::write(ADDRESS, vec![0xdc, 0x51]),
        // PD FLAG D9..D4, D3..D0 S3..S0.
        Transaction::write(ADDRESS, vec![0x00, 0x0d]),
        Transaction::write(ADDRESS, vec![0x15, 0x5d]),
        Transaction::write(ADDRESS, vec![0x3f, 0xfd]),
        Transaction::write(ADDRESS, vec![0x3f, 0xfd]),
        Transaction::read(ADDRESS, vec![0x7f, 0xfd]),
        Transaction::read(ADDRESS, vec![0x3f, 0xfd]),
        Transaction::write(ADDRESS, vec![0x80, 0x00]),
    ]);
    let mut lens = Dw9714::new(bus.clone(), Slew::Usual);
    assert_eq!(lens.limits(), ActuatorLimits { least: 0, most: 1023, backlash: 0 });
    lens.initialise().expect("the bus takes it");
    for position in [0, 0x155, 1023, 5000] {
        lens.move_to(position).expect("the bus takes it");
    }
    assert_eq!([lens.is_moving(), lens.is_moving()], [Ok(true), Ok(false)]);
    lens.power_down().expect("the bus takes it");
    bus.done();
}

#[test]
fn slews_are_reported_and_waited_for() {
    for (slew, bits, period_us) in [
        (Slew::Direct, 0, 0),
        (Slew::Linear(0), 0xc, 81),
        (Slew::Linear(3), 0xf, 648),
        (Slew::Linear(9), 0xf, 648),
    ] {
        let mut bus = Mock::new(&[Transaction::write(ADDRESS, vec![0x01, bits])]);
        let mut lens = Dw9714::new(bus.clone(), slew);
        lens.move_to(16).expect("the bus takes it");
        // Four codes a period, and the ringing.
        assert_eq!(lens.settling_us(100, 200), 25 * period_us + 12_000);
        assert_eq!(lens.settling_us(200, 100), 25 * period_us + 12_000);
        bus.done();
    }
}

#[test]
fn the_bus_error_is_passed_on() {
    let mut bus = Mock::new(&[
        Transaction::write(ADDRESS, vec![0x01, 0x0d]).with_error(ErrorKind::ArbitrationLoss),
        Transaction::write(ADDRESS, vec![0x01, 0x0d]),
    ]);
    let mut lens = Dw9714::new(bus.clone(), Slew::Usual);
    assert_eq!(LensActuator::move_to(&mut &mut lens, 16), Err(ErrorKind::ArbitrationLoss));
    assert_eq!(lens.move_to(16), Ok(()));
    lens.release();
    bus.done();
}
