//! Box filter: running sums over square windows, row by row.

/// The widest window's radius.
pub(super) const MOST_RADIUS: usize = 3;
const RING: usize = 2 * MOST_RADIUS + 1;

/// Rows of numbers to rows of their sums over windows of `2 r + 1` by `2 r + 1`; what lies outside the
/// picture counts as 0.
#[derive(Debug)]
pub(super) struct BoxFilter<const C: usize> {
    rows: [[u32; C]; RING],
    columns: [u32; C],
    width: usize,
    radius: usize,
    taken: usize,
}

impl<const C: usize> BoxFilter<C> {
    pub(super) const fn new() -> Self {
        Self { rows: [[0; C]; RING], columns: [0; C], width: 0, radius: 0, taken: 0 }
    }

    /// Forgets all rows.
    pub(super) fn begin(&mut self, width: usize, radius: usize) {
        self.width = width.min(C);
        self.radius = radius.min(MOST_RADIUS);
        self.taken = 0;
        self.columns.fill(0);
        self.rows.as_flattened_mut().fill(0);
    }

    /// The next row; below the picture, nothing. True if `out` has the sums around the row `r` rows before
    /// it.
    pub(super) fn push(&mut self, row: Option<&[u32]>, out: &mut [u32]) -> bool {
        let place = self.taken % (2 * self.radius + 1);
        self.taken += 1;
        if let Some(kept) = self.rows.get_mut(place) {
            // The row that stood here leaves the windows as the new one enters.
            let new = row.unwrap_or(&[]).iter().copied().chain(core::iter::repeat(0));
            for ((column, kept), new) in self.columns.iter_mut().zip(kept).zip(new).take(self.width) {
                *column = column.wrapping_sub(*kept).wrapping_add(new);
                *kept = new;
            }
        }
        if self.taken <= self.radius {
            return false;
        }
        let columns = self.columns.get(..self.width).unwrap_or(&[]);
        let zeros = core::iter::repeat(0);
        let mut entering = columns.iter().copied().chain(zeros.clone());
        let leaving = zeros.take(self.radius + 1).chain(columns.iter().copied());
        let mut sum: u32 = entering.by_ref().take(self.radius).sum();
        for ((place, enters), leaves) in out.iter_mut().take(self.width).zip(entering).zip(leaving) {
            sum = sum.wrapping_add(enters).wrapping_sub(leaves);
            *place = sum;
        }
        true
    }
}
