//! Error of the right camera's columns: its principal point and its yaw (after Hansen et al. 2012).

use crate::geometry::Real;

/// How the right camera of a pair differs from its calibration along the rows. A disparity in the middle is
/// off by `principal - yaw` focal lengths.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct RightColumns<T: Real> {
    /// What the column of the principal point lacks, in focal lengths.
    pub principal: T,
    /// How far the camera is turned to the right, radians.
    pub yaw: T,
}

impl<T: Real> RightColumns<T> {
    /// As calibrated. All zeros.
    pub const NONE: Self = Self { principal: T::ZERO, yaw: T::ZERO };

    /// What a disparity lacks by each of the two numbers, per unit, where the right camera sees a point at
    /// `x = X' / Z'`: a camera that is turned by a small angle w sees it at `x - w (1 + x^2)`.
    pub fn slopes(x: T) -> [T; 2] {
        [T::ONE, -(T::ONE + x * x)]
    }

    /// What has to be added to a disparity, in focal lengths, where the right camera sees a point at `x`.
    pub fn correction(&self, x: T) -> T {
        let [principal, yaw] = Self::slopes(x);
        principal * self.principal + yaw * self.yaw
    }

    /// Both errors together, of small angles.
    pub fn plus(&self, other: &Self) -> Self {
        Self { principal: self.principal + other.principal, yaw: self.yaw + other.yaw }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_of_two_milliradians() {
        // tan(atan(0.5) - 0.002) = 0.5 - 0.0025 to a millionth; in the middle it is 0.002.
        let turned = RightColumns { principal: 0.0, yaw: 0.002_f64 };
        let seen = (0.5_f64.atan() - 0.002).tan();
        assert!((seen - 0.5 - turned.correction(0.5)).abs() < 3e-6, "{seen}");
        assert!((turned.correction(0.0) + 0.002).abs() < 1e-12);
        // A principal point that stands 0.002 further right makes up for it there.
        let both = turned.plus(&RightColumns { principal: 0.002, yaw: 0.0 });
        assert!(both.correction(0.0).abs() < 1e-12);
    }
}
