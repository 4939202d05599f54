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

/// A line of the v-disparity that nothing is known of: parallax at row 0 in the column of the principal point
/// and growth from row to row, steps in 65536ths. It leans as the carried ground does.
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

/// The line through two cells, the lower one nearer, of a ground that leans as another one.
fn through(cells: &Cells<'_>, drawn: [usize; 2], leaning: Option<&Ground>) -> Option<Drawn> {
    let [a, b] = drawn.map(|place| (place.checked_div(cells.columns), place.checked_rem(cells.columns)));
    let (a, b) = (a.0.zip(a.1)?, b.0.zip(b.1)?);
    let (upper, lower) = if a.0 < b.0 { (a, b) } else { (b, a) };
    if lower.0 - upper.0 < cells.span() {
        return None;
    }
    let upright = |(row, column)| {
        let beside = leaning.map_or(0, |ground| ground.beside_256ths(cells.right_16ths(column)) >> 8);
        cells.parallax(column, row).map(|parallax| i64::from(parallax - beside))
    };
    let (far, near) = (upright(upper)?, upright(lower)?);
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

/// Sums over the cells within a band around a plane, of half-rows `a`, columns `x`, and parallaxes `p` less
/// the plane's.
#[derive(Default)]
struct Sums {
    n: i64,
    a: i64,
    x: i64,
    p: i64,
    aa: i64,
    ax: i64,
    ap: i64,
    xx: i64,
    xp: i64,
    pp: i64,
    first_row: Option<usize>,
    last_row: usize,
}

/// Adds the cells within `band` of a plane whose neighbours above and below are, too: at the edge of the
/// ground and of the picture a matching window sees more of the one side.
fn sums(cells: &Cells<'_>, plane: &Ground, band: i32) -> Sums {
    let mut sums = Sums::default();
    for row in 1..cells.rows.saturating_sub(1) {
        let around = [row - 1, row, row + 1];
        let [above, here, below] = around.map(|row| {
            let disparities = cells.cells.get(row * cells.columns..(row + 1) * cells.columns);
            (disparities.unwrap_or_default(), plane.parallax_256ths(cells.halves(row)))
        });
        if here.1 >> 8 < cells.farthest {
            continue;
        }
        let off = |d: Disparity, expected: i32| {
            let off = i32::from(d.raw()) + cells.offset - (expected >> 8);
            (d.is_some() && off.abs() <= band).then_some(off)
        };
        let (mut n, mut p, mut x, mut pp, mut xp, mut xx) = (0_i32, 0_i32, 0_i32, 0_i32, 0_i64, 0_i32);
        for (column, ((&d, &d_above), &d_below)) in (0..).zip(here.0.iter().zip(above.0).zip(below.0)) {
            let beside = plane.beside_256ths(cells.right_16ths(column as usize));
            let Some(off_here) = off(d, here.1 + beside) else { continue };
            if off(d_above, above.1 + beside).is_none() || off(d_below, below.1 + beside).is_none() {
                continue;
            }
            (n, p, pp) = (n + 1, p + off_here, pp + off_here * off_here);
            (x, xx) = (x + column, xx + column * column);
            xp += i64::from(off_here * column);
        }
        if n == 0 {
            continue;
        }
        // All of a row have the same `a`.
        let ([n, x, p], a) = ([n, x, p].map(i64::from), cells.halves(row));
        (sums.n, sums.a, sums.x, sums.p) = (sums.n + n, sums.a + a * n, sums.x + x, sums.p + p);
        (sums.aa, sums.ax, sums.ap) = (sums.aa + a * a * n, sums.ax + a * x, sums.ap + a * p);
        (sums.xx, sums.xp, sums.pp) = (sums.xx + i64::from(xx), sums.xp + xp, sums.pp + i64::from(pp));
        sums.first_row.get_or_insert(row);
        sums.last_row = row;
    }
    sums
}

/// Least squares over the cells within `band` of a plane, of which there have to be `fewest`, and the number
/// of rows that they reach over. The roll stays where they reach over too little of the picture's width. The
/// variance is four times that of the mean: cells side by side share windows.
fn refined(
    cells: &Cells<'_>,
    plane: &Ground,
    band: i32,
    fewest: i64,
    source: &GroundSource,
    rig: &RigNumbers,
) -> Option<(Ground, usize)> {
    let s = sums(cells, plane, band);
    if s.n < fewest {
        return None;
    }
    // Sums about the means: of products of `u` and `v`, and of each.
    let about = |uv: i64, u: i64, v: i64| Some(uv - (u * v).checked_div(s.n)?);
    let (aa, ax, ap) = (about(s.aa, s.a, s.a)?, about(s.ax, s.a, s.x)?, about(s.ap, s.a, s.p)?);
    let (xx, xp) = (about(s.xx, s.x, s.x)?, about(s.xp, s.x, s.p)?);
    // Columns and parallaxes less what goes with the row.
    let with_row = (ax << 16).checked_div(aa)?;
    let (spread, along) = (xx - ((ax * with_row) >> 16), xp - ((ap * with_row) >> 16));
    // A deviation of an eighth of the columns is that of a run of three sevenths of them.
    let columns = cells.columns as i64;
    let rolls = matches!(source, GroundSource::Searched { most_roll: 1.., .. });
    let per_cell = match rolls && 64 * spread >= s.n * columns * columns {
        true => (along << 16).checked_div(spread)?,
        false => 0,
    };
    let per_half = ((ap << 16) - per_cell * ax).checked_div(aa)?;
    let rest = about(s.pp, s.p, s.p)? - ((per_half * ap + per_cell * xp) >> 16);
    let variance = 1 + (4 * rest.max(0)).checked_div(s.n * s.n)?.min(1 << 20);
    let lean = per_cell.checked_div(cells.cell_width)?;
    let right = (16 * cells.cell_width * s.x).checked_div(s.n)? + cells.right_16ths(0);
    // Parallaxes of the plane were rounded down.
    let mean = (s.p << 16).checked_div(s.n)? - 0x8000;
    let level = plane.level + mean - (per_half * s.a).checked_div(s.n)? - ((lean * right) >> 4);
    let (slope, lean) = (plane.slope + 2 * per_half, i64::from(plane.lean) + lean);
    let fitted = Ground::from_line(level, slope, lean, variance as u32, rig)?;
    Some((fitted.bounded(source, s.a.checked_div(s.n)?, rig)?, s.last_row - s.first_row?))
}

/// The ground of a frame: the line of most cells of [`DRAWS`] that are drawn and the carried one, fitted by
/// least squares in bands that get narrower, down to half a px to each side, as long as at least 8 cells and
/// a sixteenth of those with an answer are within, with their neighbours above and below.
/// It is refused if 2 px are too narrow for that, or if these cells reach over less than an eighth of the
/// rows.
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
    let lean = carried.map_or(0, |ground| i64::from(ground.lean));
    let mut best = carried.map(|line| (score(cells, bins, shift, drawn(line)), line));
    let (mut state, lowest) = (0x9e37_79b9, cells.halves(cells.rows.saturating_sub(1)));
    for _ in 0..DRAWS {
        let pair = [(); 2].map(|()| ((u64::from(random(&mut state)) * all as u64) >> 32) as usize);
        let Some(line) = through(cells, pair, carried.as_ref()) else { continue };
        let score = score(cells, bins, shift, line);
        if best.is_none_or(|(most, _)| score > most) {
            // The plane behind a line takes divisions: of the few that are better alone.
            let plane = Ground::from_line(line.level, line.slope, lean, 1, rig)
                .and_then(|plane| plane.bounded(source, lowest, rig));
            best = plane.filter(|plane| plane.is_within(source)).map(|plane| (score, plane)).or(best);
        }
    }
    let (_, mut plane) = best?;
    let answered = cells.cells.iter().take(all).filter(|d| d.is_some()).count() as i64;
    let fewest = (answered / 16).max(8);
    let mut within = None;
    for band in bands(shift) {
        let Some((fitted, reach)) = refined(cells, &plane, band, fewest, source, rig) else { break };
        (plane, within) = (fitted, Some((band, reach)));
    }
    let (band, reach) = within?;
    (band <= WIDEST && reach >= cells.span() && plane.is_within(source)).then_some(plane)
}
