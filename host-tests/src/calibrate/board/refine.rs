//! Corners to a small part of a pixel.

use super::Pattern;
use super::level::Level;
use nalgebra::{Matrix2, Point2, Vector2};

/// How a corner's window is chosen.
struct Windows<'a> {
    /// The half side as a share of the way to the nearest corner, the largest that will do.
    shares: &'a [f64],
    /// The least half side, px.
    least: f64,
    /// How far a corner may move: a share of that way, and px.
    move_share: f64,
    move_px: f64,
}

const PLAIN: Windows<'_> = Windows { shares: &[0.32, 0.25, 0.2], least: 2.5, move_share: 0.06, move_px: 0.5 };
/// Where a marker begins a tenth of a square from the corner, on both sides alike.
const MARKED: Windows<'_> = Windows { shares: &[0.09], least: 2.0, move_share: 0.0, move_px: 0.25 };
/// The largest half side, px.
const MOST: f64 = 12.0;
/// Squares of fewer px are small.
const SMALL: f64 = 12.0;
const STEPS: usize = 40;

/// Moves each corner to where all gradients around it point across the line to it (Förstner & Gülch 1987):
/// the least `sum w (g . (p - q))^2` over pixels q with gradients g, in a window that reaches to no other
/// corner. `None` when one goes astray. `level` has the picture's own size.
pub(super) fn refine(level: &Level, pattern: Pattern, corners: Vec<Point2<f64>>) -> Option<Vec<Point2<f64>>> {
    let place = |i: usize| corners.get(i).copied();
    let refined = (0..corners.len()).map(|i| near(level, &corners[i], spacing(pattern, i, place), &PLAIN));
    refined.collect()
}

/// Moves corners of a board with markers alike; those without a saddle, and those whose window the border
/// cuts off, are left out.
pub(super) fn refine_marked(
    level: &Level,
    pattern: Pattern,
    corners: &[(usize, Point2<f64>)],
) -> Vec<(usize, Point2<f64>)> {
    let place = |i: usize| corners.iter().find(|(number, _)| *number == i).map(|(_, place)| *place);
    let refined = corners.iter().filter_map(|&(i, corner)| {
        let spacing = spacing(pattern, i, place);
        let is_inside = level.is_inside(&corner, (0.1 * spacing).clamp(3.0, MOST));
        // It may have been found in a smaller picture.
        let saddle = level.saddle(&corner, 0.1 * spacing + 1.0)?;
        // The window is small: where it shows too little, the saddle is nearer.
        Some((i, near(level, &saddle, spacing, &MARKED).unwrap_or(saddle))).filter(|_| is_inside)
    });
    refined.collect()
}

/// The way from a corner to the nearest one beside it.
fn spacing(pattern: Pattern, i: usize, place: impl Fn(usize) -> Option<Point2<f64>>) -> f64 {
    let columns = pattern.columns();
    let (x, y) = (i % columns, i / columns);
    let beside = [
        (x > 0).then(|| i - 1),
        (x + 1 < columns).then_some(i + 1),
        i.checked_sub(columns),
        (y + 1 < pattern.rows()).then_some(i + columns),
    ];
    let ways = beside.into_iter().flatten().filter_map(|j| Some((place(j)? - place(i)?).norm()));
    ways.fold(f64::MAX, f64::min)
}

fn near(level: &Level, corner: &Point2<f64>, spacing: f64, windows: &Windows<'_>) -> Option<Point2<f64>> {
    // What is beside the outermost squares may be nearer than the squares are long.
    let most = windows.move_share * spacing + windows.move_px;
    let found = windows.shares.iter().find_map(|share| {
        let half = (share * spacing).clamp(windows.least, MOST);
        one(level, corner, half).filter(|found| (found - corner).norm() < most)
    });
    // Small squares that are blurred run into each other: then the saddle is as good as it gets.
    found.or((spacing < SMALL).then_some(*corner))
}

fn one(level: &Level, from: &Point2<f64>, half: f64) -> Option<Point2<f64>> {
    let reach = half.round() as i32;
    let patch = Patch::around(level, from, reach + half as i32 + 3);
    let side = 2 * reach + 1;
    let weights: Vec<f64> = (0..side * side)
        .map(|k| {
            let off = Vector2::new(f64::from(k % side - reach), f64::from(k / side - reach));
            (-off.norm_squared() / (half * half)).exp()
        })
        .collect();
    let mut place = *from;
    for _ in 0..STEPS {
        let (mut a, mut b) = (Matrix2::zeros(), Vector2::zeros());
        let at = patch.weights(&place);
        for (k, weight) in (0..).zip(&weights) {
            let (i, j) = (k % side - reach, k / side - reach);
            let off = Vector2::new(f64::from(i), f64::from(j));
            // A window that the border cuts off counts on the other side alone.
            if !level.is_inside(&(place + off), 1.0) {
                continue;
            }
            let g = patch.gradient(&at, i, j);
            let gg = g * g.transpose() * *weight;
            a += gg;
            b += gg * off;
        }
        let determinant = a.determinant();
        let least = 1e-9 * a.trace() * a.trace();
        if determinant.is_nan() || determinant <= least {
            return None;
        }
        let step = Vector2::new(a.m22 * b.x - a.m12 * b.y, a.m11 * b.y - a.m21 * b.x) / determinant;
        place += step;
        if (place - from).norm() > half + 1.0 {
            return None;
        }
        if step.norm() < 1e-3 {
            break;
        }
    }
    Some(place)
}

/// The gradients at the pixels around a place.
struct Patch {
    left: i32,
    top: i32,
    side: i32,
    gradients: Vec<Vector2<f64>>,
}

/// A place between four pixels: the first of them in the patch, and the parts of all.
struct Between {
    first: i32,
    parts: [f64; 4],
}

impl Patch {
    fn around(level: &Level, place: &Point2<f64>, reach: i32) -> Self {
        let (left, top) = (place.x.floor() as i32 - reach, place.y.floor() as i32 - reach);
        let side = 2 * reach + 2;
        let at = |x: i32, y: i32| f64::from(level.at(x as isize, y as isize));
        let gradients = (0..side * side).map(|k| {
            let (x, y) = (left + k % side, top + k / side);
            Vector2::new(at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)) / 2.0
        });
        Self { left, top, side, gradients: gradients.collect() }
    }

    fn weights(&self, place: &Point2<f64>) -> Between {
        let (x, y) = (place.x.floor(), place.y.floor());
        let (fx, fy) = (place.x - x, place.y - y);
        let first = (y as i32 - self.top) * self.side + x as i32 - self.left;
        Between { first, parts: [(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy] }
    }

    /// The gradient so many pixels from that place: the difference of brightness between pixels is the
    /// brightness' difference between pixels.
    fn gradient(&self, at: &Between, i: i32, j: i32) -> Vector2<f64> {
        let k = (at.first + j * self.side + i) as usize;
        let below = k + self.side as usize;
        let [a, b, c, d] = at.parts;
        let g = &self.gradients;
        g[k] * a + g[k + 1] * b + g[below] * c + g[below + 1] * d
    }
}
