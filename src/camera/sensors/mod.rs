//! Image sensor drivers over I2C. Pixels come through a [`LineSource`](super::LineSource) over the chip's
//! port.
//!
//! * [`Mt9v034`]: global shutter, 752x480. [`Hm01b0`]: rolling shutter, 324x324, milliwatts.
//! * [`ExposureControl`]: exposure and gain for an automatic exposure. [`SensorError`]: why a call failed.
//!
//! A driver owns its bus by value; a shared bus comes by `embedded-hal-bus` or `&mut`. Calls block while the
//! bus transfers; with the feature `async`, `AsyncMt9v034` and `AsyncHm01b0` await it instead. A write that
//! fails leaves the sensor between two settings: repeat the call, or start over with [`Mt9v034::initialise`]
//! or [`Hm01b0::initialise`].
//!
//! Other sensors' drivers need no adapter, as they only configure: for example the crates `ov7670` and
//! `hm01b0`, of which the second neither windows nor bins.

/// A sensor's two drivers and its exposure control. `$driver!` makes one driver, of a bus that blocks or of
/// one that is awaited.
macro_rules! drivers {
    ($driver:ident, $blocking:ident, $awaited:ident, $chip:literal, $most_gain:literal, $steps:ident) => {
        $driver!(
            $blocking,
            concat!("Driver of the ", $chip, " on an I2C bus."),
            embedded_hal::i2c::I2c,
            embedded_hal::delay::DelayNs,
            [],
            []
        );
        #[cfg(feature = "async")]
        $driver!(
            $awaited,
            concat!(
                "Driver of the ", $chip, " on an asynchronous I2C bus, with the calls of [`",
                stringify!($blocking), "`].\n\n",
                "A call whose future is dropped leaves the sensor as a failed one does."
            ),
            embedded_hal_async::i2c::I2c,
            embedded_hal_async::delay::DelayNs,
            [async],
            [.await]
        );

        impl<I: embedded_hal::i2c::I2c> ExposureControl for $blocking<I> {
            type Error = SensorError<I::Error>;

            fn exposure_limits_us(&self) -> (u32, u32) {
                self.exposure_limits_us()
            }

            fn most_gain_16ths(&self) -> u16 {
                $most_gain
            }

            fn exposure_step_us(&self) -> u32 {
                self.exposure_step_us()
            }

            fn gain_steps(&self) -> GainSteps {
                GainSteps::$steps
            }

            fn set_exposure(&mut self, exposure_us: u32, gain_16ths: u16) -> Result<(), Self::Error> {
                self.set_exposure(exposure_us, gain_16ths)
            }
        }
    };
}

mod hm01b0;
mod mt9v034;

#[cfg(feature = "async")]
pub use hm01b0::AsyncHm01b0;
pub use hm01b0::{Hm01b0, Hm01b0Mode, Hm01b0Size};
#[cfg(feature = "async")]
pub use mt9v034::AsyncMt9v034;
pub use mt9v034::{Mt9v034, Mt9v034Binning, Mt9v034Mode, Mt9v034Pattern, Mt9v034Window};

use core::fmt;

/// Why a call to a sensor driver failed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SensorError<B> {
    /// The bus failed; its own error is inside.
    Bus(B),
    /// The reset pin failed.
    ResetPin,
    /// A different chip answers at the address.
    Identity {
        /// Identity that the chip reports.
        found: u16,
    },
    /// The sensor did not come out of reset.
    NoReset,
    /// The sensor does not support the value.
    OutOfRange {
        /// Least supported value.
        least: u32,
        /// Largest supported value.
        most: u32,
    },
}

impl<B: fmt::Debug> fmt::Display for SensorError<B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bus(e) => write!(f, "bus: {e:?}"),
            Self::ResetPin => f.write_str("the reset pin failed"),
            Self::Identity { found } => write!(f, "another chip answers: {found:#06x}"),
            Self::NoReset => f.write_str("the sensor stays in reset"),
            Self::OutOfRange { least, most } => write!(f, "the sensor has {least} to {most}"),
        }
    }
}

impl<B: fmt::Debug> core::error::Error for SensorError<B> {}

/// Result of a driver's call on the bus `I`.
type Outcome<I, T = ()> = Result<T, SensorError<<I as embedded_hal::i2c::ErrorType>::Error>>;

/// Returns `value` if it is within the sensor's limits.
fn within<B>(value: u32, least: u32, most: u32) -> Result<u32, SensorError<B>> {
    if (least..=most).contains(&value) { Ok(value) } else { Err(SensorError::OutOfRange { least, most }) }
}

/// Steps in which a sensor sets its gain.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum GainSteps {
    /// Sixteenths, or finer.
    #[default]
    Sixteenths,
    /// Doublings: once, twice, four times, and so on.
    Doublings,
}

/// Exposure and gain of a sensor, for an automatic exposure.
pub trait ExposureControl {
    /// Error of the sensor driver.
    type Error: fmt::Debug;

    /// Shortest and longest exposure that keep the frame rate, microseconds.
    fn exposure_limits_us(&self) -> (u32, u32);

    /// Largest gain in sixteenths: 64 is fourfold. The least is 16.
    fn most_gain_16ths(&self) -> u16;

    /// Step of the exposure, microseconds, rounded up: so many times that are at least so many whole steps.
    /// 1 where any exposure can be set.
    fn exposure_step_us(&self) -> u32;

    /// Steps of the gain.
    fn gain_steps(&self) -> GainSteps;

    /// Sets exposure and gain for a coming frame, which the sensor determines. The exposure is rounded to a
    /// supported value.
    fn set_exposure(&mut self, exposure_us: u32, gain_16ths: u16) -> Result<(), Self::Error>;
}

impl<T: ExposureControl + ?Sized> ExposureControl for &mut T {
    type Error = T::Error;

    fn exposure_limits_us(&self) -> (u32, u32) {
        (**self).exposure_limits_us()
    }

    fn most_gain_16ths(&self) -> u16 {
        (**self).most_gain_16ths()
    }

    fn exposure_step_us(&self) -> u32 {
        (**self).exposure_step_us()
    }

    fn gain_steps(&self) -> GainSteps {
        (**self).gain_steps()
    }

    fn set_exposure(&mut self, exposure_us: u32, gain_16ths: u16) -> Result<(), Self::Error> {
        (**self).set_exposure(exposure_us, gain_16ths)
    }
}
