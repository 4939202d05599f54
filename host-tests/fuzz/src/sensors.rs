//! Drivers of sensors over a bus that answers anything, or nothing.

use arbitrary::{Result, Unstructured};
use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, Operation};
use stereopsis::camera::{
    Hm01b0, Hm01b0Mode, Hm01b0Size, Mt9v034, Mt9v034Binning, Mt9v034Mode, Mt9v034Pattern, Mt9v034Window,
};
use stereopsis::focus::{Dw9714, Slew};

/// Answers with the bytes that there are; fails now and then, and when they are over.
struct Bus<'a, 'b>(&'a mut Unstructured<'b>);

impl ErrorType for Bus<'_, '_> {
    type Error = ErrorKind;
}

impl I2c for Bus<'_, '_> {
    fn transaction(
        &mut self,
        _: u8,
        operations: &mut [Operation<'_>],
    ) -> core::result::Result<(), ErrorKind> {
        if self.0.is_empty() || self.0.ratio(1, 40).unwrap_or(true) {
            return Err(ErrorKind::Bus);
        }
        for operation in operations {
            if let Operation::Read(bytes) = operation {
                // The identities and answers of chips that work, or anything.
                let usual: [&[u8]; 4] = [&[0x13, 0x24], &[0x01], &[0xb0], &[0x00]];
                let answer = *self.0.choose(&usual).map_err(|_| ErrorKind::Bus)?;
                for (to, byte) in bytes.iter_mut().zip(answer.iter().chain(&[0])) {
                    *to = *byte;
                }
                if self.0.ratio(1, 4).unwrap_or(false) {
                    self.0.fill_buffer(bytes).map_err(|_| ErrorKind::Bus)?;
                }
            }
        }
        Ok(())
    }
}

/// No time passes.
struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}

/// No call panics, whatever the chip answers and whatever is asked; limits are in order.
pub fn survive_their_bus(u: &mut Unstructured<'_>) -> Result<()> {
    let clock_hz = u.arbitrary()?;
    match u.int_in_range(0..=2)? {
        0 => mt9v034(u, clock_hz),
        1 => hm01b0(u, clock_hz),
        _ => {
            let mut lens = Dw9714::new(Bus(u), Slew::Usual);
            let _ = (lens.initialise(), lens.is_moving(), lens.power_down());
            Ok(())
        }
    }
}

fn mt9v034(u: &mut Unstructured<'_>, clock_hz: u32) -> Result<()> {
    let mut calls = Vec::new();
    for _ in 0..u.int_in_range(1..=8)? {
        calls.push(u.arbitrary::<(u8, u16, u16, u16, u16, u8, u32)>()?);
    }
    let mut sensor = Mt9v034::new(Bus(u), 0x48, clock_hz);
    for (call, left, top, width, height, binning, number) in calls {
        let binning =
            [Mt9v034Binning::One, Mt9v034Binning::Two, Mt9v034Binning::Four][usize::from(binning % 3)];
        let done = match call % 9 {
            0 => sensor.identify(),
            1 => sensor.set_mode(Mt9v034Mode::Snapshot),
            2 => sensor.set_window(Mt9v034Window { left, top, width, height, binning }),
            3 => sensor.set_flips(number & 1 == 1, number & 2 == 2),
            4 => sensor.set_frame_time(number),
            5 => sensor.set_exposure(number, left),
            6 => sensor.set_exposure_rows(left),
            7 => sensor.set_gain(left),
            _ => sensor.set_test_pattern(Mt9v034Pattern::Grey(left)),
        };
        let (least, most) = sensor.exposure_limits_us();
        assert!(least <= most, "{call}: {done:?}, {least} to {most} us");
        let _ = (sensor.frame_time_us(), sensor.row_time_ns());
    }
    Ok(())
}

fn hm01b0(u: &mut Unstructured<'_>, clock_hz: u32) -> Result<()> {
    let mut calls = Vec::new();
    for _ in 0..u.int_in_range(1..=8)? {
        calls.push(u.arbitrary::<(u8, u16, u32)>()?);
    }
    let mut sensor = Hm01b0::new(Bus(u), clock_hz);
    for (call, small, number) in calls {
        let size = [Hm01b0Size::Qvga, Hm01b0Size::Qqvga, Hm01b0Size::Whole][usize::from(small % 3)];
        let done = match call % 6 {
            0 => sensor.initialise(&mut NoDelay),
            1 => sensor.identify(),
            2 => sensor.set_mode(Hm01b0Mode::Streaming),
            3 => sensor.set_size(size),
            4 => sensor.set_frame_time(number),
            _ => sensor.set_exposure(number, small),
        };
        let (least, most) = sensor.exposure_limits_us();
        assert!(least <= most, "{call}: {done:?}, {least} to {most} us");
        let _ = sensor.frame_time_us();
    }
    Ok(())
}
