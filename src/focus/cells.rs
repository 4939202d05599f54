//! The answers of a focus map by their places.

use super::{FocusPeak, NoFocus};

/// All answers of a map, row by row.
#[derive(Clone, Copy)]
pub(super) struct Cells<'a> {
    pub(super) peaks: &'a [Result<FocusPeak, NoFocus>],
    pub(super) columns: usize,
}

impl Cells<'_> {
    /// The answer of the cell in column `x` of row `y`, where there are both.
    pub(super) fn at(self, x: i32, y: i32) -> Option<FocusPeak> {
        self.peaks.get(self.index(x, y)?)?.ok()
    }

    /// The place of that cell among all; beyond them below the last row.
    pub(super) fn index(self, x: i32, y: i32) -> Option<usize> {
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        if x < self.columns { y.checked_mul(self.columns)?.checked_add(x) } else { None }
    }
}
