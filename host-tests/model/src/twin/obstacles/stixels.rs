//! The cheapest labels of a column by trying all predecessors.

use super::{Line, Scene};
use stereopsis::obstacles::GroundSource;

/// What a cell is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Kind {
    /// A surface above the ground.
    Obstacle,
    /// A surface below the ground.
    Drop,
    /// The ground.
    Ground,
    /// Anything too far to tell.
    Beyond,
}

const KINDS: [Kind; 4] = [Kind::Obstacle, Kind::Drop, Kind::Ground, Kind::Beyond];

/// What stands in a column.
#[derive(Clone, PartialEq, Debug)]
pub struct Standing {
    /// The kind, first and last row of cells, parallax and deviation of the nearest obstacle or drop.
    pub found: Option<Segment>,
    /// Uppermost row of cells to which the ground is seen.
    pub seen: usize,
    /// Cells of the surface that it is a part of.
    pub surface: usize,
}

/// A segment of a column.
#[derive(Clone, PartialEq, Debug)]
pub struct Segment {
    /// What it is.
    pub kind: Kind,
    /// First row of cells.
    pub top: usize,
    /// Last row of cells.
    pub base: usize,
    /// Parallax, steps.
    pub parallax: i128,
    /// Deviation, steps.
    pub sigma: i128,
    /// Cells with an answer.
    pub cells: usize,
}

pub(super) struct Column<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) ground: Option<Line>,
    /// Parallaxes from the uppermost row down.
    pub(super) parallaxes: Vec<Option<i128>>,
    /// How far it is to the right of the principal point, sixteenths of a px.
    pub(super) right: i128,
}

impl<'a> Column<'a> {
    /// A column of a frame's cells.
    pub(super) fn new(scene: &'a Scene<'a>, cells: &[Option<i128>], ground: Option<Line>, x: usize) -> Self {
        let [columns, rows] = scene.size();
        let parallaxes = (0..rows).map(|y| cells[y * columns + x].map(|d| d + scene.offset)).collect();
        Self { scene, ground, parallaxes, right: scene.right(x) }
    }
}

impl Column<'_> {
    fn tolerance(&self) -> i128 {
        let sigma = i128::from(self.scene.config.sigma_steps);
        3 * (sigma * sigma + self.ground.map_or(0, |line| line.variance)).isqrt()
    }

    pub(super) fn same_surface(&self) -> i128 {
        (self.tolerance() * 3 / 2).max(32)
    }

    /// What the parallax of an obstacle's upper edge has more than the ground's at a row.
    fn rise(&self, line: &Line, row: usize) -> i128 {
        let (at, up) =
            (line.upright(self.scene.halves(row)).max(0), i128::from(self.scene.config.obstacle_mm));
        let left = line.height_mm - up;
        if left > 0 { (at * up / left).min(1 << 21).max(self.tolerance()) } else { 1 << 21 }
    }

    /// The least that the ground's parallax is at a row, where ground can be told.
    fn lowest(&self, line: &Line, row: usize) -> i128 {
        // The limits of all columns are those of the principal point's.
        let at = line.upright(self.scene.halves(row)).max(0);
        let down = i128::from(self.scene.config.drop_mm);
        let ground = line.at(self.scene.halves(row), self.right);
        ground - (at * down / (line.height_mm + down)).max(self.tolerance())
    }

    /// Whether an answer is not told from ground, or from what is too far to be told.
    pub(super) fn may_be_ground(&self, line: &Line, row: usize, parallax: i128) -> bool {
        let is_far = line.at(self.scene.halves(row), self.right) < self.scene.farthest();
        parallax <= self.highest(line, row) && (is_far || parallax >= self.lowest(line, row))
    }

    /// The most that the ground's parallax is at a row.
    fn highest(&self, line: &Line, row: usize) -> i128 {
        let ground = line.at(self.scene.halves(row), self.right);
        (ground + self.rise(line, row)).max(self.scene.farthest() - 1)
    }

    /// Whether a row's answer is within three eighths of an obstacle's height of the ground.
    fn is_close(&self, row: usize) -> bool {
        let close = |line: Line| {
            let off = self.parallaxes[row]? - line.at(self.scene.halves(row), self.right);
            Some(off.abs() <= (3 * self.rise(&line, row) / 8).max(self.tolerance()))
        };
        self.ground.and_then(close).unwrap_or(false)
    }

    /// Whether a near obstacle is the ground two rows below its base, or at the lowest row.
    pub(super) fn touches(&self, segment: &Segment) -> bool {
        let row = (segment.base + 2).min(self.parallaxes.len() - 1);
        let on = |line: Line| segment.parallax <= self.highest(&line, row);
        let is_near = segment.parallax >= 2 * self.scene.farthest();
        segment.kind == Kind::Obstacle && is_near && self.ground.is_some_and(on)
    }

    /// Whether it has two windows of 9 px and touches the ground.
    pub(super) fn stands(&self, segment: &Segment) -> bool {
        segment.cells * usize::from(self.scene.config.cell_height) >= 2 * 9 && self.touches(segment)
    }

    /// What a kind costs at a row.
    fn cost(&self, kind: Kind, row: usize) -> i128 {
        let Some(parallax) = self.parallaxes[row] else { return if kind == Kind::Beyond { 0 } else { 8 } };
        let (config, tolerance) = (&self.scene.config, self.tolerance().max(1));
        let rises = |by: i128| match by.min(tolerance) {
            ..=0 => 0,
            by => (1 + by * (16 * 65_536 / tolerance) / 65_536).min(16),
        };
        let far = self.scene.farthest();
        let Some(line) = self.ground else {
            return match kind {
                Kind::Obstacle => rises(far - parallax),
                Kind::Beyond => rises(parallax - (far - 1)),
                _ => 16,
            };
        };
        let ground = line.at(self.scene.halves(row), self.right);
        let (height, highest) = (line.height_mm, self.highest(&line, row));
        let lowest = self.lowest(&line, row);
        let headroom = i128::from(config.headroom_mm);
        let overhead = headroom < 65_535 && height * (parallax - ground) > headroom * parallax;
        match kind {
            Kind::Obstacle if overhead => 16,
            Kind::Obstacle => rises(highest + 1 - parallax),
            Kind::Beyond if overhead => 0,
            Kind::Beyond if ground < far => rises(parallax - highest),
            Kind::Beyond => 16,
            _ if ground < far => 16,
            Kind::Drop => rises(parallax - lowest + 1),
            Kind::Ground => rises(lowest - parallax).max(rises(parallax - highest)),
        }
    }

    /// Whether the disparity of a row is that of another surface than that of the nearest answer below.
    fn breaks(&self, row: usize) -> bool {
        let below = self.parallaxes[row + 1..].iter().flatten().next();
        self.parallaxes[row].zip(below).is_some_and(|(p, below)| (p - below).abs() > self.same_surface())
    }

    /// The cheapest kinds from the lowest row up; of equals the one that stays, then the first.
    pub(super) fn labels(&self) -> Vec<Kind> {
        let rows = self.parallaxes.len();
        // The cheapest way to each kind at the row below, with the kinds on it from the lowest row on.
        let mut ways: Vec<(i128, Vec<Kind>)> = vec![(0, Vec::new()); 4];
        for row in (0..rows).rev() {
            let next = KINDS.map(|kind| {
                let from = |(place, before): (usize, &Kind)| {
                    let stays = *before == kind;
                    let pays = !stays || kind == Kind::Obstacle && self.breaks(row);
                    (ways[place].0 + if pays { 16 } else { 0 }, !stays, place)
                };
                let (cost, _, place) = KINDS.iter().enumerate().map(from).min().expect("four kinds");
                let mut way = ways[place].1.clone();
                way.push(kind);
                (cost + self.cost(kind, row), way)
            });
            ways = next.to_vec();
        }
        let best = ways.into_iter().enumerate().min_by_key(|(place, way)| (way.0, *place));
        best.expect("four kinds").1.1.into_iter().rev().collect()
    }

    /// Rows from one end of a segment to the other.
    pub(super) fn segments(&self, labels: &[Kind]) -> Vec<Segment> {
        let rows = labels.len();
        let mut found = Vec::new();
        let mut top = 0;
        for base in 0..rows {
            let goes_on = base + 1 < rows
                && labels[base + 1] == labels[base]
                && !(labels[base] == Kind::Obstacle && self.breaks(base));
            if goes_on {
                continue;
            }
            let answers: Vec<_> = self.parallaxes[top..=base].iter().flatten().collect();
            let (kind, n) = (labels[base], answers.len() as i128);
            let sigma = i128::from(self.scene.config.sigma_steps);
            let segment =
                |parallax, sigma| Segment { kind, top, base, parallax, sigma, cells: answers.len() };
            if n >= 2 && kind == Kind::Obstacle {
                let parallax = (answers.iter().copied().sum::<i128>() + n / 2) / n;
                let squares: i128 = answers.iter().map(|p| (*p - parallax).pow(2)).sum();
                found.push(segment(parallax, (squares / n + sigma * sigma).isqrt().min(255)));
            } else if n >= 2 && kind == Kind::Drop {
                let line = self.ground.expect("no drop without a ground");
                // The edge is anywhere in the row of cells and the four rows below, half a window.
                let rows = line.slope * i128::from(self.scene.config.cell_height + 4) / 65_536;
                let sigma = (sigma * sigma + rows * rows / 12).isqrt().min(255);
                // Their middle is two rows, four half-rows, below that of the row of cells.
                found.push(segment(line.at(self.scene.halves(base) + 4, self.right), sigma));
            }
            top = base + 1;
        }
        found
    }

    /// A segment with all cells of obstacles that are of its surface, where they reach down to the ground.
    pub(super) fn whole(&self, segment: &Segment, labels: &[Kind]) -> Segment {
        let mut whole = segment.clone();
        let is_of_it = |row: &usize| {
            let near = |p: i128| (p - segment.parallax).abs() <= self.same_surface();
            let is_outside = *row < segment.top || *row > segment.base;
            is_outside && labels[*row] == Kind::Obstacle && self.parallaxes[*row].is_some_and(near)
        };
        if segment.kind == Kind::Obstacle {
            let more: Vec<_> = (0..labels.len()).filter(is_of_it).collect();
            whole.cells += more.len();
            whole.top = more.first().map_or(whole.top, |&row| row.min(whole.top));
            whole.base = more.last().map_or(whole.base, |&row| row.max(whole.base));
        }
        if self.touches(&whole) { whole } else { segment.clone() }
    }

    pub(super) fn seen(&self, labels: &[Kind]) -> usize {
        let rows = labels.len();
        if self.ground.is_none() {
            let has_answers = self.parallaxes.iter().any(Option::is_some);
            let is_whole = self.parallaxes.split(Option::is_some).all(|gap| gap.len() <= 2);
            let is_flying = self.scene.config.ground == GroundSource::Absent;
            return if is_flying && has_answers && is_whole { 0 } else { rows };
        }
        let shows = |row: usize| labels[row] == Kind::Ground && self.is_close(row);
        let ends = |row: usize| labels[row] != Kind::Ground && self.parallaxes[row].is_some();
        let mut seen = rows;
        for row in (0..rows).rev().take_while(|&row| !ends(row)) {
            if shows(row) {
                seen = row;
                continue;
            }
            // Rows from this one to the last that shows ground, of which one that is off counts for two.
            let off = (row..seen).filter(|&row| self.parallaxes[row].is_some()).count();
            if seen - row + off > 2 {
                break;
            }
        }
        seen
    }
}
