//! The winner between whole pixels.
//!
//! A census cost grows about linearly to both sides of its minimum, so that two lines of opposite slope fit
//! it better than a parabola: the equiangular fit (Shimizu & Okutomi 2002, for sums of absolute differences).
//! With a and b the rise to the disparity below and above,
//!
//! `f = (a - b) / (2 max(a, b))`
//!
//! Along paths, a disparity beside the winner costs a step more wherever a surface is slanted, which
//! would pull answers to whole pixels: so much of the steeper rise is not counted
//! ([`SLANT_COST`](crate::matching::backend::parameters::MethodParameters::SLANT_COST)).
//!
//! On a rendered slanted plane the parabola's error was half again as large, for both windows, and its
//! answers crowded to whole pixels.

use crate::matching::memory::winners::Winner;
use crate::units::Disparity;

/// The disparity of a winner whose search began at `min_disparity` px, rounded to the nearest 1/32 px; `step`
/// of the steeper rise is not counted.
#[inline(always)]
pub(super) fn refine(winner: Winner, min_disparity: u32, step: u32) -> Disparity {
    let whole = (min_disparity + winner.disparity()) * u32::from(Disparity::ONE);
    let (a, b) = winner.rises();
    let steepest = a.max(b).saturating_sub(step).max(a.abs_diff(b));
    let half = u32::from(Disparity::ONE / 2);
    // A steepest rise of 0 is a flat minimum: no fraction. `max(1)` keeps the division defined.
    let fraction = (a.abs_diff(b) * half + steepest / 2) / steepest.max(1);
    // The fraction is 0 at the smallest disparity, which has nothing below.
    let steps = if a < b { whole.wrapping_sub(fraction) } else { whole.wrapping_add(fraction) };
    Disparity::from_raw(steps as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refined(below: u8, cost: u8, above: u8) -> u16 {
        refine(Winner::new(cost, 10, (below, above)), 0, 0).raw()
    }

    #[test]
    fn leans_to_the_cheaper_neighbour() {
        assert_eq!(refined(30, 10, 30), 320);
        assert_eq!(refined(30, 10, 10), 320 + 16);
        assert_eq!(refined(20, 10, 30), 320 - 8);
        assert_eq!(refined(10, 10, 10), 320);
    }
}
