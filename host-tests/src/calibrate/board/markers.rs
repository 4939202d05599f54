//! Markers in the white squares of a grid, and where on the board they say that the grid is: ChArUco boards,
//! of which a part is enough (Garrido-Jurado et al. 2014; An et al. 2018).

use super::Pattern;
use super::dictionary::Dictionary;
use super::grid::Grid;
use super::level::Level;
use nalgebra::{Point2, Vector2};
use std::collections::BTreeMap;

/// Markers in the white squares of a chessboard, numbered along its rows of squares.
#[derive(Clone, PartialEq, Debug)]
pub struct Markers {
    /// What they are.
    pub dictionary: Dictionary,
    /// The side of a marker with its black border, in squares.
    pub share: f64,
    /// Whether the first square of the board is white, as versions of OpenCV before 4.6 have it for an even
    /// number of rows of squares.
    pub begins_white: bool,
}

/// Corners that a part of a board has at least.
pub(super) const FEWEST: usize = 8;
/// What votes count: a marker without a wrong bit, one with one; and what the place of a grid needs.
const EXACT: u32 = 2;
const NEARLY: u32 = 1;
const LEAST_VOTES: u32 = 4;
/// The least difference between black and white, grey levels.
const LEAST_CONTRAST: f32 = 16.0;

/// How a grid lies on the board: a corner is `R^turns (i, j) + offset` of its place in the grid, where R
/// turns clockwise by a quarter.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
struct Lie {
    turns: u8,
    offset: (i32, i32),
}

impl Lie {
    fn place(self, at: (i32, i32)) -> (i32, i32) {
        let (x, y) = turned(at, self.turns);
        (x + self.offset.0, y + self.offset.1)
    }
}

fn turned(at: (i32, i32), turns: u8) -> (i32, i32) {
    (0..turns).fold(at, |(x, y), _| (-y, x))
}

impl Markers {
    /// The marker of a square, counted from the board's first one; `None` of a black one and of one that the
    /// dictionary has no marker for.
    pub fn number(&self, pattern: Pattern, square: (i32, i32)) -> Option<usize> {
        let (columns, rows) = (pattern.columns() as i32 + 1, pattern.rows() as i32 + 1);
        let inside = (0..columns).contains(&square.0) && (0..rows).contains(&square.1);
        let is_white = |(x, y): (i32, i32)| ((x + y) % 2 == 1) != self.begins_white;
        if !inside || !is_white(square) {
            return None;
        }
        let before = (0..square.1 * columns + square.0).filter(|i| is_white((i % columns, i / columns)));
        Some(before.count()).filter(|&number| number < self.dictionary.len())
    }

    /// The square of a marker.
    fn square(&self, pattern: Pattern, number: usize) -> Option<(i32, i32)> {
        let (columns, rows) = (pattern.columns() as i32 + 1, pattern.rows() as i32 + 1);
        let mut squares = (0..columns * rows).map(|i| (i % columns, i / columns));
        squares.find(|&square| self.number(pattern, square) == Some(number))
    }

    /// The corners of the pattern that a grid has, by their number in [`Pattern::places`]; `None` where its
    /// markers do not agree on where it is. `level` has the picture's own size, and the grid's places are in
    /// `of`.
    pub(super) fn locate(
        &self,
        pattern: Pattern,
        grid: &Grid,
        of: &Level,
        level: &Level,
    ) -> Option<Vec<(usize, Point2<f64>)>> {
        let mut votes: BTreeMap<Lie, u32> = BTreeMap::new();
        for (at, corners) in grid.squares() {
            let Some(code) = self.read(level, corners.map(|p| of.to_picture(&p))) else { continue };
            let Some(marker) = self.dictionary.recognise(code) else { continue };
            let Some(square) = self.square(pattern, marker.number) else { continue };
            // The square's first corner on the board is one of the four, whichever the turn brings there.
            let around = [(0, 0), (1, 0), (0, 1), (1, 1)];
            let ends = around.map(|(i, j)| turned((at.0 + i, at.1 + j), marker.turns));
            let least = ends.iter().fold(ends[0], |a, b| (a.0.min(b.0), a.1.min(b.1)));
            let offset = (square.0 - 1 - least.0, square.1 - 1 - least.1);
            let lie = Lie { turns: marker.turns, offset };
            *votes.entry(lie).or_default() += if marker.wrong == 0 { EXACT } else { NEARLY };
        }
        let (&lie, &most) = votes.iter().max_by_key(|(_, votes)| **votes)?;
        let second = votes.iter().filter(|(other, _)| **other != lie).map(|(_, votes)| *votes).max();
        if most < LEAST_VOTES || 2 * second.unwrap_or(0) > most {
            return None;
        }
        let (columns, rows) = (pattern.columns() as i32, pattern.rows() as i32);
        let mut found: Vec<_> = grid
            .places()
            .map(|(at, place)| (lie.place(at), place))
            .filter(|((x, y), _)| (0..columns).contains(x) && (0..rows).contains(y))
            .map(|((x, y), place)| ((y * columns + x) as usize, of.to_picture(&place)))
            .collect();
        found.sort_by_key(|(number, _)| *number);
        (found.len() >= FEWEST).then_some(found)
    }

    /// The bits of what is in a square with these corners, clockwise from the first one, if there is a black
    /// border around them.
    fn read(&self, level: &Level, corners: [Point2<f64>; 4]) -> Option<u64> {
        let square = Square::new(corners)?;
        let (side, first) = (self.dictionary.side() + 2, (1.0 - self.share) / 2.0);
        let step = self.share / side as f64;
        // The mean of nine places within a bit.
        let cell = |column: usize, row: usize| {
            let near = [0.3, 0.5, 0.7];
            let places = near.iter().flat_map(|y| near.iter().map(move |x| (*x, *y)));
            let sum: f32 = places
                .map(|(x, y)| {
                    let (u, v) = (first + step * (column as f64 + x), first + step * (row as f64 + y));
                    level.value(&square.at(u, v))
                })
                .sum();
            sum / 9.0
        };
        let cells: Vec<f32> = (0..side * side).map(|i| cell(i % side, i / side)).collect();
        let (least, most) = cells.iter().fold((f32::MAX, f32::MIN), |(a, b), &v| (a.min(v), b.max(v)));
        let is_white = |value: f32| value > (least + most) / 2.0;
        let is_border = |i: usize| [0, side - 1].contains(&(i % side)) || [0, side - 1].contains(&(i / side));
        let border = (0..side * side).filter(|&i| is_border(i) && is_white(cells[i])).count();
        if most - least < LEAST_CONTRAST || border > 0 {
            return None;
        }
        let inner = (0..side * side).filter(|&i| !is_border(i));
        Some(inner.fold(0, |bits, i| bits << 1 | u64::from(is_white(cells[i]))))
    }
}

/// The projective map of the unit square to four corners (Heckbert 1989, 2.2.3).
struct Square {
    origin: Point2<f64>,
    along: Vector2<f64>,
    down: Vector2<f64>,
    far: Vector2<f64>,
}

impl Square {
    fn new([a, b, c, d]: [Point2<f64>; 4]) -> Option<Self> {
        let sum = (a - b) + (c - d);
        let (u, v) = (b - c, d - c);
        let determinant = u.perp(&v);
        if determinant.abs() < 1e-9 {
            return None;
        }
        let far = Vector2::new(sum.perp(&v), u.perp(&sum)) / determinant;
        Some(Self { origin: a, along: b - a + far.x * b.coords, down: d - a + far.y * d.coords, far })
    }

    fn at(&self, u: f64, v: f64) -> Point2<f64> {
        let scale = 1.0 + self.far.x * u + self.far.y * v;
        Point2::from((self.origin.coords + self.along * u + self.down * v) / scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_maps_to_its_corners() {
        let corners = [(10.0, 20.0), (50.0, 25.0), (45.0, 70.0), (8.0, 60.0)].map(|(x, y)| Point2::new(x, y));
        let square = Square::new(corners).expect("a square");
        for (corner, (u, v)) in corners.iter().zip([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]) {
            assert!((square.at(u, v) - corner).norm() < 1e-9, "{corner}");
        }
    }

    #[test]
    fn markers_count_white_squares() {
        let dictionary = Dictionary::named("4x4_50").expect("a dictionary");
        let mut markers = Markers { dictionary, share: 0.75, begins_white: false };
        // 4 x 3 corners: 5 x 4 squares, of which the first is black, or white.
        let pattern = Pattern::new(4, 3).expect("a pattern");
        assert_eq!(markers.square(pattern, 4), Some((4, 1)));
        let numbers = |markers: &Markers, squares: [(i32, i32); 3]| {
            squares.map(|square| markers.number(pattern, square))
        };
        assert_eq!(numbers(&markers, [(0, 0), (1, 0), (3, 0)]), [None, Some(0), Some(1)]);
        assert_eq!(numbers(&markers, [(0, 1), (4, 1), (5, 1)]), [Some(2), Some(4), None]);
        markers.begins_white = true;
        assert_eq!(numbers(&markers, [(0, 0), (4, 0), (1, 1)]), [Some(0), Some(2), Some(3)]);
    }
}
