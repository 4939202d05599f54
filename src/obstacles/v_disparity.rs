//! V-disparity of a frame's cells, and the robust fit of the ground's line (Labayrade, Aubert & Tarel 2002;
//! Fischler & Bolles 1981).

use super::config::GroundSource;
use super::ground::{Ground, RigNumbers};
use crate::units::Disparity;

/// Bins of disparity in a row of the v-disparity.
pub(super) const BINS: usize = 32;
/// Pairs of cells that the search draws.
const DRAWS: usize = 128;
/// Half the width of the band of the first fit, and of the second and last, steps of disparity.
const BANDS: [i32; 2] = [32, 16];

/// Cells of a frame with what a fit needs to know of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells<'a> {
    /// Disparities, `columns` in a row.
    pub(super) cells: &'a [Disparity],
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) cell_height: i64,
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

    /// Parallax of a cell, if it has an answer.
    pub(super) fn parallax(&self, column: usize, row: usize) -> Option<i32> {
        let d = self.cells.get(row * self.columns + column).filter(|d| d.is_some())?;
        Some(i32::from(d.raw()) + self.offset)
    }

    /// Rows that a line has to reach over.
    fn span(&self) -> usize {
        (self.rows / 8).max(2)
    }
}

/// Shift from a disparity to its bin, so that the largest disparity is in a bin.
pub(super) fn bin_shift(largest: Disparity) -> u32 {
    let bits = u16::BITS - largest.raw().leading_zeros();
    bits.saturating_sub(BINS.ilog2())
}

/// Counts a row of cells into its bins, saturating.
pub(super) fn count(bins: &mut [u8], cells: &[Disparity], shift: u32) {
    bins.fill(0);
    for d in cells.iter().filter(|d| d.is_some()) {
        if let Some(bin) = bins.get_mut(usize::from(d.raw() >> shift)) {
            *bin = bin.saturating_add(1);
        }
    }
}

/// How many cells are near a line, from the v-disparity.
fn score(cells: &Cells<'_>, bins: &[u8], shift: u32, line: &Ground) -> u32 {
    let mut score = 0;
    for (row, bins) in bins.chunks_exact(BINS).enumerate() {
        let parallax = line.parallax(cells.halves(row));
        let steps = parallax - cells.offset;
        if parallax < cells.farthest || steps < 0 {
            continue;
        }
        let [low, high] = [steps - BANDS[1], steps + BANDS[1]].map(|d| (d.max(0) as usize) >> shift);
        score += bins.get(low).map_or(0, |&n| u32::from(n));
        if high != low {
            score += bins.get(high).map_or(0, |&n| u32::from(n));
        }
    }
    score
}

/// Xorshift (Marsaglia 2003).
fn random(state: &mut u32) -> u32 {
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    *state
}

/// The line through two cells, the lower one nearer.
fn through(cells: &Cells<'_>, drawn: [usize; 2], rig: &RigNumbers) -> Option<Ground> {
    let [a, b] = drawn.map(|place| (place.checked_div(cells.columns), place.checked_rem(cells.columns)));
    let (a, b) = (a.0.zip(a.1)?, b.0.zip(b.1)?);
    let (upper, lower) = if a.0 < b.0 { (a, b) } else { (b, a) };
    if lower.0 - upper.0 < cells.span() {
        return None;
    }
    let [far, near] = [upper, lower].map(|(row, column)| cells.parallax(column, row).map(i64::from));
    let (far, near) = (far?, near?);
    let apart = cells.cell_height * (lower.0 - upper.0) as i64;
    let slope = ((near - far) << 16).checked_div(apart)?;
    let level = (far << 16) - slope * cells.halves(upper.0) / 2;
    Ground::from_line(level, slope, 1, rig)
}

/// Sums of a least-squares line over the cells of a band around another line.
#[derive(Default)]
struct Sums {
    n: i64,
    a: i64,
    b: i64,
    aa: i64,
    ab: i64,
    /// Squared distances from the line in the middle of the band.
    squares: i64,
    first_row: Option<usize>,
    last_row: usize,
}

/// Adds the cells within `band` of a line whose neighbours above and below are, too: at the edge of the
/// ground and of the picture a matching window sees more of the one side. `a` is the half-row less
/// `origin[0]`, `b` the parallax less `origin[1]`.
fn sums(cells: &Cells<'_>, line: &Ground, band: i32, origin: [i64; 2]) -> Sums {
    let mut sums = Sums::default();
    for row in 1..cells.rows.saturating_sub(1) {
        let [above, expected, below] = [row - 1, row, row + 1].map(|row| line.parallax(cells.halves(row)));
        if expected < cells.farthest {
            continue;
        }
        let a = cells.halves(row) - origin[0];
        for column in 0..cells.columns {
            let off = |row: usize, expected: i32| {
                cells.parallax(column, row).map(|p| p - expected).filter(|off| off.abs() <= band)
            };
            let Some(off_here) = off(row, expected) else { continue };
            if off(row - 1, above).is_none() || off(row + 1, below).is_none() {
                continue;
            }
            let (off, parallax) = (off_here, expected + off_here);
            let b = i64::from(parallax) - origin[1];
            sums.n += 1;
            sums.a += a;
            sums.b += b;
            sums.aa += a * a;
            sums.ab += a * b;
            sums.squares += i64::from(off * off);
            sums.first_row.get_or_insert(row);
            sums.last_row = row;
        }
    }
    sums
}

/// Least squares over the cells within `band` of a line.
fn refined(cells: &Cells<'_>, line: &Ground, band: i32, rig: &RigNumbers) -> Option<Ground> {
    let middle = cells.halves(cells.rows / 2);
    let origin = [middle, i64::from(line.parallax(middle))];
    let s = sums(cells, line, band, origin);
    let along = s.ab - (s.a * s.b).checked_div(s.n)?;
    let spread = s.aa - (s.a * s.a).checked_div(s.n)?;
    let slope = (along << 17).checked_div(spread)?;
    let level = (origin[1] << 16) + (s.b << 16).checked_div(s.n)?
        - slope.checked_mul(middle * s.n + s.a)?.checked_div(2 * s.n)?;
    Ground::from_line(level, slope, 1, rig)
}

/// The ground of a frame: the line of most cells of [`DRAWS`] that are drawn and the carried one, fitted
/// twice by least squares.
///
/// It is refused if fewer than 8 cells or a sixteenth of those with an answer are within half a px of it,
/// with their neighbours above and below, or
/// if these reach over less than an eighth of the rows. Its variance is four times that of the mean: cells
/// side by side share windows.
pub(super) fn fit(
    cells: &Cells<'_>,
    bins: &[u8],
    shift: u32,
    carried: Option<Ground>,
    source: &GroundSource,
    rig: &RigNumbers,
) -> Option<Ground> {
    let all = cells.columns * cells.rows;
    let bins = bins.get(..cells.rows * BINS)?;
    let mut best = carried.map(|line| (score(cells, bins, shift, &line), line));
    let mut state = 0x9e37_79b9;
    for _ in 0..DRAWS {
        let drawn = [(); 2].map(|()| ((u64::from(random(&mut state)) * all as u64) >> 32) as usize);
        let line = through(cells, drawn, rig).filter(|line| line.is_within(source));
        let Some(line) = line else { continue };
        let score = score(cells, bins, shift, &line);
        if best.is_none_or(|(most, _)| score > most) {
            best = Some((score, line));
        }
    }
    let (_, mut line) = best?;
    for band in BANDS {
        line = refined(cells, &line, band, rig)?;
    }
    let s = sums(cells, &line, BANDS[1], [0; 2]);
    let answered = cells.cells.iter().take(all).filter(|d| d.is_some()).count() as i64;
    let reach = s.last_row - s.first_row?;
    if s.n < (answered / 16).max(8) || reach < cells.span() || !line.is_within(source) {
        return None;
    }
    let variance = 1 + (4 * s.squares).checked_div(s.n * s.n)?;
    Some(Ground { variance: variance.min(1 << 20) as u32, ..line })
}
