//! The trait of a lens actuator.

/// What can go wrong with an actuator, kept apart so that wrappers can share it.
pub trait ActuatorErrorType {
    /// The hardware's error.
    type Error: core::fmt::Debug;
}

/// Where an actuator can go, and how.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ActuatorLimits {
    /// The least position, in the actuator's own steps; more moves the lens away from the sensor, to nearer
    /// focus.
    pub least: u16,
    /// The largest position.
    pub most: u16,
    /// From how many steps below a position it has to be approached, so that friction and slack are always
    /// on one side; 0 for an actuator that comes to the same place from either side.
    pub backlash: u16,
}

/// An actuator of a lens.
///
/// ```text
/// move_to(p) ---- settling_us ----> the lens stands at p: expose the next frame
/// ```
///
/// A command that failed may or may not have moved the lens; it can be given again.
pub trait LensActuator: ActuatorErrorType {
    /// Where it can go.
    fn limits(&self) -> ActuatorLimits;

    /// Begins to move to `position`, and does not wait. A position outside the limits is the nearest inside.
    fn move_to(&mut self, position: u16) -> Result<(), Self::Error>;

    /// How long a move between two positions takes until the lens rests.
    fn settling_us(&self, from: u16, to: u16) -> u32;
}

impl<A: ActuatorErrorType> ActuatorErrorType for &mut A {
    type Error = A::Error;
}

impl<A: LensActuator> LensActuator for &mut A {
    fn limits(&self) -> ActuatorLimits {
        A::limits(self)
    }

    fn move_to(&mut self, position: u16) -> Result<(), Self::Error> {
        A::move_to(self, position)
    }

    fn settling_us(&self, from: u16, to: u16) -> u32 {
        A::settling_us(self, from, to)
    }
}
