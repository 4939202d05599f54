//! The sensors' drivers over a bus that is waited for say what those over one that blocks say.

use super::hm01b0::{hm01b0_session, hm01b0_start};
use super::sensors::{AT, CLOCK_HZ, fails_at_each_step, mt9v034_session, mt9v034_start, reset_pin};
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::i2c::Mock;
use std::pin::pin;
use std::task::{Context, Poll, Waker};
use stereopsis::camera::{
    AsyncHm01b0, AsyncMt9v034, Hm01b0Mode, Hm01b0Size, Mt9v034Binning, Mt9v034Mode, Mt9v034Pattern,
    Mt9v034Window, SensorError,
};

/// The end of what never has to wait, as the mock's transactions do not.
fn now<T>(future: impl Future<Output = T>) -> T {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(value) => value,
        Poll::Pending => panic!("the mock waits"),
    }
}

#[test]
fn a_mt9v034_is_set_up_register_by_register() {
    let (mut bus, mut reset) = (Mock::new(&mt9v034_session()), reset_pin());
    let mut sensor = AsyncMt9v034::new(bus.clone(), AT, CLOCK_HZ);
    let window = Mt9v034Window { left: 56, top: 0, width: 640, height: 480, binning: Mt9v034Binning::Two };
    let session = async {
        sensor.initialise(&mut reset, &mut NoopDelay::new()).await?;
        sensor.set_mode(Mt9v034Mode::Snapshot).await?;
        sensor.set_window(window).await?;
        sensor.set_flips(true, true).await?;
        sensor.set_exposure_rows(32_765).await?;
        sensor.set_gain(64).await?;
        sensor.set_inverted_pixel_clock(true).await?;
        for pattern in [
            Mt9v034Pattern::Grey(512),
            Mt9v034Pattern::Vertical,
            Mt9v034Pattern::Horizontal,
            Mt9v034Pattern::Diagonal,
            Mt9v034Pattern::Off,
        ] {
            sensor.set_test_pattern(pattern).await?;
        }
        Ok::<(), SensorError<_>>(())
    };
    now(session).expect("the bus takes it");
    // Refused before the bus.
    assert_eq!(now(sensor.set_gain(65)), Err(SensorError::OutOfRange { least: 16, most: 64 }));
    sensor.release();
    bus.done();
    reset.done();
}

#[test]
fn a_hm01b0_is_set_up_register_by_register() {
    let mut bus = Mock::new(&hm01b0_session());
    let mut sensor = AsyncHm01b0::new(bus.clone(), 3_000_000);
    let session = async {
        sensor.initialise(&mut NoopDelay::new()).await?;
        sensor.set_size(Hm01b0Size::Qqvga).await?;
        sensor.set_size(Hm01b0Size::Whole).await?;
        for mode in [Hm01b0Mode::Triggered, Hm01b0Mode::Streaming, Hm01b0Mode::Standby] {
            sensor.set_mode(mode).await?;
        }
        sensor.set_flips(true, true).await?;
        sensor.set_test_pattern(true).await?;
        sensor.set_frame_time(100_000).await?;
        sensor.set_exposure(20_000, 16 * 7).await
    };
    now(session).expect("the bus takes it");
    sensor.release();
    bus.done();
}

#[test]
fn a_bus_error_at_any_step_of_a_start_is_reported_and_the_next_start_works() {
    fails_at_each_step(&mt9v034_start(), |bus| {
        let mut reset = reset_pin();
        let done =
            now(AsyncMt9v034::new(bus.clone(), AT, CLOCK_HZ).initialise(&mut reset, &mut NoopDelay::new()));
        reset.done();
        done
    });
    fails_at_each_step(&hm01b0_start(), |bus| {
        now(AsyncHm01b0::new(bus.clone(), 3_000_000).initialise(&mut NoopDelay::new()))
    });
}
