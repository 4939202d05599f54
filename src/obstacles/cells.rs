//! Cells of a frame, and what a fit and the labels need to know of their places.

use crate::units::Disparity;

/// Cells of a frame with the numbers of their geometry.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells<'a> {
    /// Disparities, `columns` in a row.
    pub(super) cells: &'a [Disparity],
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) cell_height: i64,
    pub(super) cell_width: i64,
    /// Column of the principal point, sixteenths of a px.
    pub(super) cx_16ths: i64,
    /// `doffs` in steps.
    pub(super) offset: i32,
    /// Parallax of the farthest distance that counts, steps.
    pub(super) farthest: i32,
}

impl Cells<'_> {
    /// Half-row of the middle of a row of cells.
    pub(super) fn halves(&self, row: usize) -> i64 {
        self.cell_height * (2 * row as i64 + 1) - 1
    }

    /// How far the middle of a column of cells is to the right of the principal point, sixteenths of a px.
    pub(super) fn right_16ths(&self, column: usize) -> i64 {
        self.cell_width * (16 * column as i64 + 8) - 8 - self.cx_16ths
    }

    /// Parallax of a cell, if it has an answer.
    pub(super) fn parallax(&self, column: usize, row: usize) -> Option<i32> {
        let d = self.cells.get(row * self.columns + column).filter(|d| d.is_some())?;
        Some(i32::from(d.raw()) + self.offset)
    }

    /// Half-rows and positions to the right of the outer columns in the middle and the lowest row.
    pub(super) fn corners(&self) -> [(i64, i64); 4] {
        let [upper, lower] = [self.rows / 2, self.rows.saturating_sub(1)].map(|row| self.halves(row));
        let [left, right] = [0, self.columns.saturating_sub(1)].map(|x| self.right_16ths(x));
        [(upper, left), (upper, right), (lower, left), (lower, right)]
    }

    /// Rows that a line has to reach over.
    pub(super) fn span(&self) -> usize {
        (self.rows / 8).max(2)
    }
}
