//! V-disparity of a frame's cells, and the robust fit of the ground's line (Labayrade, Aubert & Tarel 2002;
//! Fischler & Bolles 1981).

use super::config::GroundSource;
use super::ground::{Ground, RigNumbers};
use crate::units::Disparity;

/// Bins of disparity in a row of the v-disparity.
pub(super) const BINS: usize = 32;
/// Pairs of cells that the search draws: with three tenths of the cells on the ground, at least one pair of
/// those is among them in 99 frames of 100.
const DRAWS: usize = 64;
/// Half the width of the band of the last fit, steps of disparity.
const BAND: i32 = 1 << FINEST;
/// Exponent of it.
const FINEST: u32 = 4;
/// Half the width of the widest band in which a ground may be found, steps of disparity: 2 px.
const WIDEST: i32 = 4 * BAND;
/// Most that bins may be shifted to be narrow: to 2 px.
const NARROW: u32 = 6;

/// Half the widths of the bands of a fit, steps of disparity, each half of the one before: the score tells a
/// line to a bin, and to a px where bins are narrow.
fn bands(shift: u32) -> impl Iterator<Item = i32> {
    let first = if shift > NARROW { shift.min(9) } else { 5 };
    (FINEST..=first).rev().map(|exponent| 1 << exponent)
}

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

/// A line of the v-disparity that nothing is known of: parallax at row 0 and growth from row to row, steps in
/// 65536ths.
#[derive(Clone, Copy)]
struct Drawn {
    level: i64,
    slope: i64,
}

/// How many cells are near a line, from the v-disparity.
fn score(cells: &Cells<'_>, bins: &[u8], shift: u32, line: Drawn) -> u32 {
    let mut score = 0;
    // Rows are an even number of half-rows apart, so that steps add up to what each row would have.
    let mut exact = line.level.wrapping_add(line.slope.wrapping_mul(cells.halves(0)) / 2);
    let step = line.slope.wrapping_mul(cells.cell_height);
    for bins in bins.as_chunks::<BINS>().0 {
        let parallax = (exact >> 16) as i32;
        exact = exact.wrapping_add(step);
        let steps = parallax.wrapping_sub(cells.offset);
        if parallax < cells.farthest || steps < 0 {
            continue;
        }
        let low = (steps - BAND).max(0) as usize >> shift;
        let high = (steps as usize + BAND as usize) >> shift;
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
fn through(cells: &Cells<'_>, drawn: [usize; 2]) -> Option<Drawn> {
    let [a, b] = drawn.map(|place| (place.checked_div(cells.columns), place.checked_rem(cells.columns)));
    let (a, b) = (a.0.zip(a.1)?, b.0.zip(b.1)?);
    let (upper, lower) = if a.0 < b.0 { (a, b) } else { (b, a) };
    if lower.0 - upper.0 < cells.span() {
        return None;
    }
    let [far, near] = [upper, lower].map(|(row, column)| cells.parallax(column, row).map(i64::from));
    let (far, near) = (far?, near?);
    // Before all divisions.
    if near <= far {
        return None;
    }
    let apart = cells.cell_height * (lower.0 - upper.0) as i64;
    let slope = match (u16::try_from(near - far), u32::try_from(apart)) {
        (Ok(rise), Ok(apart)) => i64::from((u32::from(rise) << 16).checked_div(apart)?),
        _ => ((near - far) << 16).checked_div(apart)?,
    };
    let level = (far << 16) - slope * cells.halves(upper.0) / 2;
    Some(Drawn { level, slope })
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
        let around = [row - 1, row, row + 1];
        let [above, here, below] = around.map(|row| {
            let disparities = cells.cells.get(row * cells.columns..(row + 1) * cells.columns);
            (disparities.unwrap_or_default(), line.parallax(cells.halves(row)))
        });
        if here.1 < cells.farthest {
            continue;
        }
        let a = cells.halves(row) - origin[0];
        let off = |d: Disparity, expected: i32| {
            let off = i32::from(d.raw()) + cells.offset - expected;
            (d.is_some() && off.abs() <= band).then_some(off)
        };
        let (mut n, mut sum, mut squares) = (0_i32, 0_i32, 0_i32);
        for ((&d, &d_above), &d_below) in here.0.iter().zip(above.0).zip(below.0) {
            let Some(off_here) = off(d, here.1) else { continue };
            if off(d_above, above.1).is_none() || off(d_below, below.1).is_none() {
                continue;
            }
            (n, sum, squares) = (n + 1, sum + off_here, squares + off_here * off_here);
        }
        if n == 0 {
            continue;
        }
        // All of a row have the same `a`.
        let n = i64::from(n);
        let b = i64::from(sum) + n * (i64::from(here.1) - origin[1]);
        sums.n += n;
        sums.a += a * n;
        sums.b += b;
        sums.aa += a * a * n;
        sums.ab += a * b;
        sums.squares += i64::from(squares);
        sums.first_row.get_or_insert(row);
        sums.last_row = row;
    }
    sums
}

/// Least squares over the cells within `band` of a line, of which there have to be `fewest`.
fn refined(cells: &Cells<'_>, line: &Ground, band: i32, fewest: i64, rig: &RigNumbers) -> Option<Ground> {
    let middle = cells.halves(cells.rows / 2);
    let origin = [middle, i64::from(line.parallax(middle))];
    let s = sums(cells, line, band, origin);
    if s.n < fewest {
        return None;
    }
    let along = s.ab - (s.a * s.b).checked_div(s.n)?;
    let spread = s.aa - (s.a * s.a).checked_div(s.n)?;
    let slope = (along << 17).checked_div(spread)?;
    let level = (origin[1] << 16) + (s.b << 16).checked_div(s.n)?
        - slope.wrapping_mul(middle * s.n + s.a).checked_div(2 * s.n)?;
    Ground::from_line(level, slope, 1, rig)
}

/// The ground of a frame: the line of most cells of [`DRAWS`] that are drawn and the carried one, fitted by
/// least squares in bands that get narrower, down to half a px to each side, as long as at least 8 cells and
/// a sixteenth of those with an answer are within, with their neighbours above and below.
///
/// It is refused if 2 px are too narrow for that, or if these cells reach over less than an eighth of the
/// rows. Its variance is four times that of the mean: cells
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
    let drawn = |line: Ground| Drawn { level: line.level, slope: line.slope };
    let mut best = carried.map(|line| (score(cells, bins, shift, drawn(line)), line));
    let mut state = 0x9e37_79b9;
    for _ in 0..DRAWS {
        let pair = [(); 2].map(|()| ((u64::from(random(&mut state)) * all as u64) >> 32) as usize);
        let Some(line) = through(cells, pair) else { continue };
        let score = score(cells, bins, shift, line);
        if best.is_none_or(|(most, _)| score > most) {
            // The plane behind a line takes divisions: of the few that are better alone.
            let plane = Ground::from_line(line.level, line.slope, 1, rig);
            best = plane.filter(|plane| plane.is_within(source)).map(|plane| (score, plane)).or(best);
        }
    }
    let (_, mut line) = best?;
    let answered = cells.cells.iter().take(all).filter(|d| d.is_some()).count() as i64;
    let fewest = (answered / 16).max(8);
    let mut within = None;
    for band in bands(shift) {
        let Some(fitted) = refined(cells, &line, band, fewest, rig) else { break };
        (line, within) = (fitted, Some(band));
    }
    let s = sums(cells, &line, within.filter(|&band| band <= WIDEST)?, [0; 2]);
    let reach = s.last_row - s.first_row?;
    if s.n < fewest || reach < cells.span() || !line.is_within(source) {
        return None;
    }
    let variance = 1 + (4 * s.squares).checked_div(s.n * s.n)?;
    Some(Ground { variance: variance.min(1 << 20) as u32, ..line })
}
