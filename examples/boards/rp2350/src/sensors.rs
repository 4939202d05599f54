//! Both HM01B0 set up alike: 162x122 pixels on four data pins, a frame for each trigger.

use embassy_time::{Delay, Duration, block_for};
use embedded_hal::i2c::I2c;
use stereopsis::camera::{Hm01b0, Hm01b0Mode, Hm01b0Size, SensorError};

/// The master clock that main.rs makes, by the sensor's own divisor.
const CLOCK_HZ: u32 = 150_000_000 / 12 / 8;
/// Exposure, microseconds: for a room by day.
pub const EXPOSURE_US: u32 = 8_000;
/// Gain, sixteenths.
const GAIN_16THS: u16 = 32;
/// The register BIT_CONTROL with four data pins, the low half of a byte first.
const FOUR_PINS: [u8; 3] = [0x30, 0x59, 0x42];

/// From the master clock's beginning, and from a start that failed, to the next one.
const WAIT: Duration = Duration::from_millis(50);
/// Number of starts.
const ATTEMPTS: u32 = 10;

/// Sets a sensor up whose master clock has just begun.
pub fn start<I: I2c>(mut bus: I) -> Result<(), SensorError<I::Error>> {
    for _ in 1..ATTEMPTS {
        block_for(WAIT);
        if set_up(&mut bus).is_ok() {
            return Ok(());
        }
    }
    block_for(WAIT);
    set_up(&mut bus)
}

/// Sets a sensor up and has it wait for triggers.
fn set_up<I: I2c>(bus: I) -> Result<(), SensorError<I::Error>> {
    let mut sensor = Hm01b0::new(bus, CLOCK_HZ);
    sensor.initialise(&mut Delay)?;
    let mut bus = sensor.release();
    bus.write(Hm01b0::<I>::ADDRESS, &FOUR_PINS).map_err(SensorError::Bus)?;
    let mut sensor = Hm01b0::new(bus, CLOCK_HZ);
    sensor.set_size(Hm01b0Size::Qqvga)?;
    sensor.set_exposure(EXPOSURE_US, GAIN_16THS)?;
    sensor.set_mode(Hm01b0Mode::Triggered)
}
