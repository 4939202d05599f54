//! RANSAC of the ground's line in the v-disparity: parallax over rows (Labayrade, Aubert & Tarel 2002; Fischler
//! & Bolles 1981).

use super::cells::Cells;
use super::config::ObstacleConfig;
use super::ground::{Ground, RigNumbers};
use super::least_squares::fitted;

/// Iterations: where 3/10 of the cells are ground, 99 frames of 100 draw a pair of ground cells.
const DRAWS: usize = 64;
/// How far a cell may be from a line that it is on, steps: three quarters of a px.
const BAND: u32 = 24;
/// Most that a parallax counts as, and that it grows by from a cell to the next one, 256ths of a step.
const MOST: i64 = 1 << 28;
const MOST_ACROSS: i64 = 1 << 16;

/// A line of the v-disparity that nothing is known of: parallax at row 0 in the column of the principal point
/// and growth from row to row, steps in 65536ths. It leans as the carried ground does.
#[derive(Clone, Copy)]
struct Drawn {
    level: i64,
    slope: i64,
}

/// Number of cells within [`BAND`] of a line that leans by `lean` from pixel to pixel of a row.
fn score(cells: &Cells<'_>, line: Drawn, lean: i64) -> u32 {
    let mut score = 0;
    // Rows are an even number of half-rows apart, so that steps add up to what each row would have.
    let mut exact = line.level.wrapping_add(line.slope.wrapping_mul(cells.halves(0)) / 2);
    let down = line.slope.wrapping_mul(cells.cell_height);
    // In 256ths of a step: what the first column has beside the principal point's, and each one more.
    let first = ((lean * cells.right_16ths(0)) >> 12).clamp(-MOST, MOST) as i32;
    let across = ((lean * cells.cell_width) >> 8).clamp(-MOST_ACROSS, MOST_ACROSS) as i32;
    for row in cells.cells.chunks_exact(cells.columns.max(1)).take(cells.rows) {
        let parallax_256ths = (exact >> 8).clamp(-MOST, MOST) as i32;
        exact = exact.wrapping_add(down);
        if parallax_256ths >> 8 < cells.farthest {
            continue;
        }
        let mut expected = parallax_256ths + first;
        for d in row {
            let off = i32::from(d.raw()) + cells.offset - (expected >> 8);
            expected = expected.wrapping_add(across);
            score += u32::from(d.is_some() && off.unsigned_abs() <= BAND);
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
    carried: Option<Ground>,
    config: &ObstacleConfig,
    rig: &RigNumbers,
) -> Option<Ground> {
    let all = cells.columns * cells.rows;
    let source = &config.ground;
    let drawn = |line: Ground| Drawn { level: line.level, slope: line.slope };
    let lean = carried.map_or(0, |ground| i64::from(ground.lean));
    let mut best = carried.map(|line| (score(cells, drawn(line), lean), line));
    let (mut state, lowest) = (0x9e37_79b9, cells.halves(cells.rows.saturating_sub(1)));
    for _ in 0..DRAWS {
        let pair = [(); 2].map(|()| ((u64::from(random(&mut state)) * all as u64) >> 32) as usize);
        let Some(line) = through(cells, pair, carried.as_ref()) else { continue };
        let score = score(cells, line, lean);
        if best.is_none_or(|(most, _)| score > most) {
            // The plane behind a line takes divisions: of the few that are better alone.
            let plane = Ground::from_line(line.level, line.slope, lean, 1, rig)
                .and_then(|plane| plane.bounded(source, lowest, rig));
            best = plane.filter(|plane| plane.is_within(source)).map(|plane| (score, plane)).or(best);
        }
    }
    fitted(cells, best?.1, carried.is_some(), config, rig)
}
