//! Least squares of a plane over the cells that are near to it, in bands that get narrower.

use super::cells::Cells;
use super::config::{GroundSource, ObstacleConfig};
use super::ground::{Ground, RigNumbers};
use crate::units::Disparity;

/// Exponent of half the width of the band of the last fit, steps of disparity.
const FINEST: u32 = 4;
/// Exponent of the widest band in which a ground may be found: 2 px.
const WIDEST: u32 = FINEST + 2;
/// Most cells whose errors are independent: more have in common what the matcher and the ground do.
const INDEPENDENT: i64 = 512;
/// Most that the variance of an answer may be, 256ths of squared steps, so that no product wraps.
const MOST_VARIANCE: i64 = 1 << 28;

/// Half the widths of the bands of a fit, steps of disparity, each half of the one before.
///
/// Where no ground was known before, a band of 2 px is as wide as what a ground that leans by 5 degrees has
/// in most of the columns.
fn bands(is_known: bool) -> impl Iterator<Item = i32> {
    let first = if is_known { WIDEST - 1 } else { WIDEST };
    (FINEST..=first).rev().map(|exponent| 1 << exponent)
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
    let per_column = 16 * i64::from(plane.lean) * cells.cell_width;
    for row in 1..cells.rows.saturating_sub(1) {
        let around = [row - 1, row, row + 1];
        let [above, here, below] = around.map(|row| {
            let disparities = cells.cells.get(row * cells.columns..(row + 1) * cells.columns);
            (disparities.unwrap_or_default(), plane.parallax_256ths(cells.halves(row)))
        });
        if here.1 >> 8 < cells.farthest {
            continue;
        }
        // The plane in 256ths of a step: at a row, and what a column has more.
        let off = |d: Disparity, expected_256ths: i32, beside_256ths: i32| {
            let off = i32::from(d.raw()) + cells.offset - ((expected_256ths + beside_256ths) >> 8);
            (d.is_some() && off.abs() <= band).then_some(off)
        };
        let mut next = i64::from(plane.lean) * cells.right_16ths(0);
        let (mut n, mut p, mut x, mut pp, mut xp, mut xx) = (0_i32, 0_i32, 0_i32, 0_i32, 0_i64, 0_i64);
        for (column, ((&d, &d_above), &d_below)) in (0..).zip(here.0.iter().zip(above.0).zip(below.0)) {
            // Twice as far as a row's parallax goes: what is cut off is near to no answer.
            let beside = (next >> 12).clamp(-(1 << 29), 1 << 29) as i32;
            next += per_column;
            let Some(off_here) = off(d, here.1, beside) else { continue };
            if off(d_above, above.1, beside).is_none() || off(d_below, below.1, beside).is_none() {
                continue;
            }
            (n, p, pp) = (n + 1, p + off_here, pp + off_here * off_here);
            (x, xx) = (x + column, xx + i64::from(column * column));
            xp += i64::from(off_here * column);
        }
        if n == 0 {
            continue;
        }
        // All of a row have the same `a`.
        let ([n, x, p], a) = ([n, x, p].map(i64::from), cells.halves(row));
        (sums.n, sums.a, sums.x, sums.p) = (sums.n + n, sums.a + a * n, sums.x + x, sums.p + p);
        (sums.aa, sums.ax, sums.ap) = (sums.aa + a * a * n, sums.ax + a * x, sums.ap + a * p);
        (sums.xx, sums.xp, sums.pp) = (sums.xx + xx, sums.xp + xp, sums.pp + i64::from(pp));
        sums.first_row.get_or_insert(row);
        sums.last_row = row;
    }
    sums
}

/// A fitted plane with the sums about the means, and what the fit leaves of the squares.
#[derive(Clone, Copy)]
struct Fitted {
    plane: Ground,
    /// Number of rows that the cells reach over.
    reach: usize,
    n: i64,
    /// Mean half-row.
    halves: i64,
    /// Squares of half-rows.
    rows: i64,
    /// Squares of parallaxes less the plane's.
    rest: i64,
}

/// Least squares over the cells within `band` of a plane, of which there have to be `fewest`. The roll stays
/// where they reach over too little of the picture's width. The variance is four times that of the mean:
/// cells side by side share windows.
fn refined(
    cells: &Cells<'_>,
    plane: &Ground,
    band: i32,
    fewest: i64,
    config: &ObstacleConfig,
    rig: &RigNumbers,
) -> Option<Fitted> {
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
    let rolls = matches!(config.ground, GroundSource::Searched { most_roll: 1.., .. });
    let per_cell = match rolls && 64 * spread >= s.n * columns * columns {
        true => (along << 16).checked_div(spread)?,
        false => 0,
    };
    let per_half = ((ap << 16) - per_cell * ax).checked_div(aa)?;
    let rest = (about(s.pp, s.p, s.p)? - ((per_half * ap + per_cell * xp) >> 16)).max(0);
    let variance = 1 + (4 * rest).checked_div(s.n * s.n)?.min(1 << 20);
    let lean = per_cell.checked_div(cells.cell_width)?;
    let right = (16 * cells.cell_width * s.x).checked_div(s.n)? + cells.right_16ths(0);
    // Parallaxes of the plane were rounded down.
    let mean = (s.p << 16).checked_div(s.n)? - 0x8000;
    let level = plane.level + mean - (per_half * s.a).checked_div(s.n)? - ((lean * right) >> 4);
    let (slope, lean) = (plane.slope + 2 * per_half, i64::from(plane.lean) + lean);
    let halves = s.a.checked_div(s.n)?;
    let plane = Ground::from_line(level, slope, lean, variance as u32, rig)?;
    let plane = plane.bounded(&config.ground, halves, rig)?;
    Some(Fitted { plane, reach: s.last_row - s.first_row?, n: s.n, halves, rows: aa, rest })
}

/// Variance of a plane's parallax at the horizon, 256ths of squared steps: that of the mean, and that of the
/// slope over the rows from the mean row to the horizon.
///
/// Answers have at least the variance of the limits, as what all of them are off by does not show between
/// them. The slope has at most the deviation of the heights that are allowed, as if all were as likely.
fn at_horizon(s: &Fitted, config: &ObstacleConfig) -> Option<u64> {
    let plane = &s.plane;
    let sigma = i64::from(config.sigma_steps);
    // Four times, as in the variance of the mean.
    let answer = ((4 * s.rest) << 8).checked_div(s.n)?.max((4 * sigma * sigma) << 8).min(MOST_VARIANCE);
    let answer = (answer * s.n).checked_div(s.n.min(INDEPENDENT))?.min(MOST_VARIANCE);
    let parallax = i64::from(plane.parallax_256ths(s.halves) >> 8).abs().min(1 << 17);
    let halves = ((2 * parallax) << 16).checked_div(plane.slope)?.min(1 << 16);
    let mut slope = (answer * halves * halves).checked_div(s.rows)?;
    if let GroundSource::Searched { least_height_mm, most_height_mm, .. } = config.ground {
        // A uniform distribution: its deviation is 2/7 of its width.
        let width = i64::from(most_height_mm.saturating_sub(least_height_mm));
        let share_256ths = (512 * width).checked_div(7 * i64::from(plane.height_mm))?.min(1 << 12);
        let off = parallax * share_256ths;
        slope = slope.min((off * off) >> 8);
    }
    Some((answer.checked_div(s.n)? + slope) as u64)
}

/// The plane that a search found, fitted by least squares in bands that get narrower, down to half a px to
/// each side, as long as at least `fewest` cells are within, with their neighbours above and below.
/// It is refused if the first band is too narrow for that, or if these cells reach over less than an eighth
/// of the rows.
pub(super) fn fitted(
    cells: &Cells<'_>,
    plane: Ground,
    is_known: bool,
    config: &ObstacleConfig,
    rig: &RigNumbers,
) -> Option<Ground> {
    let all = cells.columns * cells.rows;
    let answered = cells.cells.iter().take(all).filter(|d| d.is_some()).count() as i64;
    let fewest = (answered / 16).max(8);
    let (mut plane, mut last) = (plane, None);
    for band in bands(is_known) {
        let Some(fitted) = refined(cells, &plane, band, fewest, config, rig) else { break };
        (plane, last) = (fitted.plane, Some(fitted));
    }
    let fitted = last?;
    let is_good = fitted.reach >= cells.span() && plane.is_within(&config.ground);
    let pitch_sigma = rig.pitch_sigma(plane.slope, at_horizon(&fitted, config)?)?;
    is_good.then_some(Ground { pitch_sigma, ..plane })
}
