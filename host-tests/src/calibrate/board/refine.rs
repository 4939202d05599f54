//! Corners to a small part of a pixel.

use super::Pattern;
use super::level::Level;
use image::GrayImage;
use nalgebra::{Matrix2, Point2, Vector2};

/// The window's half side, as a share of the way to the nearest corner, the largest that will do; and its
/// bounds, px.
const SHARES: [f64; 3] = [0.32, 0.25, 0.2];
const BOUNDS: (f64, f64) = (2.5, 12.0);
/// Squares of fewer px are small.
const SMALL: f64 = 12.0;
const STEPS: usize = 40;

/// Moves each corner to where all gradients around it point across the line to it (Förstner & Gülch 1987):
/// the least `sum w (g . (p - q))^2` over pixels q with gradients g, in a window that reaches to no other
/// corner. `None` when one goes astray.
pub(super) fn refine(
    picture: &GrayImage,
    pattern: Pattern,
    corners: Vec<Point2<f64>>,
) -> Option<Vec<Point2<f64>>> {
    let level = Level::new(picture, 1.0);
    let columns = pattern.columns();
    let refined = corners.iter().enumerate().map(|(i, corner)| {
        let (x, y) = (i % columns, i / columns);
        let beside = [
            (x > 0).then(|| i - 1),
            (x + 1 < columns).then_some(i + 1),
            i.checked_sub(columns),
            (y + 1 < pattern.rows()).then_some(i + columns),
        ];
        let ways = beside.into_iter().flatten().map(|j| (corners[j] - corner).norm());
        let spacing = ways.fold(f64::MAX, f64::min);
        // What is beside the outermost squares may be nearer than the squares are long.
        SHARES
            .iter()
            .find_map(|share| {
                let half = (share * spacing).clamp(BOUNDS.0, BOUNDS.1);
                one(&level, corner, half).filter(|found| (found - corner).norm() < 0.06 * spacing + 0.5)
            })
            // Small squares that are blurred run into each other: then the saddle is as good as it gets.
            .or((spacing < SMALL).then_some(*corner))
    });
    refined.collect()
}

fn one(level: &Level, from: &Point2<f64>, half: f64) -> Option<Point2<f64>> {
    let reach = half.round() as i32;
    let mut place = *from;
    for _ in 0..STEPS {
        let (mut a, mut b) = (Matrix2::zeros(), Vector2::zeros());
        for (i, j) in (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| (i, j))) {
            let off = Vector2::new(f64::from(i), f64::from(j));
            let q = place + off;
            // A window that the border cuts off counts on the other side alone.
            if !level.is_inside(&q, 1.0) {
                continue;
            }
            let v = |dx: f64, dy: f64| f64::from(level.value(&Point2::new(q.x + dx, q.y + dy)));
            let g = Vector2::new(v(1.0, 0.0) - v(-1.0, 0.0), v(0.0, 1.0) - v(0.0, -1.0)) / 2.0;
            let weight = (-off.norm_squared() / (half * half)).exp();
            let gg = g * g.transpose() * weight;
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
