//! Focus measures summed over windows, row by row.

use super::config::FocusLineError;
use super::focus_measures::{binomial, laplacian, modified_laplacian, tenengrad};
use crate::imaging::RowRing;

/// Radius of the widest window.
const MOST_RADIUS: usize = 3;
const RING: usize = 2 * MOST_RADIUS + 1;

/// What is summed up over a window of `n` pixels, and how large it can be with the widest, of 49.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Measure {
    /// The sum of the modified Laplacian of smoothed rows, in 1/16 grey level: 799 680. The default: least
    /// hurt by noise.
    #[default]
    Robust,
    /// The sum of the modified Laplacian (Nayar & Nakagawa 1994): 49 980.
    ModifiedLaplacian,
    /// The sum of squared gradients (Krotkov 1987): 101 959 200.
    Tenengrad,
    /// `n` times the sum of squares of the Laplacian less the square of its sum: `n^2` times its variance
    /// (Pech-Pacheco et al. 2000), 2 496 960 000.
    LaplacianVariance,
}

/// Lines to rows of a measure over windows of `2 r + 1` by `2 r + 1` pixels; what lies outside the picture is
/// left out.
///
/// `W` is the longest line. No sum can overflow its 32 bits: [`Measure`] has the largest. Takes 45 bytes for
/// every pixel of a line, and [`Self::push`] another 12 of stack.
///
/// ```
/// use stereopsis::focus::{Measure, SharpnessRows};
/// let mut rows = SharpnessRows::<8>::new();
/// rows.start(4, 3, Measure::ModifiedLaplacian, 1);
/// let mut sums = Vec::new();
/// for line in [[0, 0, 0, 0], [0, 9, 0, 0], [0, 0, 0, 0]] {
///     rows.push(&line, |_, row| sums.push(row.to_vec()))?;
/// }
/// // The spot counts 36, its four neighbours 9 each.
/// assert_eq!(sums[1], [63, 72, 63, 9]);
/// # Ok::<(), stereopsis::focus::FocusLineError>(())
/// ```
#[derive(Debug)]
pub struct SharpnessRows<const W: usize> {
    measure: Measure,
    radius: usize,
    width: usize,
    height: u16,
    taken: u16,
    rows_out: usize,
    points: usize,
    /// The last three lines, and the last three smoothed rows.
    raw: [[u8; 3]; W],
    smooth: [[u16; 3]; W],
    /// The points' values of the rows in the window, and their sums down the columns; the Laplacian has its
    /// squares beside.
    values: [[i32; W]; RING],
    sums: [i32; W],
    squares: [u32; W],
}

impl<const W: usize> SharpnessRows<W> {
    /// The widest window's radius.
    pub const MOST_RADIUS: u8 = MOST_RADIUS as u8;

    /// Waits for [`Self::start`].
    pub const fn new() -> Self {
        Self {
            measure: Measure::Robust,
            radius: 0,
            width: 0,
            height: 0,
            taken: 0,
            rows_out: 0,
            points: 0,
            raw: [[0; 3]; W],
            smooth: [[0; 3]; W],
            values: [[0; W]; RING],
            sums: [0; W],
            squares: [0; W],
        }
    }

    /// Begins a frame of `height` lines of `width` pixels, at most the capacity, with a window of `radius`,
    /// at most [`Self::MOST_RADIUS`].
    pub fn start(&mut self, width: u16, height: u16, measure: Measure, radius: u8) {
        self.measure = measure;
        self.radius = usize::from(radius).min(MOST_RADIUS);
        self.width = usize::from(width).min(W);
        (self.height, self.taken, self.rows_out, self.points) = (height, 0, 0, 0);
        self.values.as_flattened_mut().fill(0);
        self.sums.fill(0);
        self.squares.fill(0);
    }

    /// Takes the next line of grey pixels, and calls `row` with the index of every row of the measure that it
    /// completes, and that row; the last line completes all.
    pub fn push(&mut self, line: &[u8], mut row: impl FnMut(usize, &[u32])) -> Result<(), FocusLineError> {
        if self.taken >= self.height {
            return Err(FocusLineError::NoLineDue);
        }
        if line.len() != self.width {
            return Err(FocusLineError::Length { needed: self.width });
        }
        let newest = usize::from(self.taken);
        lines(&mut self.raw, self.width).row_mut(newest).copy_from_slice(line);
        self.taken += 1;
        let is_last = self.taken == self.height;
        let is_smooth = self.measure == Measure::Robust;
        if let Some(centre) = newest.checked_sub(1) {
            self.smooth_row(centre, newest);
            match (is_smooth, centre.checked_sub(1)) {
                (false, _) => self.point_row(centre, newest, &mut row),
                (true, Some(above)) => self.point_row(above, centre, &mut row),
                (true, None) => {}
            }
        }
        if is_last {
            self.smooth_row(newest, newest);
            if let (true, Some(above)) = (is_smooth, newest.checked_sub(1)) {
                self.point_row(above, newest, &mut row);
            }
            self.point_row(newest, newest, &mut row);
            for _ in 0..self.radius {
                self.window(false, &mut row);
            }
        }
        Ok(())
    }

    fn smooth_row(&mut self, centre: usize, newest: usize) {
        if self.measure == Measure::Robust {
            let raw = lines(&mut self.raw, self.width);
            binomial(raw.around(centre, newest), lines(&mut self.smooth, self.width).row_mut(centre));
        }
    }

    /// The points' values of row `centre` into the ring, in place of those that leave the window, which are
    /// taken off the sums.
    fn point_row(&mut self, centre: usize, newest: usize, row: &mut impl FnMut(usize, &[u32])) {
        let (raw, smooth) = (lines(&mut self.raw, self.width), lines(&mut self.smooth, self.width));
        let raw = raw.around(centre, newest);
        let (mut small, mut large, mut signed) = ([0; W], [0; W], [0; W]);
        let value: &dyn Fn(usize) -> i32 = match self.measure {
            Measure::Robust => {
                modified_laplacian(smooth.around(centre, newest), &mut small);
                &|x| small.get(x).copied().unwrap_or(0).into()
            }
            Measure::ModifiedLaplacian => {
                modified_laplacian(raw, &mut small);
                &|x| small.get(x).copied().unwrap_or(0).into()
            }
            Measure::Tenengrad => {
                tenengrad(raw, &mut large);
                &|x| large.get(x).copied().unwrap_or(0) as i32
            }
            Measure::LaplacianVariance => {
                laplacian(raw, &mut signed);
                &|x| signed.get(x).copied().unwrap_or(0).into()
            }
        };
        let side = 2 * self.radius + 1;
        if let Some(kept) = self.values.get_mut(self.points % side) {
            let columns = self.sums.iter_mut().zip(&mut self.squares).zip(kept).take(self.width);
            for (x, ((sum, square), kept)) in columns.enumerate() {
                enter(sum, square, kept, value(x), self.measure);
            }
        }
        self.window(true, row);
    }

    /// Gives out the row of windows whose last row of points is in the sums; below the picture, first takes a
    /// row off.
    fn window(&mut self, is_inside: bool, row: &mut impl FnMut(usize, &[u32])) {
        let side = 2 * self.radius + 1;
        if !is_inside && let Some(kept) = self.values.get_mut(self.points % side) {
            let columns = self.sums.iter_mut().zip(&mut self.squares).zip(kept).take(self.width);
            columns.for_each(|((sum, square), kept)| enter(sum, square, kept, 0, self.measure));
        }
        self.points += 1;
        if self.points <= self.radius {
            return;
        }
        let last_row = usize::from(self.height).saturating_sub(1);
        let top = self.rows_out.saturating_sub(self.radius);
        let rows = ((self.rows_out + self.radius).min(last_row) + 1).saturating_sub(top) as u32;
        let mut out = [0; W];
        let columns = |from: usize, to: usize| {
            let sums = self.sums.get(from..to).unwrap_or(&[]);
            let squares = self.squares.get(from..to).unwrap_or(&[]);
            (sums.iter().sum::<i32>(), squares.iter().sum::<u32>(), sums.len() as u32)
        };
        for (x, out) in out.iter_mut().enumerate().take(self.width) {
            let (sum, square, count) =
                columns(x.saturating_sub(self.radius), (x + self.radius + 1).min(self.width));
            *out = match self.measure {
                Measure::LaplacianVariance => {
                    (rows * count * square).saturating_sub(sum.unsigned_abs().pow(2))
                }
                _ => sum as u32,
            };
        }
        row(self.rows_out, out.get(..self.width).unwrap_or(&[]));
        self.rows_out += 1;
    }
}

/// The ring of the last three rows in a memory.
fn lines<T>(memory: &mut [[T; 3]], width: usize) -> RowRing<'_, T, 3> {
    RowRing::split(memory.as_flattened_mut(), width).0
}

/// A column's sums with `new` in place of what was kept.
fn enter(sum: &mut i32, square: &mut u32, kept: &mut i32, new: i32, measure: Measure) {
    *sum += new - *kept;
    if measure == Measure::LaplacianVariance {
        *square = *square + new.unsigned_abs().pow(2) - kept.unsigned_abs().pow(2);
    }
    *kept = new;
}

impl<const W: usize> Default for SharpnessRows<W> {
    fn default() -> Self {
        Self::new()
    }
}
