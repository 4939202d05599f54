//! The ground's plane by counting cells, and by least squares.

use super::Scene;
use stereopsis::obstacles::GroundSource;

/// A plane of parallaxes: a line over rows that leans with the columns.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Line {
    /// Parallax at row 0 in the column of the principal point, steps in 65536ths.
    pub level: i128,
    /// Growth from row to row, steps in 65536ths.
    pub slope: i128,
    /// Growth from column to column, steps in 65536ths.
    pub lean: i128,
    /// Variance of the parallax, squared steps.
    pub variance: i128,
    /// Height of the camera above the plane, mm.
    pub height_mm: i128,
    /// Deviation of the tangent of the camera's pitch, 65536ths.
    pub pitch_sigma: i128,
}

impl Line {
    /// Parallax at a half-row, so far to the right of the principal point, sixteenths of a px.
    pub fn at(&self, halves: i128, right: i128) -> i128 {
        let in_256ths = ((self.level + self.slope * halves / 2) >> 8) + ((self.lean * right) >> 12);
        in_256ths >> 8
    }

    /// Parallax at a row, steps in 65536ths.
    pub fn exact(&self, y: i128, right: i128) -> i128 {
        self.level + self.slope * y + ((self.lean * right) >> 4)
    }

    /// Parallax in the column of the principal point.
    pub fn upright(&self, halves: i128) -> i128 {
        self.at(halves, 0)
    }

    /// Level, slope and lean of the plane below a camera of known pose, radians and mm, unrounded: the
    /// parallax is `b / H (sin rho cos theta (u - cx) + cos rho cos theta (v - cy) + f sin theta)`.
    pub fn of_pose(scene: &Scene<'_>, pitch: f64, roll: f64, height_mm: f64) -> [f64; 3] {
        let unit = 32.0 * 65_536.0 * scene.baseline_16ths as f64 / 16.0 / height_mm;
        let [slope, lean] = [roll.cos(), roll.sin()].map(|along| unit * along * pitch.cos());
        let at_centre = unit * pitch.sin() * scene.focal_16ths as f64 / 16.0;
        [at_centre - slope * scene.cy_halves as f64 / 2.0, slope, lean]
    }

    /// A plane that a camera can see.
    pub(super) fn new(scene: &Scene<'_>, [level, slope, lean]: [i128; 3], variance: i128) -> Option<Self> {
        let inclination = (level + slope * scene.cy_halves / 2) * 16 / scene.focal_16ths;
        if !(1..1 << 30).contains(&slope) || inclination.abs() >= 1 << 30 || lean.abs() > slope {
            return None;
        }
        let norm = ((slope * slope + lean * lean + inclination * inclination) as u128).isqrt() as i128;
        let height_mm = scene.baseline_16ths * 131_072 / norm;
        (height_mm <= 65_535).then_some(Self { level, slope, lean, variance, height_mm, pitch_sigma: 0 })
    }

    /// Deviation of the pitch where the parallax at the horizon has a variance, 256ths of squared steps.
    pub(super) fn pitch_sigma(&self, scene: &Scene<'_>, variance: i128) -> i128 {
        // In sixteenths of a step, as the focal length is in sixteenths of a px: they cancel out.
        (variance.isqrt() * 65_536 * 65_536 / (self.slope * scene.focal_16ths)).min(65_535)
    }

    /// The plane with the nearest height that is searched, and the same parallax at a half-row; none is given
    /// for one that is more than an eighth off.
    fn bounded(self, scene: &Scene<'_>, halves: i128) -> Option<Self> {
        let GroundSource::Searched { least_height_mm, most_height_mm, .. } = scene.config.ground else {
            return Some(self);
        };
        let height_mm = self.height_mm.clamp(least_height_mm.into(), most_height_mm.into());
        let mut plane = self;
        for _ in 0..4 {
            if plane.height_mm != height_mm {
                let slope = plane.slope * plane.height_mm / height_mm;
                let level = plane.level + (plane.slope - slope) * halves / 2;
                plane = Self::new(scene, [level, slope, plane.lean], plane.variance)?;
            }
        }
        let is_near = 8 * (self.height_mm - height_mm).abs() <= height_mm;
        is_near.then_some(Self { height_mm, ..plane })
    }

    fn is_allowed(&self, scene: &Scene<'_>) -> bool {
        let GroundSource::Searched { least_height_mm, most_height_mm, most_pitch, most_roll } =
            scene.config.ground
        else {
            return true;
        };
        let inclination = (self.level + self.slope * scene.cy_halves / 2) * 16 / scene.focal_16ths;
        let down = ((self.slope * self.slope + self.lean * self.lean) as u128).isqrt() as i128;
        let tangent = inclination * 65_536 / down;
        (i128::from(least_height_mm)..=i128::from(most_height_mm)).contains(&self.height_mm)
            && tangent.abs() * 1000 <= i128::from(most_pitch) * 65_536
            && self.lean.abs() * 1000 <= i128::from(most_roll) * self.slope
    }
}

/// How many cells of at most 16 columns, as far apart from each other, have parallaxes within three quarters
/// of a px of a line's. No answer counts as its number.
fn score(scene: &Scene<'_>, cells: &[Option<i128>], line: &Line) -> usize {
    let [columns, rows] = scene.size();
    let stride = columns.div_ceil(16);
    let limit = |number: i128, most: i128| number.clamp(-most, most);
    // 256ths of a step.
    let lowest = limit((line.level + line.slope * scene.halves(rows - 1) / 2) >> 8, 1 << 28);
    let up = limit((line.slope * i128::from(scene.config.cell_height)) >> 8, 1 << 22);
    let first = limit((line.lean * scene.right(0)) >> 12, 1 << 28);
    let cell_width = i128::from(scene.config.cell_width);
    let across = limit((line.lean * cell_width * stride as i128) >> 8, 1 << 22);
    let mut score = 0;
    for row in 0..rows {
        let parallax = lowest - up * (rows - 1 - row) as i128;
        if parallax < scene.farthest() << 8 {
            continue;
        }
        for column in (0..columns).step_by(stride) {
            let expected = (parallax + first + across * (column / stride) as i128) >> 8;
            let d = cells[row * columns + column].unwrap_or(65_535);
            score += usize::from((d + scene.offset - expected).abs() <= 24);
        }
    }
    score
}

/// A cell near a plane: its row, column and what its parallax has more than the plane.
struct Near {
    row: usize,
    column: usize,
    off: i128,
}

/// Cells within `band` of a plane, as are those above and below.
fn near(scene: &Scene<'_>, cells: &[Option<i128>], line: &Line, band: i128) -> Vec<Near> {
    let [columns, rows] = scene.size();
    let mut found = Vec::new();
    let off = |row: usize, column: usize| {
        let expected = line.at(scene.halves(row), scene.right(column));
        let off = cells[row * columns + column]? + scene.offset - expected;
        (off.abs() <= band).then_some(off)
    };
    for row in (1..rows.max(1) - 1).filter(|&row| line.upright(scene.halves(row)) >= scene.farthest()) {
        for column in 0..columns {
            if (row - 1..=row + 1).all(|row| off(row, column).is_some()) {
                found.extend(off(row, column).map(|off| Near { row, column, off }));
            }
        }
    }
    found
}

/// Least squares of what the cells near a plane have more than it: first columns and parallaxes less what
/// goes with the row, then the row's part. With the plane comes the number of rows that they reach over.
fn refined(
    scene: &Scene<'_>,
    cells: &[Option<i128>],
    line: &Line,
    band: i128,
    fewest: i128,
) -> Option<(Line, usize)> {
    let near = near(scene, cells, line, band);
    let n = near.len() as i128;
    if n < fewest {
        return None;
    }
    let row = |cell: &Near| scene.halves(cell.row);
    let column = |cell: &Near| cell.column as i128;
    let sum = |of: &dyn Fn(&Near) -> i128| near.iter().map(of).sum::<i128>();
    let (a, x, p) = (sum(&row), sum(&column), sum(&|cell| cell.off));
    let aa = sum(&|cell| row(cell) * row(cell)) - a * a / n;
    let ax = sum(&|cell| row(cell) * column(cell)) - a * x / n;
    let ap = sum(&|cell| row(cell) * cell.off) - a * p / n;
    let xx = sum(&|cell| column(cell) * column(cell)) - x * x / n;
    let xp = sum(&|cell| column(cell) * cell.off) - x * p / n;
    let pp = sum(&|cell| cell.off * cell.off) - p * p / n;
    if aa == 0 {
        return None;
    }
    let with_row = ax * 65_536 / aa;
    let (spread, along) = (xx - ((ax * with_row) >> 16), xp - ((ap * with_row) >> 16));
    let columns = scene.size()[0] as i128;
    let rolls = matches!(scene.config.ground, GroundSource::Searched { most_roll: 1.., .. });
    let per_cell = if rolls && 64 * spread >= n * columns * columns { along * 65_536 / spread } else { 0 };
    let per_half = (ap * 65_536 - per_cell * ax) / aa;
    let width = i128::from(scene.config.cell_width);
    let lean = per_cell / width;
    let right = 16 * width * x / n + scene.right(0);
    // The plane's parallaxes were rounded down.
    let level = p * 65_536 / n - 32_768 - per_half * a / n - ((lean * right) >> 4);
    // What the fit leaves of the squares.
    let rest = (pp - ((per_half * ap + per_cell * xp) >> 16)).max(0);
    let variance = 1 + (4 * rest / (n * n)).min(1 << 20);
    let fitted =
        Line::new(scene, [line.level + level, line.slope + 2 * per_half, line.lean + lean], variance)?;
    let fitted = fitted.bounded(scene, a / n)?;
    let pitch_sigma = fitted.pitch_sigma(scene, at_horizon(scene, &fitted, [n, a / n, aa, rest]));
    Some((Line { pitch_sigma, ..fitted }, near.last()?.row - near.first()?.row))
}

/// Variance of a plane's parallax at the horizon, 256ths of squared steps, by its number of cells, their mean
/// half-row, the squares of half-rows about it, and what is left of the squares of parallaxes.
fn at_horizon(scene: &Scene<'_>, line: &Line, [n, mean, rows, rest]: [i128; 4]) -> i128 {
    let sigma = i128::from(scene.config.sigma_steps);
    let answer = (4 * 256 * rest / n).max(4 * 256 * sigma * sigma).min(1 << 28);
    // As if no more than 512 cells were independent.
    let answer = (answer * n / n.min(512)).min(1 << 28);
    let parallax = line.upright(mean).abs().min(1 << 17);
    let to_horizon = (2 * 65_536 * parallax / line.slope).min(65_536);
    let by_fit = answer * to_horizon * to_horizon / rows;
    let slope = match scene.config.ground {
        GroundSource::Searched { least_height_mm, most_height_mm, .. } => {
            let width = i128::from(most_height_mm) - i128::from(least_height_mm);
            let share = (256 * 2 * width / (7 * line.height_mm)).min(16 * 256);
            by_fit.min((parallax * share).pow(2) / 256)
        }
        _ => by_fit,
    };
    answer / n + slope
}

/// The line through two cells at least an eighth of the rows, and two, apart, which leans as a carried one.
fn through(
    scene: &Scene<'_>,
    cells: &[Option<i128>],
    drawn: [usize; 2],
    carried: Option<Line>,
) -> Option<Line> {
    let [columns, rows] = scene.size();
    let lean = carried.map_or(0, |line| line.lean);
    let upright = |i: usize| {
        let beside = ((lean * scene.right(i % columns)) >> 12) >> 8;
        cells[i].map(|d| d + scene.offset - beside)
    };
    let mut ends: Vec<_> = drawn.iter().map(|&i| (i / columns, upright(i))).collect();
    // The first drawn is the lower one of two in a row, which is refused.
    ends.sort_by_key(|end| end.0);
    let ((upper, far), (lower, near)) = (ends[0], ends[1]);
    if lower - upper < (rows / 8).max(2) {
        return None;
    }
    let (far, near) = (far?, near?);
    let apart = i128::from(scene.config.cell_height) * (lower - upper) as i128;
    let slope = (near - far) * 65_536 / apart;
    Line::new(scene, [far * 65_536 - slope * scene.halves(upper) / 2, slope, lean], 1)
}

/// The ground that a frame shows, or that its pose gives.
pub fn fit(scene: &Scene<'_>, cells: &[Option<i128>], carried: Option<Line>) -> Option<Line> {
    let [columns, rows] = scene.size();
    let (mut best, mut most) = (carried, carried.map_or(0, |line| score(scene, cells, &line)));
    let mut state: u32 = 0x9e37_79b9;
    let mut draw = || {
        state ^= state.wrapping_shl(13);
        state ^= state >> 17;
        state ^= state.wrapping_shl(5);
        (u64::from(state) * (columns * rows) as u64 / (1 << 32)) as usize
    };
    for _ in 0..if carried.is_some() { 16 } else { 64 } {
        let drawn = [draw(), draw()];
        let Some(line) = through(scene, cells, drawn, carried) else { continue };
        let score = score(scene, cells, &line);
        let bounded = line.bounded(scene, scene.halves(rows - 1)).filter(|line| line.is_allowed(scene));
        if score > most && bounded.is_some() {
            (best, most) = (bounded, score);
        }
    }
    let line = best?;
    // From 2 px, or from 1 px where a ground was known, halved down to half a px.
    let mut band = if carried.is_some() { 32 } else { 64 };
    let (mut line, mut within) = (line, None);
    let answered = cells.iter().flatten().count() as i128;
    let fewest = (answered / 16).max(8);
    while band >= 16 {
        let Some((fitted, reach)) = refined(scene, cells, &line, band, fewest) else { break };
        (line, within) = (fitted, Some(reach));
        band /= 2;
    }
    (within? >= (rows / 8).max(2) && line.is_allowed(scene)).then_some(line)
}
