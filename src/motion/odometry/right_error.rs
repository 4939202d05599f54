//! What the right camera of a pair is off by (after Hansen et al. 2012, and rows by Longuet-Higgins & Prazdny
//! 1980).

use crate::geometry::Real;

/// How the right camera of a pair differs from its calibration. The first two numbers move columns alone, and
/// show in no row: a disparity in the middle is off by `principal - yaw` focal lengths. The others show in
/// rows, and two of them move columns, too.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct RightError<T: Real> {
    /// What the column of the principal point lacks, in focal lengths.
    pub principal: T,
    /// How far the camera is turned to the right, radians.
    pub yaw: T,
    /// How much lower than it should the camera sees what is in the middle, in focal lengths.
    pub row: T,
    /// How far the camera is turned about its own axis, radians: what is on its right stands lower.
    pub roll: T,
    /// By what share of itself the focal length is longer.
    pub scale: T,
}

impl<T: Real> RightError<T> {
    /// As calibrated. All zeros.
    pub const NONE: Self =
        Self { principal: T::ZERO, yaw: T::ZERO, row: T::ZERO, roll: T::ZERO, scale: T::ZERO };

    /// What a disparity lacks by the first two numbers, per unit, where the right camera sees a point at `x =
    /// X' / Z'`: a camera that is turned by a small angle w sees it at `x - w (1 + x^2)`.
    pub fn slopes(x: T) -> [T; 2] {
        [T::ONE, -(T::ONE + x * x)]
    }

    /// What has to be added to a disparity in the middle, in focal lengths.
    pub fn in_middle(&self) -> T {
        self.principal - self.yaw
    }

    /// The most that the roll or the scale adds to a disparity a quarter of a focal length from the middle,
    /// in focal lengths.
    pub fn aside(&self) -> T {
        self.roll.abs().max(self.scale.abs()) * T::of(0.25)
    }

    /// What has to be added to a disparity, in focal lengths, where the right camera sees a point at `(x,
    /// y)`: one that is turned by a small angle w about its axis sees it at `x - w y`.
    pub fn correction(&self, [x, y]: [T; 2]) -> T {
        let [principal, yaw] = Self::slopes(x);
        principal * self.principal + yaw * self.yaw - self.roll * y + self.scale * x
    }

    /// What moves a row by each of the last three numbers, per unit, at `(x, y)`.
    pub fn row_slopes([x, y]: [T; 2]) -> [T; 3] {
        [T::ONE, x, y]
    }

    /// How much lower than it should the right camera sees a point at `(x, y)`, in focal lengths.
    pub fn row_at(&self, place: [T; 2]) -> T {
        let [row, roll, scale] = Self::row_slopes(place);
        row * self.row + roll * self.roll + scale * self.scale
    }

    /// What shows in no row, and what does.
    pub fn parts(&self) -> [Self; 2] {
        let Self { principal, yaw, .. } = *self;
        [Self { principal, yaw, ..Self::NONE }, Self { principal: T::ZERO, yaw: T::ZERO, ..*self }]
    }

    /// Both errors together, of small angles.
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            principal: self.principal + other.principal,
            yaw: self.yaw + other.yaw,
            row: self.row + other.row,
            roll: self.roll + other.roll,
            scale: self.scale + other.scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_of_two_milliradians() {
        // tan(atan(0.5) - 0.002) = 0.5 - 0.0025 to a millionth; in the middle it is 0.002.
        let turned = RightError { yaw: 0.002_f64, ..RightError::NONE };
        let seen = (0.5_f64.atan() - 0.002).tan();
        assert!((seen - 0.5 - turned.correction([0.5, 0.0])).abs() < 3e-6, "{seen}");
        assert!((turned.correction([0.0, 0.0]) + 0.002).abs() < 1e-12);
        // A principal point that stands 0.002 further right makes up for it there.
        let both = turned.plus(&RightError { principal: 0.002, ..RightError::NONE });
        assert!(both.correction([0.0, 0.0]).abs() < 1e-12);
    }

    #[test]
    fn a_roll_and_a_longer_lens_move_rows_and_columns() {
        // (0.3, 0.2) turned by 0.01 is (0.298, 0.203), to 2e-5; disparities grow by what columns lose.
        let rolled = RightError { roll: 0.01_f64, ..RightError::NONE };
        let (sin, cos) = 0.01_f64.sin_cos();
        let seen = [0.3 * cos - 0.2 * sin, 0.3 * sin + 0.2 * cos];
        assert!((rolled.row_at([0.3, 0.2]) - (seen[1] - 0.2)).abs() < 2e-5);
        assert!((rolled.correction([0.3, 0.2]) - (seen[0] - 0.3)).abs() < 2e-5);
        // Two in a hundred longer: all is so much further out.
        let longer = RightError { scale: 0.02_f64, ..RightError::NONE };
        assert!((longer.row_at([0.3, 0.2]) - 0.004).abs() < 1e-12);
        assert!((longer.correction([0.3, 0.2]) - 0.006).abs() < 1e-12);
    }
}
