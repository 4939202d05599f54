//! RANSAC of the ground's line in the v-disparity: parallax over rows (Labayrade, Aubert & Tarel 2002;
//! Fischler & Bolles 1981).

use super::cells::Cells;
use super::config::ObstacleConfig;
use super::ground::{Ground, RigNumbers};
use super::least_squares::fitted;

/// Iterations: where 3/10 of the cells are ground, 99 frames of 100 draw a pair of ground cells.
const DRAWS: usize = 64;
/// Iterations where a ground is carried, which the lines drawn compete with.
const CARRIED_DRAWS: usize = 16;
/// How far a cell may be from a line that it is on, steps: three quarters of a px.
const BAND: u32 = 24;
/// Columns of cells that are counted, spread over a row, at most.
const MOST_COLUMNS: usize = 16;
/// Most that a parallax counts as, and that it changes by from a row or a column to the next one, 256ths of a
/// step.
const MOST: i64 = 1 << 28;
const MOST_STEP: i64 = 1 << 22;

/// A line of the v-disparity that nothing is known of: parallax at row 0 in the column of the principal point
/// and growth from row to row, steps in 65536ths. It leans as the carried ground does.
#[derive(Clone, Copy)]
struct Drawn {
    level: i64,
    slope: i64,
}

/// Number of cells within [`BAND`] of a line that leans by `lean` from pixel to pixel of a row, in columns
/// spread over the picture; `None` where it is at most `most`.
fn score(cells: &Cells<'_>, line: Drawn, lean: i64, most: u32) -> Option<u32> {
    let stride = cells.columns.div_ceil(MOST_COLUMNS).max(1);
    // In 256ths of a step: the parallax of the lowest row, how much less each row above it has, what the
    // first column has beside the principal point's, and each one that is counted more.
    let limited = |number: i64, most: i64| number.max(-most).min(most) as i32;
    let lowest = line.level + line.slope * cells.halves(cells.rows.saturating_sub(1)) / 2;
    let up = limited((line.slope * cells.cell_height) >> 8, MOST_STEP);
    let first = limited((lean * cells.right_16ths(0)) >> 12, MOST);
    let across = limited((lean * cells.cell_width * stride as i64) >> 8, MOST_STEP);
    let mut parallax = limited(lowest >> 8, MOST);
    let least = cells.farthest << 8;
    let to_band = first.wrapping_sub(cells.offset.wrapping_add(BAND as i32) << 8);
    let (mut score, mut left) = (0, (cells.rows * MOST_COLUMNS) as u32);
    for row in (0..cells.rows).rev() {
        // The rows above have less parallax still, and too few cells make no difference.
        if parallax < least || score + left <= most {
            break;
        }
        let mut low = parallax.wrapping_add(to_band);
        let row = cells.cells.get(row * cells.columns..(row + 1) * cells.columns).unwrap_or_default();
        for d in row.iter().step_by(stride) {
            // The number of no answer is no parallax that a line has in a picture.
            score += u32::from((i32::from(d.raw()) - (low >> 8)) as u32 <= 2 * BAND);
            low = low.wrapping_add(across);
        }
        parallax -= up;
        left -= MOST_COLUMNS as u32;
    }
    (score > most).then_some(score)
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

/// The ground of a frame: of the lines that are drawn and the carried one, the line of most cells, fitted by
/// least squares. [`DRAWS`] pairs are drawn, [`CARRIED_DRAWS`] where a ground is carried.
pub(super) fn fit(
    cells: &Cells<'_>,
    carried: Option<Ground>,
    config: &ObstacleConfig,
    rig: &RigNumbers,
) -> Option<Ground> {
    let all = cells.columns * cells.rows;
    let source = &config.ground;
    let lean = carried.map_or(0, |ground| i64::from(ground.lean));
    let mut best = carried;
    let mut most = carried
        .map_or(0, |line| score(cells, Drawn { level: line.level, slope: line.slope }, lean, 0).unwrap_or(0));
    let (mut state, lowest) = (0x9e37_79b9, cells.halves(cells.rows.saturating_sub(1)));
    for _ in 0..if carried.is_some() { CARRIED_DRAWS } else { DRAWS } {
        let pair = [(); 2].map(|()| ((u64::from(random(&mut state)) * all as u64) >> 32) as usize);
        let Some(line) = through(cells, pair, carried.as_ref()) else { continue };
        let Some(score) = score(cells, line, lean, most) else { continue };
        // The plane behind a line takes divisions: of the few that are better alone.
        let plane = Ground::from_line(line.level, line.slope, lean, 1, rig)
            .and_then(|plane| plane.bounded(source, lowest, rig))
            .filter(|plane| plane.is_within(source));
        if plane.is_some() {
            (best, most) = (plane, score);
        }
    }
    fitted(cells, best?, carried.is_some(), config, rig)
}
