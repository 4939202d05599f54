//! How much of the pictures the boards reached.

use super::View;
use stereopsis::geometry::camera::ImageSize;

/// The cells that a picture is divided into, along and down.
pub const CELLS: [usize; 2] = [8, 6];

/// The share of the cells of each camera's picture that hold a corner of a board in some view, left and
/// right: where there is none, the lens is not measured.
pub fn coverage(views: &[View], size: ImageSize) -> [f64; 2] {
    [0, 1].map(|camera| {
        let mut reached = [[false; CELLS[0]]; CELLS[1]];
        for corner in views.iter().flat_map(|view| &view.corners[camera]) {
            // A corner outside of the picture, by a part of a pixel, is in the cell at the border.
            let cell = |at: f64, length: u16, cells: usize| {
                ((at / f64::from(length) * cells as f64).max(0.0) as usize).min(cells - 1)
            };
            reached[cell(corner.y, size.height, CELLS[1])][cell(corner.x, size.width, CELLS[0])] = true;
        }
        let count = reached.as_flattened().iter().filter(|&&reached| reached).count();
        count as f64 / (CELLS[0] * CELLS[1]) as f64
    })
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
        let views = [View { corners: [left, right] }];
        assert_eq!(coverage(&views, size), [2.0 / 48.0, 2.0 / 48.0]);
    }
}
