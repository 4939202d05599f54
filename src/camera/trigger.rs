//! A common hardware trigger for sensors that expose on a pulse.

use super::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};
use core::fmt;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;

/// A stereo source whose sensors expose together on a pulse of one pin.
///
/// [`start_frame`](StereoSource::start_frame) holds the pin high for the pulse's length, then waits for the
/// frame. The source has to wait for its frame: each repeat after a [`CameraError::WouldBlock`] is a pulse of
/// its own. A sensor that sends frames for as long as its pin is high, as an HM01B0 does
/// ([`Hm01b0Mode::Triggered`](super::Hm01b0Mode::Triggered)), needs its pin held until the last line, which
/// this does not do.
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

/// Failure of the trigger pin or of the source.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TriggerError<S, P> {
    /// Error of the stereo source.
    Source(S),
    /// Error of the pin.
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
    /// Triggers every frame of `source` by a pulse of `pulse_us` microseconds.
    pub fn new(source: S, pin: P, delay: D, pulse_us: u32) -> Self {
        Self { source, pin, delay, pulse_us }
    }

    /// Releases the source, the pin and the delay.
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
