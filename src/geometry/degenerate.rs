//! Why correspondences leave F open.

use super::normalise::Normalisation;
use super::{Correspondence, EightPointError, Real, homography};
use nalgebra::Point2;

/// How far points may be off a line or a plane, normalised, and still count as on it: 0.0007 px in an image of 640 x 480,
/// root mean square. No measured point is as exact; what rounding leaves is less.
const ON_IT: f64 = 4e-6;

/// How many correspondences are not the same, counted up to N.
pub(super) fn distinct<T: Real, const N: usize>(seen: impl Iterator<Item = Correspondence<T>>) -> usize {
    let mut kept: [Option<Correspondence<T>>; N] = [None; N];
    for new in seen {
        for slot in &mut kept {
            match slot {
                Some(old) if *old == new => break,
                Some(_) => {}
                None => {
                    *slot = Some(new);
                    break;
                }
            }
        }
    }
    kept.iter().filter(|slot| slot.is_some()).count()
}

/// The reason by name, if there is one, why the equations of `count` correspondences have more than one solution.
pub(super) fn reason<T: Real>(
    seen: impl Iterator<Item = Correspondence<T>> + Clone,
    count: usize,
    first: &Normalisation<T>,
    second: &Normalisation<T>,
) -> Option<EightPointError> {
    if distinct::<T, 8>(seen.clone()) < 8 {
        return Some(EightPointError::Repeated);
    }
    let normalised = seen.map(|s| (first.apply(s.first), second.apply(s.second)));
    let most = T::of(ON_IT).max(T::EPSILON * T::of(32.0));
    let most = most * most * T::count(count);
    if off_line(normalised.clone().map(|(p, _)| p)) <= most || off_line(normalised.clone().map(|(_, q)| q)) <= most {
        return Some(EightPointError::Line);
    }
    let (h, _) = homography::solve(normalised.clone(), count);
    let off_plane = normalised.fold(T::ZERO, |sum, (p, q)| {
        let mapped = h * q.to_homogeneous();
        // Over the size of H q where it is at infinity: then p is far off as well.
        let w = mapped.z;
        sum + (mapped.xy() - p.coords * w).norm_squared() / (w * w).max(T::EPSILON)
    });
    (off_plane <= most).then_some(EightPointError::Plane)
}

/// The sum of the squared distances of centred points to the line that fits them best.
fn off_line<T: Real>(points: impl Iterator<Item = Point2<T>> + Clone) -> T {
    let (mut xx, mut xy, mut yy) = (T::ZERO, T::ZERO, T::ZERO);
    for p in points.clone() {
        xx += p.x * p.x;
        xy += p.x * p.y;
        yy += p.y * p.y;
    }
    let half = T::of(0.5);
    let difference = (xx - yy) * half;
    let root = (difference * difference + xy * xy).sqrt();
    // The direction of the larger eigenvalue, from the column that does not cancel.
    let (x, y) = if difference > T::ZERO { (difference + root, xy) } else { (xy, root - difference) };
    let size = x * x + y * y;
    if !(size > T::ZERO) {
        // As far from every line through the centre.
        return (xx + yy) * half;
    }
    points.fold(T::ZERO, |sum, p| {
        let across = p.x * y - p.y * x;
        sum + across * across / size
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_are_counted_once() {
        let seen = [1.0, 2.0, 1.0, 3.0, 2.0_f32].map(|u| Correspondence::new(u, 0.0, 0.0, 0.0));
        assert_eq!(distinct::<_, 8>(seen.into_iter()), 3);
        assert_eq!(distinct::<_, 2>(seen.into_iter()), 2);
    }

    #[test]
    fn distance_from_a_line() {
        let points =
            |off: f64| [(-2.0, -2.0 - off), (0.0, 2.0 * off), (2.0, 2.0 - off)].map(|(x, y)| Point2::new(x, y));
        assert!(off_line(points(0.0).into_iter()) < 1e-30);
        // Vertical, horizontal.
        assert_eq!(off_line([(0.0, -1.0), (0.0, 1.0_f64)].map(|(x, y)| Point2::new(x, y)).into_iter()), 0.0);
        assert_eq!(off_line([(-1.0, 0.0), (1.0, 0.0_f64)].map(|(x, y)| Point2::new(x, y)).into_iter()), 0.0);
        // A cross: as far from every line.
        let cross = [(-1.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0_f64)].map(|(x, y)| Point2::new(x, y));
        assert_eq!(off_line(cross.into_iter()), 2.0);
    }
}
