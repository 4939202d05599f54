//! A common trigger for sensors that expose on a pulse.

use super::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};
use core::fmt;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;

/// A stereo source whose sensors wait for a pulse on one pin: both expose at the same moment.
///
/// [`start_frame`](StereoSource::start_frame) pulls the pin high for the pulse's length, then waits for the
/// frame.
///
/// ```text
///             ┌──────────┐
/// pin     ────┘ pulse_us └───────────────────────────────
/// left          │ exposure │ row 0 │ row 1 │ ...
/// right         │ exposure │ row 0 │ row 1 │ ...
/// ```
#[derive(Debug)]
pub struct Triggered<S, P, D> {
    source: S,
    pin: P,
    delay: D,
    pulse_us: u32,
}

/// The trigger pin failed, or the source behind it did.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TriggerError<S, P> {
    /// The stereo source's own error.
    Source(S),
    /// The pin's own error.
    Pin(P),
}

impl<S: fmt::Display, P: fmt::Debug> fmt::Display for TriggerError<S, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Source(e) => write!(f, "{e}"),
            Self::Pin(e) => write!(f, "trigger pin: {e:?}"),
        }
    }
}

impl<S: StereoSource, P: OutputPin, D: DelayNs> Triggered<S, P, D> {
    /// Puts a trigger of `pulse_us` microseconds before every frame of `source`.
    pub fn new(source: S, pin: P, delay: D, pulse_us: u32) -> Self {
        Self { source, pin, delay, pulse_us }
    }

    /// Gives the source, the pin and the delay back.
    pub fn release(self) -> (S, P, D) {
        (self.source, self.pin, self.delay)
    }
}

impl<S: StereoSource, P: OutputPin, D: DelayNs> ErrorType for Triggered<S, P, D> {
    type Error = TriggerError<S::Error, P::Error>;
}

impl<S: StereoSource, P: OutputPin, D: DelayNs> StereoSource for Triggered<S, P, D> {
    fn format(&self) -> LineFormat {
        self.source.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.source.max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        let pin_error = |e| CameraError::Hardware(TriggerError::Pin(e));
        self.pin.set_high().map_err(pin_error)?;
        self.delay.delay_us(self.pulse_us);
        self.pin.set_low().map_err(pin_error)?;
        self.source.start_frame().map_err(|e| e.map_hardware(TriggerError::Source))
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        self.source.next_lines(left, right).map_err(|e| e.map_hardware(TriggerError::Source))
    }

    fn mask(&self, row: u16, masks: [&mut [u8]; 2]) -> bool {
        self.source.mask(row, masks)
    }
}
