//! Why matches have no fundamental matrix.

use nalgebra::{Matrix2, Point2, Vector2};
use std::collections::HashSet;
use std::fmt;
use stereopsis::geometry::two_view::Correspondence;

/// Up to so many pixels two places are one, and a point is on a line.
const SAME_PX: f64 = 0.5;
/// Different matches of which fewer have no fundamental matrix.
const FEWEST: usize = 8;

/// What is special about matches.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Degenerate {
    /// Only so many are different.
    Few(usize),
    /// They lie on a line in one of the images.
    Line,
    /// None of them moves from image to image.
    Still,
    /// All of them move by the same.
    Shift,
}

impl fmt::Display for Degenerate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Few(count) => write!(f, "only {count} matches are different; {FEWEST} are needed"),
            Self::Line => {
                f.write_str("the matches lie on a line; some that are spread over both images are needed")
            }
            Self::Still => f.write_str(
                "no match moves from image to image: they are of one place, or the same picture twice",
            ),
            Self::Shift => f.write_str(
                "all matches move by the same: what they show is on a plane, or the camera has only rotated",
            ),
        }
    }
}

/// What is special about matches, if anything is that leaves them without a fundamental matrix.
pub fn degenerate(matches: &[Correspondence<f64>]) -> Option<Degenerate> {
    // Coordinates that are equal to the bit.
    let bits = |s: &Correspondence<f64>| [s.first.x, s.first.y, s.second.x, s.second.y].map(f64::to_bits);
    let different = matches.iter().map(bits).collect::<HashSet<_>>().len();
    if different < FEWEST {
        return Some(Degenerate::Few(different));
    }
    let is_line = |place: fn(&Correspondence<f64>) -> Point2<f64>| {
        spread_px(matches.iter().map(|s| place(s).coords)).is_none_or(|[least, _]| least < SAME_PX)
    };
    if is_line(|s| s.first) || is_line(|s| s.second) {
        return Some(Degenerate::Line);
    }
    let ways = || matches.iter().map(|s| s.second - s.first);
    if ways().all(|way| way.amax() < SAME_PX) {
        return Some(Degenerate::Still);
    }
    spread_px(ways()).filter(|[_, most]| *most < SAME_PX).map(|_| Degenerate::Shift)
}

/// The least and the greatest standard deviation of places, along any direction.
fn spread_px(places: impl Iterator<Item = Vector2<f64>> + Clone) -> Option<[f64; 2]> {
    let count = places.clone().count() as f64;
    let middle = places.clone().sum::<Vector2<f64>>() / count;
    let squares = places.map(|place| (place - middle) * (place - middle).transpose()).sum::<Matrix2<f64>>();
    let mut both = (squares / count).symmetric_eigenvalues().map(|square| square.max(0.0).sqrt());
    if !both.iter().all(|px| px.is_finite()) {
        return None;
    }
    both.as_mut_slice().sort_by(f64::total_cmp);
    Some([both[0], both[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Matches of places that are spread, and where those go.
    fn matches(
        place: impl Fn(f64) -> [f64; 2],
        to: impl Fn([f64; 2]) -> [f64; 2],
    ) -> Vec<Correspondence<f64>> {
        let of = |i: i32| {
            let first = place(f64::from(i));
            Correspondence { first: first.into(), second: to(first).into() }
        };
        (0..20).map(of).collect()
    }

    #[test]
    fn each_is_told_from_the_others() {
        let spread = |i: f64| [37.0 * i % 640.0, 91.0 * i % 480.0];
        let moved = |[x, y]: [f64; 2]| [x - 3.0 - 20.0 * (x * y % 7.0), y];
        assert_eq!(degenerate(&matches(spread, moved)), None);
        assert_eq!(degenerate(&matches(|_| [5.0, 6.0], moved)), Some(Degenerate::Few(1)));
        assert_eq!(degenerate(&matches(|i| [9.0 * i, 5.0 * i + 3.0], moved)), Some(Degenerate::Line));
        assert_eq!(degenerate(&matches(spread, |[x, y]| [x + 0.1, y])), Some(Degenerate::Still));
        assert_eq!(degenerate(&matches(spread, |[x, y]| [x - 10.0, y])), Some(Degenerate::Shift));
        assert_eq!(degenerate(&[]), Some(Degenerate::Few(0)));
    }
}
