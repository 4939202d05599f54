//! Which corners an edge joins.

use super::corners::Corner;
use super::level::Level;
use nalgebra::Vector2;

/// For each corner and each of its four edges the corner at the edge's other end, and which of its edges
/// leads back.
pub(super) type Links = Vec<[Option<(usize, usize)>; 4]>;

/// How far the other end may be from where the edge points at first: the cosine of 25 degrees.
const TOWARDS: f64 = 0.906;
/// The nearest of so many corners in an edge's direction are tried.
const TRIED: usize = 6;

/// Joins corners that each find the other first.
pub(super) fn links(level: &Level, corners: &[Corner]) -> Links {
    let nearest: Links =
        (0..corners.len()).map(|i| std::array::from_fn(|edge| other_end(level, corners, i, edge))).collect();
    let is_mutual = |i: usize, edge: usize| {
        let (j, back) = nearest[i][edge]?;
        (nearest[j][back] == Some((i, edge))).then_some((j, back))
    };
    (0..corners.len()).map(|i| std::array::from_fn(|edge| is_mutual(i, edge))).collect()
}

/// The nearest corner along an edge.
fn other_end(level: &Level, corners: &[Corner], i: usize, edge: usize) -> Option<(usize, usize)> {
    let from = &corners[i];
    let direction = from.edges[edge];
    let mut ahead: Vec<(f64, usize, usize)> = Vec::new();
    for (j, to) in corners.iter().enumerate() {
        let way = to.place - from.place;
        let length = way.norm();
        if j == i || length < 3.0 || way.dot(&direction) < TOWARDS * length {
            continue;
        }
        // The edge that leads back has dark and bright on the other sides, as seen from there.
        let back =
            (0..4).find(|back| to.edges[*back].dot(&way) < -TOWARDS * length && (back + edge) % 2 == 1);
        if let Some(back) = back {
            ahead.push((length, j, back));
        }
    }
    ahead.sort_by(|a, b| a.0.total_cmp(&b.0));
    let found = ahead.into_iter().take(TRIED).find(|(_, j, _)| is_edge(level, from, &corners[*j], edge));
    found.map(|(_, j, back)| (j, back))
}

/// Whether it is bright on one side and dark on the other all along.
fn is_edge(level: &Level, from: &Corner, to: &Corner, edge: usize) -> bool {
    let way = to.place - from.place;
    let length = way.norm();
    let across = Vector2::new(-way.y, way.x) / length;
    let beside = (0.18 * length).clamp(1.2, 6.0);
    let sign = if edge.is_multiple_of(2) { 1.0 } else { -1.0 };
    let least = 0.35 * from.contrast.min(to.contrast);
    [0.25, 0.4, 0.5, 0.6, 0.75].iter().all(|&part| {
        let middle = from.place + part * way;
        let difference = level.value(&(middle + beside * across)) - level.value(&(middle - beside * across));
        sign * difference > 2.0 * least
    })
}
