//! How much of the pictures the boards reached.

use super::View;
use stereopsis::geometry::camera::ImageSize;

/// The cells that a picture is divided into, along and down.
pub const CELLS: [usize; 2] = [8, 6];

/// The cells of a picture that hold a corner of a board in some view: where there is none, the lens is not
/// measured.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Coverage {
    /// How many corners each cell holds, row by row.
    pub corners: [[u32; CELLS[0]]; CELLS[1]],
}

/// Columns and rows of cells at a border.
const BORDER: usize = 2;
/// The share of the cells of a corner or border that has to be reached.
const ENOUGH: f64 = 0.5;

/// The coverage of both cameras' pictures, left and right.
pub fn coverage(views: &[View], size: ImageSize) -> [Coverage; 2] {
    [0, 1].map(|camera| {
        let mut corners = [[0; CELLS[0]]; CELLS[1]];
        for corner in views.iter().flat_map(|view| &view.corners[camera]) {
            // A corner outside of the picture, by a part of a pixel, is in the cell at the border.
            let cell = |at: f64, length: u16, cells: usize| {
                ((at / f64::from(length) * cells as f64).max(0.0) as usize).min(cells - 1)
            };
            corners[cell(corner.y, size.height, CELLS[1])][cell(corner.x, size.width, CELLS[0])] += 1;
        }
        Coverage { corners }
    })
}

impl Coverage {
    /// The share of the cells that are reached.
    pub fn share(&self) -> f64 {
        let count = self.corners.as_flattened().iter().filter(|&&count| count > 0).count();
        count as f64 / (CELLS[0] * CELLS[1]) as f64
    }

    /// The corners and borders of the picture that boards hardly reached, by name; the corners of a border
    /// that is named are not named again.
    pub fn missing(&self) -> Vec<&'static str> {
        let [columns, rows] = CELLS;
        let (left, middle, right) = (0..BORDER, BORDER..columns - BORDER, columns - BORDER..columns);
        let (top, centre, bottom) = (0..BORDER, BORDER..rows - BORDER, rows - BORDER..rows);
        let is_bare = |rows: &std::ops::Range<usize>, columns: &std::ops::Range<usize>| {
            let cells = rows.clone().flat_map(|row| columns.clone().map(move |column| (row, column)));
            let reached = cells.filter(|&(row, column)| self.corners[row][column] > 0).count();
            (reached as f64) < ENOUGH * (rows.len() * columns.len()) as f64
        };
        let borders = [
            (is_bare(&top, &middle), "upper border"),
            (is_bare(&bottom, &middle), "lower border"),
            (is_bare(&centre, &left), "left border"),
            (is_bare(&centre, &right), "right border"),
        ];
        let corners = [
            (is_bare(&top, &left), "upper left corner", [0, 2]),
            (is_bare(&top, &right), "upper right corner", [0, 3]),
            (is_bare(&bottom, &left), "lower left corner", [1, 2]),
            (is_bare(&bottom, &right), "lower right corner", [1, 3]),
        ];
        let alone =
            corners.iter().filter(|(is_bare, _, beside)| *is_bare && !beside.iter().any(|&i| borders[i].0));
        let borders = borders.iter().filter(|(is_bare, _)| *is_bare).map(|(_, name)| *name);
        borders.chain(alone.map(|(_, name, _)| *name)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn corners_fill_the_cells_that_they_lie_in() {
        let size = ImageSize { width: 80, height: 60 };
        let left = vec![Point2::new(1.0, 1.0), Point2::new(9.0, 9.0), Point2::new(79.5, 59.5)];
        let right = vec![Point2::new(-0.3, 10.0), Point2::new(10.0, 10.0)];
        let views = [View::whole([left, right])];
        assert_eq!(coverage(&views, size).map(|c| c.share()), [2.0 / 48.0, 2.0 / 48.0]);
        assert_eq!(coverage(&views, size)[0].corners[0][..2], [2, 0]);
    }

    #[test]
    fn what_is_bare_is_named() {
        let mut all = Coverage { corners: [[1; 8]; 6] };
        assert_eq!((all.share(), all.missing()), (1.0, vec![]));
        // Three of the four cells of a corner.
        (all.corners[5][0], all.corners[5][1], all.corners[4][0]) = (0, 0, 0);
        assert_eq!(all.missing(), ["lower left corner"]);
        all.corners.iter_mut().for_each(|row| row[..2].fill(0));
        assert_eq!(all.missing(), ["left border"]);
    }
}
