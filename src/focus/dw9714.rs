//! Dongwoon's DW9714: a 10-bit current for the voice coil of a small lens, over I2C.
//!
//! A write is two bytes, as Linux's drivers of the chip send them (`drivers/media/i2c/dw9714.c`): `PD FLAG
//! D9..D4` and `D3..D0 S3..S0`. PD powers the coil down, FLAG is 0 in writes and 1 in reads while the coil
//! still moves, D is the current in 1023rds of 100 mA, and S is how it gets there: 0 at once, else `S3 S2`
//! codes at a time (1, 2, 4), one every 81 us times 2 to the power of `S1 S0`.

use super::actuator::{ActuatorErrorType, ActuatorLimits, LensActuator};
use embedded_hal::i2c::I2c;

/// The slew of the current.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Slew {
    /// At once: fastest, and the lens rings.
    Direct,
    /// Four codes every 81 us times 2 to this power, 0 to 3.
    Linear(u8),
    /// Four codes every 162 us: 41 ms from end to end.
    #[default]
    Usual,
}

impl Slew {
    /// `S3..S0`.
    const fn bits(self) -> u8 {
        match self {
            Self::Direct => 0,
            Self::Linear(period) => 0b1100 | if period > 3 { 3 } else { period },
            Self::Usual => 0b1101,
        }
    }

    /// Codes are changed four at a time, once in so many microseconds; 0 is at once.
    const fn period_us(self) -> u32 {
        match self {
            Self::Direct => 0,
            _ => 81 << (self.bits() & 3),
        }
    }
}

/// A DW9714 on an I2C bus.
///
/// The chip does not report where the lens is; [`Dw9714::is_moving`] says if the current still changes. A
/// coil has no friction to speak of and one position for each current; it rings after a move, which [`Slew`]
/// makes less of.
#[derive(Debug)]
pub struct Dw9714<I> {
    bus: I,
    slew: Slew,
}

impl<I: I2c> Dw9714<I> {
    /// Address on the bus, 7 bits.
    pub const ADDRESS: u8 = 0x0c;
    /// The largest current.
    pub const MOST: u16 = 1023;
    /// How long the lens rings after the current has reached its value.
    pub const RINGING_US: u32 = 12_000;

    /// A chip on that bus. Nothing is sent.
    pub const fn new(bus: I, slew: Slew) -> Self {
        Self { bus, slew }
    }

    /// Sets the slew's clock to its default, of 81 us: the chip powers up with it, and another driver may
    /// have changed it. The registers are protected: they are unlocked, written, locked.
    pub fn initialise(&mut self) -> Result<(), I::Error> {
        for bytes in [[0xec, 0xa3], [0xa1, 0x00], [0xf2, 0x00], [0xdc, 0x51]] {
            self.bus.write(Self::ADDRESS, &bytes)?;
        }
        Ok(())
    }

    /// Switches the coil's current off: the lens falls to its rest. [`LensActuator::move_to`] switches it on.
    pub fn power_down(&mut self) -> Result<(), I::Error> {
        self.bus.write(Self::ADDRESS, &[0x80, 0x00])
    }

    /// Whether the current is still on its way.
    pub fn is_moving(&mut self) -> Result<bool, I::Error> {
        let mut bytes = [0; 2];
        self.bus.read(Self::ADDRESS, &mut bytes)?;
        let [high, _] = bytes;
        Ok(high & 0x40 != 0)
    }

    /// Gives the bus back.
    pub fn release(self) -> I {
        self.bus
    }
}

impl<I: I2c> ActuatorErrorType for Dw9714<I> {
    type Error = I::Error;
}

impl<I: I2c> LensActuator for Dw9714<I> {
    fn limits(&self) -> ActuatorLimits {
        ActuatorLimits { least: 0, most: Self::MOST, backlash: 0 }
    }

    fn move_to(&mut self, position: u16) -> Result<(), I::Error> {
        let code = position.min(Self::MOST);
        self.bus.write(Self::ADDRESS, &[(code >> 4) as u8, (code << 4) as u8 | self.slew.bits()])
    }

    fn settling_us(&self, from: u16, to: u16) -> u32 {
        let moves = u32::from(from.min(Self::MOST).abs_diff(to.min(Self::MOST))).div_ceil(4);
        moves * self.slew.period_us() + Self::RINGING_US
    }
}
