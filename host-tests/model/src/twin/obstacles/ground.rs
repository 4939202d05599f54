//! The ground's line by counting cells, and by least squares.

use super::Scene;
use stereopsis::obstacles::GroundSource;

/// A line of parallaxes over rows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Line {
    /// Parallax at row 0, steps in 65536ths.
    pub level: i128,
    /// Growth from row to row, steps in 65536ths.
    pub slope: i128,
    /// Variance of the parallax, squared steps.
    pub variance: i128,
    /// Height of the camera above the plane, mm.
    pub height_mm: i128,
}

impl Line {
    /// Parallax at a half-row.
    pub fn at(&self, halves: i128) -> i128 {
        (self.level + self.slope * halves / 2) >> 16
    }

    /// A line of a plane that a search allows.
    fn new(scene: &Scene<'_>, level: i128, slope: i128, variance: i128) -> Option<Self> {
        let inclination = (level + slope * scene.cy_halves / 2) * 16 / scene.focal_16ths;
        if !(1..1 << 30).contains(&slope) || inclination.abs() >= 1 << 30 {
            return None;
        }
        let norm = ((slope * slope + inclination * inclination) as u128).isqrt() as i128;
        let height_mm = scene.baseline_16ths * 131_072 / norm;
        (height_mm <= 65_535).then_some(Self { level, slope, variance, height_mm })
    }

    fn is_allowed(&self, scene: &Scene<'_>) -> bool {
        let GroundSource::Searched { least_height_mm, most_height_mm, most_pitch } = scene.config.ground
        else {
            return true;
        };
        let inclination = (self.level + self.slope * scene.cy_halves / 2) * 16 / scene.focal_16ths;
        let tangent = inclination * 65_536 / self.slope;
        (i128::from(least_height_mm)..=i128::from(most_height_mm)).contains(&self.height_mm)
            && tangent.abs() * 1000 <= i128::from(most_pitch) * 65_536
    }
}

/// Width of a bin of the v-disparity, steps.
fn bin(scene: &Scene<'_>) -> i128 {
    let mut width = 1;
    while i128::from(scene.largest) / width >= 32 {
        width *= 2;
    }
    width
}

/// How many cells of each row have disparities in the bins of half a px above and below the line, at most
/// 255 of a bin.
fn score(scene: &Scene<'_>, cells: &[Option<i128>], line: &Line) -> usize {
    let [columns, rows] = scene.size();
    let width = bin(scene);
    let mut score = 0;
    for row in 0..rows {
        let parallax = line.at(scene.halves(row));
        let steps = parallax - scene.offset;
        if parallax < scene.farthest() || steps < 0 {
            continue;
        }
        let mut bins = vec![(steps - 16).max(0) / width, (steps + 16) / width];
        bins.dedup();
        for bin in bins.into_iter().filter(|bin| *bin < 32) {
            let inside = |d: &&Option<i128>| d.is_some_and(|d| d / width == bin);
            let row = &cells[row * columns..(row + 1) * columns];
            score += row.iter().filter(inside).count().min(255);
        }
    }
    score
}

/// Cells within `band` of a line, as are those above and below, as half-rows and parallaxes.
fn near(scene: &Scene<'_>, cells: &[Option<i128>], line: &Line, band: i128) -> Vec<(i128, i128)> {
    let [columns, rows] = scene.size();
    let mut found = Vec::new();
    let parallax = |row: usize, column: usize| cells[row * columns + column].map(|d| d + scene.offset);
    let fits = |row: usize, column: usize| {
        let expected = line.at(scene.halves(row));
        parallax(row, column).is_some_and(|parallax| (parallax - expected).abs() <= band)
    };
    for row in (1..rows.max(1) - 1).filter(|&row| line.at(scene.halves(row)) >= scene.farthest()) {
        for column in 0..columns {
            if (row - 1..=row + 1).all(|row| fits(row, column)) {
                found.extend(parallax(row, column).map(|p| (scene.halves(row), p)));
            }
        }
    }
    found
}

/// Least squares, about the middle row and the line's parallax there.
fn refined(scene: &Scene<'_>, cells: &[Option<i128>], line: &Line, band: i128, fewest: i128) -> Option<Line> {
    let middle = scene.halves(scene.size()[1] / 2);
    let there = line.at(middle);
    let near = near(scene, cells, line, band);
    let points: Vec<_> = near.iter().map(|(halves, p)| (halves - middle, p - there)).collect();
    let n = points.len() as i128;
    if n < fewest {
        return None;
    }
    let sum = |of: fn(&(i128, i128)) -> i128| points.iter().map(of).sum::<i128>();
    let (a, b) = (sum(|p| p.0), sum(|p| p.1));
    let spread = sum(|p| p.0 * p.0) - a * a / n;
    if spread == 0 {
        return None;
    }
    let slope = (sum(|p| p.0 * p.1) - a * b / n) * 131_072 / spread;
    let level = there * 65_536 + b * 65_536 / n - slope * (middle * n + a) / (2 * n);
    Line::new(scene, level, slope, 1)
}

/// The line through two cells at least an eighth of the rows, and two, apart.
fn through(scene: &Scene<'_>, cells: &[Option<i128>], drawn: [usize; 2]) -> Option<Line> {
    let [columns, rows] = scene.size();
    let mut ends: Vec<_> = drawn.iter().map(|&i| (i / columns, cells[i])).collect();
    // The first drawn is the lower one of two in a row, which is refused.
    ends.sort_by_key(|end| end.0);
    let ((upper, far), (lower, near)) = (ends[0], ends[1]);
    if lower - upper < (rows / 8).max(2) {
        return None;
    }
    let (far, near) = (far? + scene.offset, near? + scene.offset);
    let apart = i128::from(scene.config.cell_height) * (lower - upper) as i128;
    let slope = (near - far) * 65_536 / apart;
    Line::new(scene, far * 65_536 - slope * scene.halves(upper) / 2, slope, 1)
}

/// The ground that a frame shows, or that its pose gives.
pub fn fit(scene: &Scene<'_>, cells: &[Option<i128>], carried: Option<Line>) -> Option<Line> {
    let [columns, rows] = scene.size();
    let mut best = carried.map(|line| (score(scene, cells, &line), line));
    let mut state: u32 = 0x9e37_79b9;
    let mut draw = || {
        state ^= state.wrapping_shl(13);
        state ^= state >> 17;
        state ^= state.wrapping_shl(5);
        (u64::from(state) * (columns * rows) as u64 / (1 << 32)) as usize
    };
    for _ in 0..64 {
        let drawn = [draw(), draw()];
        let Some(line) = through(scene, cells, drawn).filter(|line| line.is_allowed(scene)) else { continue };
        let score = score(scene, cells, &line);
        if best.is_none_or(|(most, _)| score > most) {
            best = Some((score, line));
        }
    }
    let line = best?.1;
    // From a bin that is wider than 2 px, or from one px, halved down to half a px.
    let mut band = if bin(scene) > 64 { bin(scene).min(512) } else { 32 };
    let (mut line, mut within) = (line, None);
    let answered = cells.iter().flatten().count() as i128;
    let fewest = (answered / 16).max(8);
    while band >= 16 {
        let Some(fitted) = refined(scene, cells, &line, band, fewest) else { break };
        (line, within) = (fitted, Some(band));
        band /= 2;
    }
    let inliers = near(scene, cells, &line, within.filter(|band| *band <= 64)?);
    let (top, bottom) = (inliers.first()?.0, inliers.last()?.0);
    let reach = (bottom - top) / (2 * i128::from(scene.config.cell_height));
    let n = inliers.len() as i128;
    let enough = n >= fewest && reach >= (rows as i128 / 8).max(2);
    let squares: i128 = inliers.iter().map(|(halves, p)| (p - line.at(*halves)).pow(2)).sum();
    let variance = (1 + 4 * squares / (n * n)).min(1 << 20);
    (enough && line.is_allowed(scene)).then_some(Line { variance, ..line })
}

/// Averages what a frame measured into what was carried.
pub fn carry(scene: &Scene<'_>, carried: &mut (Option<Line>, u32), measured: Option<Line>) {
    let rows = scene.size()[1];
    let old = carried.0.map(|line| Line { variance: line.variance + 64, ..line });
    carried.1 = if measured.is_some() { 0 } else { carried.1 + 1 };
    carried.0 = match (old, measured) {
        (None, measured) => measured,
        (Some(old), None) => (carried.1 <= 8).then_some(old),
        (Some(old), Some(new)) => {
            let both = old.variance + new.variance;
            let apart = |row: usize| new.at(scene.halves(row)) - old.at(scene.halves(row));
            let agree = [rows / 2, rows - 1].iter().all(|&row| apart(row).pow(2) <= 9 * both);
            let gain = 256 * old.variance / both;
            let mix = |old: i128, new: i128| old + ((new - old) * gain).div_euclid(256);
            let variance = (old.variance * (256 - gain) / 256).max(1);
            let mixed = Line::new(scene, mix(old.level, new.level), mix(old.slope, new.slope), variance);
            if agree { mixed.or(Some(new)) } else { Some(new) }
        }
    };
}
