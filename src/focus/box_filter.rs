//! Box filter: running sums over square windows, row by row.

/// The widest window's radius.
pub(super) const MOST_RADIUS: usize = 3;
const RING: usize = 2 * MOST_RADIUS + 1;

/// Rows of numbers to rows of their sums over windows of `2 r + 1` by `2 r + 1`; what lies outside the
/// picture counts as 0.
pub(super) struct BoxFilter<'a> {
    /// The last rows in a ring, then the sums down the columns.
    pub memory: &'a mut [u32],
    pub width: usize,
    pub radius: usize,
    /// Rows that came.
    pub taken: &'a mut usize,
}

impl BoxFilter<'_> {
    /// Numbers that it keeps for each column.
    pub(super) const ROWS: usize = RING + 1;

    /// The next row, or, below the picture, nothing. True if `row` now has the sums around the row `r` rows
    /// before it.
    pub(super) fn push(&mut self, is_inside: bool, row: &mut [u32]) -> bool {
        let place = *self.taken % (2 * self.radius + 1);
        *self.taken += 1;
        let (rows, columns) = self.memory.split_at_mut_checked(RING * self.width).unwrap_or_default();
        let begin = place * self.width;
        let kept = rows.get_mut(begin..begin + self.width).unwrap_or_default();
        // The row that stood here leaves the windows as the new one enters.
        for ((column, kept), &mut new) in columns.iter_mut().zip(kept).zip(row.iter_mut()) {
            let new = if is_inside { new } else { 0 };
            *column = column.wrapping_sub(*kept).wrapping_add(new);
            *kept = new;
        }
        if *self.taken <= self.radius {
            return false;
        }
        let columns = columns.get(..self.width).unwrap_or_default();
        let zeros = core::iter::repeat(0);
        let mut entering = columns.iter().copied().chain(zeros.clone());
        let leaving = zeros.take(self.radius + 1).chain(columns.iter().copied());
        let mut sum: u32 = entering.by_ref().take(self.radius).sum();
        for ((place, enters), leaves) in row.iter_mut().zip(entering).zip(leaving) {
            sum = sum.wrapping_add(enters).wrapping_sub(leaves);
            *place = sum;
        }
        true
    }
}
