//! V-disparity of a frame's cells, and the robust fit of the ground's line (Labayrade, Aubert & Tarel 2002;
//! Fischler & Bolles 1981).

use super::cells::Cells;
use super::config::ObstacleConfig;
use super::ground::{Ground, RigNumbers};
use super::least_squares::{BAND, bands, fitted};
use crate::units::Disparity;

/// Bins of disparity in a row of the v-disparity.
pub(super) const BINS: usize = 32;
/// Pairs of cells that the search draws: with three tenths of the cells on the ground, at least one pair of
/// those is among them in 99 frames of 100.
const DRAWS: usize = 64;

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

/// The ground of a frame: the line of most cells of [`DRAWS`] that are drawn and the carried one, fitted by
/// least squares.
pub(super) fn fit(
    cells: &Cells<'_>,
    bins: &[u8],
    shift: u32,
    carried: Option<Ground>,
    config: &ObstacleConfig,
    rig: &RigNumbers,
) -> Option<Ground> {
    let all = cells.columns * cells.rows;
    let (bins, source) = (bins.get(..cells.rows * BINS)?, &config.ground);
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
    fitted(cells, best?.1, bands(shift, carried.is_some()), config, rig)
}
