//! Drivers of image sensors over I2C: what they are told. Where their pixels go, a
//! [`LineSource`](super::LineSource) says, over the port of the chip at hand.
//!
//! * [`Mt9v034`]: global shutter, 752x480, the classic of embedded stereo. [`Hm01b0`]: rolling shutter,
//!   324x324, milliwatts.
//! * [`ExposureControl`]: what an automatic exposure asks of a sensor. [`SensorError`]: why a sensor did not
//!   do what it was told.
//!
//! A driver owns its bus by value; a shared one comes by `embedded-hal-bus` or `&mut`. Delay and reset pin
//! are asked for where they are needed. All of it blocks, for the time that the bus takes; with the feature
//! `async` there is each driver over a bus that is waited for as well (`AsyncMt9v034`, `AsyncHm01b0`), made
//! of the same text. A write that fails leaves the sensor between two settings: the call may be repeated as
//! it is, and [`Mt9v034::initialise`] or [`Hm01b0::initialise`] begins anew.
//!
//! Other sensors come with drivers of their own, which need no adapter: they configure, over the same traits.
//! For the OV7670 there is the crate `ov7670` 0.1.0, over `embedded-hal` 1.0: it sets size, format, gain and
//! exposure, but neither frame rate, windows, test pattern nor clock, and looks at no identity, so that an
//! adapter could give an [`ExposureControl`] and no more; its only version is its first. The crate
//! `hm01b0` 0.1.0 has exposure, trigger and test pattern; as it neither windows nor bins, there is a driver
//! here.

mod hm01b0;
mod mt9v034;

#[cfg(feature = "async")]
pub use hm01b0::AsyncHm01b0;
pub use hm01b0::{Hm01b0, Hm01b0Mode, Hm01b0Size};
#[cfg(feature = "async")]
pub use mt9v034::AsyncMt9v034;
pub use mt9v034::{Mt9v034, Mt9v034Mode, Mt9v034Pattern, Mt9v034Window};

use core::fmt;

/// Why a sensor did not do what it was told.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SensorError<B> {
    /// The bus failed; its own error is inside.
    Bus(B),
    /// The reset pin failed.
    ResetPin,
    /// Another chip answers at the address.
    Identity {
        /// What the chip says that it is.
        found: u16,
    },
    /// The sensor did not come out of its reset.
    NoReset,
    /// The sensor has no such value.
    OutOfRange {
        /// The least that it has.
        least: u32,
        /// The most that it has.
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

/// `value`, if the sensor has it.
fn within<B>(value: u32, least: u32, most: u32) -> Result<u32, SensorError<B>> {
    if (least..=most).contains(&value) { Ok(value) } else { Err(SensorError::OutOfRange { least, most }) }
}

/// What an automatic exposure asks of a sensor.
pub trait ExposureControl {
    /// The sensor's error.
    type Error: fmt::Debug;

    /// The least and the most exposure that leave the frame rate as it is, microseconds.
    fn exposure_limits_us(&self) -> (u32, u32);

    /// The most gain, in sixteenths: 64 is fourfold. The least is 16.
    fn most_gain_16ths(&self) -> u16;

    /// Sets both for a coming frame: which one, the sensor says. The exposure is rounded to what the sensor
    /// has.
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

    fn set_exposure(&mut self, exposure_us: u32, gain_16ths: u16) -> Result<(), Self::Error> {
        (**self).set_exposure(exposure_us, gain_16ths)
    }
}
