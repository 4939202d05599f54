//! Robust loss of a residual (Huber 1964), and its weight.

use crate::geometry::Real;

/// The loss of an observation's squared residual s, px^2; the cost of a problem is half the sum of it over
/// all observations.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Loss<T> {
    /// Least squares: s itself.
    Squares,
    /// Huber's with this width w, px: s up to `w^2`, `2 w sqrt(s) - w^2` beyond it, so that what is far off
    /// pulls with a force that does not grow (Huber 1964).
    Huber(T),
}

impl<T: Real> Loss<T> {
    /// The loss of a squared residual, px^2.
    pub fn of(&self, squared: T) -> T {
        match *self {
            Self::Huber(width) if squared > width * width => width * (T::of(2.0) * squared.sqrt() - width),
            _ => squared,
        }
    }

    /// Derivative of the loss, from 1 down: the weight of an observation in the equations of the next step.
    pub fn weight(&self, squared: T) -> T {
        match *self {
            Self::Huber(width) if squared > width * width => width / squared.sqrt(),
            _ => T::ONE,
        }
    }

    /// Whether the width is one.
    pub(super) fn is_sound(&self) -> bool {
        match *self {
            Self::Huber(width) => width > T::ZERO && width.is_finite(),
            Self::Squares => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Loss;

    #[test]
    fn far_off_counts_by_its_distance() {
        let loss = Loss::Huber(2.0_f64);
        assert_eq!((loss.of(4.0), loss.weight(4.0)), (4.0, 1.0));
        // 5 px: 2 (2 * 5 - 2) = 16, and the jacobian of 2 w sqrt(s) is w / sqrt(s).
        assert_eq!((loss.of(25.0), loss.weight(25.0)), (16.0, 0.4));
        assert_eq!((Loss::Squares.of(25.0), Loss::Squares.weight(25.0)), (25.0, 1.0));
    }
}
