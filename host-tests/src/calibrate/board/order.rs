//! Which corner is the first.

use super::grid::Block;
use super::{Board, Pattern};
use nalgebra::{Point2, Vector2};

/// The block's corners in the pattern's order: row by row, clockwise from a row to a column, so that a board
/// is never mirrored.
///
/// Where a board with an odd sum of columns and rows is turned by half a turn, bright and dark change places:
/// its first corner is that behind whose first edge it is bright. Of other boards the first row points as it
/// does in `like`, or to the right.
pub(super) fn order(block: &Block, pattern: Pattern, like: Option<&Board>) -> Vec<Point2<f64>> {
    let at = |x: usize, y: usize| block.places[y * block.columns + x];
    let (last_x, last_y) = (block.columns - 1, block.rows - 1);
    let (columns, rows) = (pattern.columns(), pattern.rows());
    let turned = |quarters: usize| -> Vec<Point2<f64>> {
        let place = |x: usize, y: usize| match quarters {
            0 => at(x, y),
            1 => at(last_x - y, x),
            2 => at(last_x - x, last_y - y),
            _ => at(y, last_y - x),
        };
        (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).map(|(x, y)| place(x, y)).collect()
    };
    // What bright and dark are behind the first edge of the first corner, of each way.
    let is_bright = |quarters: usize| {
        let steps = match quarters {
            0 => 0,
            1 => last_x,
            2 => last_x + last_y,
            _ => last_y,
        };
        block.is_bright ^ !(steps + quarters).is_multiple_of(2)
    };
    let fits = |quarters: &usize| {
        (block.columns, block.rows)
            == if quarters.is_multiple_of(2) { (columns, rows) } else { (rows, columns) }
    };
    let along = |corners: &[Point2<f64>]| (corners[columns - 1] - corners[0]).normalize();
    let wanted = like.map_or(Vector2::x(), |board| along(&board.corners));
    let ways = (0..4).filter(fits).map(|quarters| {
        let corners = turned(quarters);
        // Colour before direction.
        let score = along(&corners).dot(&wanted) + if is_bright(quarters) { 4.0 } else { 0.0 };
        (score, corners)
    });
    let best = ways.max_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or_else(Vec::new, |(_, corners)| corners)
}
