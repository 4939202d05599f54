//! Where two dark and two bright sectors meet.

use super::level::Level;
use nalgebra::{Point2, Vector2};
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// A corner where two edges cross.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Corner {
    pub place: Point2<f64>,
    /// The four edges that leave it, in order of their angles (clockwise on the screen). They begin with one
    /// behind which it is bright, and go on with one behind which it is dark, and so on.
    pub edges: [Vector2<f64>; 4],
    /// Half of the difference between bright and dark.
    pub contrast: f32,
}

/// Places around a corner that are looked at.
const AROUND: usize = 40;
/// Radii at which they are, px: the first that shows four sectors tells the edges, and smaller ones are for
/// small squares and corners near the border.
const RADII: [f64; 4] = [5.0, 4.0, 3.0, 2.2];
/// The least contrast, grey levels.
const LEAST_CONTRAST: f32 = 4.0;
/// The least saddle, squares of grey levels a square pixel.
const LEAST_SADDLE: f32 = 0.3;
/// The most saddles that are looked at, the strongest first.
const MOST: usize = 6000;

/// All corners of a level.
pub(super) fn find(level: &Level) -> Vec<Corner> {
    let (width, height) = (level.width as isize, level.height as isize);
    let mut strength = vec![0.0_f32; level.width * level.height];
    for y in 1..level.height.max(1) - 1 {
        let places = &mut strength[y * level.width + 1..];
        places.iter_mut().zip(level.saddles(y)).for_each(|(place, saddle)| *place = saddle);
    }
    let at = |x: isize, y: isize| strength[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
    let mut saddles = Vec::new();
    for (y, row) in (0..height).zip(strength.chunks_exact(level.width.max(1))) {
        for (x, &here) in (0..).zip(row).filter(|(_, here)| **here > LEAST_SADDLE) {
            let mut around = (-2..=2).flat_map(|j| (-2..=2).map(move |i| (i, j)));
            if around.all(|(i, j)| at(x + i, y + j) <= here) {
                saddles.push((here, Point2::new(x as f64, y as f64)));
            }
        }
    }
    saddles.sort_by(|a, b| b.0.total_cmp(&a.0));
    saddles.truncate(MOST);
    let mut corners: Vec<Corner> = Vec::new();
    for (_, place) in saddles {
        let Some(corner) = level.saddle(&place, 2.0).and_then(|place| look(level, place)) else { continue };
        if corners.iter().all(|other| (other.place - corner.place).norm() > 2.0) {
            corners.push(corner);
        }
    }
    corners
}

/// The direction of the i-th place around a corner.
static CIRCLE: LazyLock<[Vector2<f64>; AROUND]> =
    LazyLock::new(|| std::array::from_fn(|i| towards(angle(i as f64))));

fn angle(i: f64) -> f64 {
    i * TAU / AROUND as f64
}

fn towards(angle: f64) -> Vector2<f64> {
    Vector2::new(angle.cos(), angle.sin())
}

/// The corner at a place, if one is there.
pub(super) fn look(level: &Level, place: Point2<f64>) -> Option<Corner> {
    RADII.iter().find_map(|&radius| sectors(level, place, radius))
}

fn sectors(level: &Level, place: Point2<f64>, radius: f64) -> Option<Corner> {
    if !level.is_inside(&place, radius) {
        return None;
    }
    let ring: [f32; AROUND] = CIRCLE.each_ref().map(|way| level.value(&(place + radius * way)));
    let (least, most) = ring.iter().fold((f32::MAX, f32::MIN), |(a, b), &v| (a.min(v), b.max(v)));
    let (middle, contrast) = ((least + most) / 2.0, (most - least) / 2.0);
    if contrast < LEAST_CONTRAST {
        return None;
    }
    // Opposite places look alike.
    let unlike: f32 = (0..AROUND / 2).map(|i| (ring[i] - ring[i + AROUND / 2]).abs()).sum();
    if unlike / (AROUND / 2) as f32 > 0.7 * contrast {
        return None;
    }
    let mut crossings = Vec::new();
    for i in 0..AROUND {
        let (here, next) = (ring[i] - middle, ring[(i + 1) % AROUND] - middle);
        if (here < 0.0) != (next < 0.0) {
            let part = f64::from(here / (here - next));
            crossings.push((angle(i as f64 + part), here < 0.0));
        }
    }
    if crossings.len() != 4 {
        return None;
    }
    let first = crossings.iter().position(|(_, becomes_bright)| *becomes_bright)?;
    crossings.rotate_left(first);
    let edges: [Vector2<f64>; 4] = std::array::from_fn(|i| towards(crossings[i].0));
    // Edges go on behind the corner, and the two differ.
    let is_straight = (0..2).all(|i| edges[i].dot(&edges[i + 2]) < -0.85);
    let is_wide = (0..4).all(|i| edges[i].dot(&edges[(i + 1) % 4]).abs() < 0.97);
    (is_straight && is_wide).then_some(Corner { place, edges, contrast })
}
