//! Which corners an edge joins.

use super::corners::Corner;
use super::level::Level;
use nalgebra::Vector2;

/// For each corner and each of its four edges the corner at the edge's other end, and which of its edges
/// leads back.
pub(super) type Links = Vec<[Option<(usize, usize)>; 4]>;

/// How the other end of an edge is looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Search {
    /// How far the other end may be from where the edge points at first, as a cosine.
    towards: f64,
    /// The nearest of so many corners in an edge's direction are tried.
    tried: usize,
    /// How far beside the edge brightness is looked at, in lengths of the edge.
    beside: f64,
}

impl Search {
    /// That of a plain chessboard: within 25 degrees.
    pub const PLAIN: Self = Self { towards: 0.906, tried: 6, beside: 0.18 };
    /// That of a board with markers in its white squares, whose bits have corners too, and which leave a
    /// margin of a tenth of a square: within 15 degrees.
    pub const MARKED: Self = Self { towards: 0.966, tried: 24, beside: 0.06 };
}

/// Joins corners that each find the other first.
pub(super) fn links(level: &Level, corners: &[Corner], search: Search) -> Links {
    let order = [0, 1].map(|axis| Order::new(corners, axis));
    let nearest: Links = (0..corners.len())
        .map(|i| std::array::from_fn(|edge| other_end(level, corners, &order, search, (i, edge))))
        .collect();
    let is_mutual = |i: usize, edge: usize| {
        let (j, back) = nearest[i][edge]?;
        (nearest[j][back] == Some((i, edge))).then_some((j, back))
    };
    (0..corners.len()).map(|i| std::array::from_fn(|edge| is_mutual(i, edge))).collect()
}

/// Corners in the order of their columns, or of their rows.
struct Order {
    corners: Vec<usize>,
    /// Where each corner is in it.
    places: Vec<usize>,
}

impl Order {
    fn new(corners: &[Corner], axis: usize) -> Self {
        let mut order: Vec<usize> = (0..corners.len()).collect();
        order.sort_by(|&a, &b| corners[a].place[axis].total_cmp(&corners[b].place[axis]));
        let mut places = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(&corner, place)| places[corner] = place);
        Self { corners: order, places }
    }

    /// The corners after one, or those before it, from there on.
    fn from(&self, corner: usize, is_after: bool) -> impl Iterator<Item = usize> {
        let place = self.places[corner];
        let (after, before) = match is_after {
            true => (&self.corners[place + 1..], &[][..]),
            false => (&[][..], &self.corners[..place]),
        };
        after.iter().chain(before.iter().rev()).copied()
    }
}

/// A corner in an edge's direction.
struct Ahead {
    square: f64,
    corner: usize,
    back: usize,
}

/// The nearest corner along an edge.
fn other_end(
    level: &Level,
    corners: &[Corner],
    order: &[Order; 2],
    search: Search,
    (i, edge): (usize, usize),
) -> Option<(usize, usize)> {
    let from = &corners[i];
    let direction = from.edges[edge];
    let axis = usize::from(direction.x.abs() < direction.y.abs());
    let mut ahead: Vec<Ahead> = Vec::with_capacity(search.tried + 1);
    for j in order[axis].from(i, direction[axis] > 0.0) {
        let to = &corners[j];
        let way = to.place - from.place;
        if ahead.get(search.tried - 1).is_some_and(|last| way[axis] * way[axis] > last.square) {
            break;
        }
        let (square, along) = (way.norm_squared(), way.dot(&direction));
        if along < 0.0 || along * along < search.towards * search.towards * square || square < 9.0 {
            continue;
        }
        // The edge that leads back has dark and bright on the other sides, as seen from there.
        let least = search.towards * square.sqrt();
        let back = (0..4).find(|back| to.edges[*back].dot(&way) < -least && (back + edge) % 2 == 1);
        if let Some(back) = back {
            let place = ahead.partition_point(|other| (other.square, other.corner) < (square, j));
            ahead.insert(place, Ahead { square, corner: j, back });
            ahead.truncate(search.tried);
        }
    }
    let found = ahead.iter().find(|ahead| is_edge(level, from, &corners[ahead.corner], edge, search.beside));
    found.map(|ahead| (ahead.corner, ahead.back))
}

/// Whether it is bright on one side and dark on the other all along.
fn is_edge(level: &Level, from: &Corner, to: &Corner, edge: usize, beside: f64) -> bool {
    let way = to.place - from.place;
    let length = way.norm();
    let across = Vector2::new(-way.y, way.x) / length;
    let beside = (beside * length).clamp(1.2, 6.0);
    let sign = if edge.is_multiple_of(2) { 1.0 } else { -1.0 };
    let least = 0.35 * from.contrast.min(to.contrast);
    [0.25, 0.4, 0.5, 0.6, 0.75].iter().all(|&part| {
        let middle = from.place + part * way;
        let difference = level.value(&(middle + beside * across)) - level.value(&(middle - beside * across));
        sign * difference > 2.0 * least
    })
}
