//! Degenerate configurations, which leave F open (Hartley & Zisserman 2004, 11.9).

use super::weighted::Weighted;
use crate::geometry::Real;

/// Why correspondences give no fundamental matrix.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum EightPointError {
    /// Fewer than eight correspondences.
    TooFew,
    /// A number is infinite or not a number.
    NotFinite,
    /// Fewer than eight correspondences that are not the same.
    Repeated,
    /// In one of the images all points are on a line.
    Line,
    /// One homography maps all points: they are on a plane, or the camera has only rotated.
    Plane,
    /// Two or more matrices fit, for no reason of the above: all points and both camera centres are on one
    /// quadric, such as a sphere, a cylinder or a pair of planes.
    Undetermined,
}

error_text!(EightPointError {
    Self::TooFew => "a fundamental matrix needs eight correspondences",
    Self::NotFinite => "a coordinate is not finite",
    Self::Repeated => "a fundamental matrix needs eight correspondences that are not the same",
    Self::Line => "the points of an image are on a line",
    Self::Plane => "the points are on a plane, or the camera has only rotated: a homography is the answer",
    Self::Undetermined => "more than one fundamental matrix fits the points",
});

/// How far points may be off a line or a plane, normalised, and still count as on it: 0.0007 px in an image
/// of 640 x 480 (in `f32` more, for the rounding).
/// No measured point is as exact; what rounding leaves is less.
pub(crate) const ON_IT: f64 = 4e-6;

/// What counts as nothing in a matrix that should have no determinant, or no cofactors, at size one.
const NOTHING: f64 = 1e-3;

/// How many correspondences are not the same, counted up to N.
pub(crate) fn distinct<T: Real, const N: usize>(seen: Weighted<'_, T>) -> usize {
    let (mut kept, mut count) = ([[T::ZERO; 4]; N], 0);
    for (s, _) in seen.iter() {
        let new = [s.first.x, s.first.y, s.second.x, s.second.y];
        if kept.iter().take(count).any(|old| *old == new) {
            continue;
        }
        let Some(slot) = kept.get_mut(count) else { break };
        *slot = new;
        count += 1;
    }
    count
}

/// The reason by name why the equations of correspondences have a solution too many, if there is one. F is
/// any of the solutions, at size one; `rank` is that of the equations.
///
/// On a plane they have rank six, and `F = [e]x H` for every e: none is of rank three. When all points of an
/// image are on a line l, `F = l v^T` for every v: all are of rank one. On lines of both images the equations
/// have rank four at most.
pub(crate) fn reason<T: Real>(
    seen: Weighted<'_, T>,
    rank: usize,
    determinant: T,
    cofactors: &[[T; 3]; 3],
) -> Option<EightPointError> {
    let nothing = T::of(NOTHING);
    if distinct::<T, 8>(seen) < 8 {
        Some(EightPointError::Repeated)
    } else if rank >= 7 {
        None
    } else if rank <= 5 || cofactors.as_flattened().iter().all(|x| x.abs() <= nothing) {
        Some(EightPointError::Line)
    } else if determinant.abs() <= nothing {
        Some(EightPointError::Plane)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::two_view::Correspondence;

    #[test]
    fn the_same_are_counted_once() {
        let seen = [1.0, 2.0, 1.0, 3.0, 2.0_f32].map(|u| Correspondence::new(u, 0.0, 0.0, 0.0));
        assert_eq!(distinct::<_, 8>(Weighted::alike(&seen)), 3);
        assert_eq!(distinct::<_, 2>(Weighted::alike(&seen)), 2);
    }
}
