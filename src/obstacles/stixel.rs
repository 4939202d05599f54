//! Stixels: a column of cells as ground, obstacle or drop, and beyond (Badino, Franke & Pfeiffer 2009), by
//! the Viterbi algorithm in integers.

use super::cells::Cells;
use super::column::{Column, MOST_GAP, StixelKind};
use super::config::{GroundSource, ObstacleConfig};
use super::ground::Ground;
use super::interval::{Between, Interval};
use crate::units::Disparity;

/// What contradicting a label costs at most, at three standard deviations.
const MOST: i32 = 16;
/// What a change of the label costs: as much as one cell that contradicts.
const CHANGE: u32 = 16;
/// What a cell without an answer costs as anything but beyond, by label.
const UNANSWERED: u32 = u32::from_le_bytes([8, 8, 8, 0]);
/// One for each label.
const EACH: u32 = 0x0101_0101;
/// Rows of pixels from which on a surface is high: two matching windows.
const HIGH: u32 = 18;
/// Rows at most that a near surface is seen beyond its edge: half a matching window, which sees both sides.
const SPREAD: i64 = 4;
/// Fewest cells of a segment.
const FEWEST_CELLS: u8 = 2;

/// Labels but for beyond, the last, in the order in which ties are broken.
const OBSTACLE: usize = 0;
const DROP: usize = 1;
const GROUND: usize = 2;
/// Bit of a step whose disparity is another surface's.
const BREAK: u8 = 1 << 6;

/// Sums of the costs of the four labels, a byte each in the order of their numbers, less the least of them:
/// 32 at most, as one row adds 16 to what a change of the label costs.
struct Sums(u32);

impl Sums {
    /// Adds a row to each label's sum, or to that of a change from the cheapest label if that is less.
    ///
    /// `to_stay` is what staying costs beside that, `costs` what the row does. Returns the labels that stay,
    /// a bit each, and the label whose sum is now the first of the least.
    fn advance(&mut self, to_stay: u32, costs: u32) -> (u8, u8) {
        let stay = self.0 + to_stay;
        // No carry from byte to byte: a sum is below 64. Its highest bit says that a change costs less.
        let changes = (stay + (0x7f - CHANGE) * EACH) & (0x80 * EACH);
        let changing = (changes << 1).wrapping_sub(changes >> 7);
        let sums = (stay & !changing | (CHANGE * EACH) & changing) + costs;
        let keys = 4 * sums + u32::from_le_bytes([0, 1, 2, 3]);
        let least = keys.to_le_bytes().into_iter().fold(u8::MAX, u8::min);
        self.0 = sums - u32::from(least >> 2) * EACH;
        // The product moves bit 7 of the byte of label `l` to bit 28 + l.
        let stays = (((changes >> 7) ^ EACH).wrapping_mul(0x1020_4080) >> 28) as u8;
        (stays, least & 3)
    }
}

/// What is needed to label a column.
#[derive(Clone, Copy, Debug)]
pub(super) struct Labelling<'a> {
    cells: Cells<'a>,
    ground: Option<Ground>,
    pub(super) config: ObstacleConfig,
    /// Three standard deviations of an answer beside the ground, steps.
    tolerance: i32,
    /// Largest step of parallax between cells of one surface: three deviations of a difference, or one px.
    pub(super) same_surface: i32,
    /// Number of columns in which fewer disparities than elsewhere can be searched.
    pub(super) narrow: usize,
    /// What each row shows.
    intervals: &'a [Interval],
}

impl<'a> Labelling<'a> {
    /// Settles what a frame's rows show.
    pub(super) fn new(
        cells: Cells<'a>,
        ground: Option<Ground>,
        config: ObstacleConfig,
        intervals: &'a mut [Interval],
        narrow: u16,
    ) -> Self {
        let sigma = u32::from(config.sigma_steps);
        let tolerance = 3 * (sigma * sigma + ground.map_or(0, |g| g.variance)).isqrt() as i32;
        let same_surface = (tolerance * 3 / 2).max(Disparity::ONE.into());
        for (row, interval) in intervals.iter_mut().enumerate().take(cells.rows) {
            *interval = Interval::new(ground, cells.halves(row), &config, tolerance);
        }
        Self { cells, ground, config, tolerance, same_surface, narrow: narrow.into(), intervals }
    }

    /// Whether a surface stands above the headroom.
    fn is_overhead(&self, parallax: i32, expected: i32) -> bool {
        let Some(ground) = self.ground.as_ref() else { return false };
        if self.config.headroom_mm == u16::MAX {
            return false;
        }
        i64::from(ground.height_mm) * i64::from(parallax - expected)
            > i64::from(self.config.headroom_mm) * i64::from(parallax)
    }

    /// Costs of the four labels at a cell, a byte each: 0 where the answer agrees, rising to 16 at three
    /// deviations beyond the label's interval.
    fn costs(&self, row: &Between, parallax: Option<i32>, per_step: i32, most: i32) -> u32 {
        const AT_MOST: u8 = MOST as u8;
        let Some(parallax) = parallax else { return UNANSWERED };
        let beyond = |by: i32| {
            // What is below zero is not used, and may wrap.
            let rising = 1 + (by.min(most).wrapping_mul(per_step) >> 16);
            if by <= 0 { 0 } else { rising.min(MOST) as u8 }
        };
        let overhead = self.is_overhead(parallax, row.expected);
        let obstacle = if overhead { AT_MOST } else { beyond((row.high + 1).saturating_sub(parallax)) };
        if row.low == i32::MIN {
            let far = if overhead { 0 } else { beyond(parallax - row.high) };
            return u32::from_le_bytes([obstacle, AT_MOST, AT_MOST, far]);
        }
        let drop = beyond(parallax - (row.low - 1));
        let ground = beyond((row.low - parallax).max(parallax - row.high));
        u32::from_le_bytes([obstacle, drop, ground, if overhead { 0 } else { AT_MOST }])
    }

    /// Labels a column, and returns its nearest obstacle or drop of a parallax below `bound`.
    ///
    /// The labels are those of the least sum of [`Self::costs`], plus 16 for each change of the label and for
    /// each step inside an obstacle to a disparity of another surface. `labels` has a byte for each row
    /// of cells.
    pub(super) fn column(&self, column: usize, bound: i32, labels: &mut [u8]) -> Column {
        let rows = self.cells.rows.min(labels.len());
        let most = self.tolerance.max(1);
        let per_step = (MOST << 16) / most;
        let beside = self.ground.map_or(0, |ground| ground.beside_256ths(self.cells.right_16ths(column)));
        let mut sums = Sums(0);
        let mut below = None;
        // The first of equals, as all are below the lowest row.
        let mut from = OBSTACLE as u8;
        // Rows without an answer side by side: here, and the most.
        let (mut gap, mut most_gap) = (0, 0);
        for row in (0..rows).rev() {
            let (Some(step), Some(interval)) = (labels.get_mut(row), self.intervals.get(row)) else { break };
            let parallax = self.cells.parallax(column, row);
            let breaks =
                parallax.zip(below).is_some_and(|(p, b): (i32, i32)| (p - b).abs() > self.same_surface);
            below = parallax.or(below);
            gap = if parallax.is_some() { 0 } else { gap + 1 };
            most_gap = gap.max(most_gap);
            let row = interval.at(beside, self.cells.farthest);
            let costs = self.costs(&row, parallax, per_step, most);
            let (stays, cheapest) = sums.advance(if breaks { CHANGE << (8 * OBSTACLE) } else { 0 }, costs);
            *step = from | stays << 2 | if breaks { BREAK } else { 0 };
            from = cheapest;
        }
        let segment = self.segments(column, bound, labels, from.into());
        let whole = self.whole(column, segment, labels);
        let found = if self.touches(column, &whole) { whole } else { segment };
        let seen = match self.ground {
            Some(_) => self.seen(column, beside, labels),
            // Without a ground nothing says where a thing ahead would stand: it may be in any gap.
            None => {
                let is_flying = self.config.ground == GroundSource::Absent;
                if is_flying && below.is_some() && most_gap <= MOST_GAP { 0 } else { rows as u8 }
            }
        };
        Column { seen, ..found }
    }

    /// Follows the steps from the uppermost row down, writes each row's label in their place, and returns the
    /// nearest segment.
    fn segments(&self, column: usize, bound: i32, steps: &mut [u8], last: usize) -> Column {
        let mut best = Column::EMPTY;
        let (mut label, mut top) = (last, 0);
        let (mut count, mut sum) = (0_u8, 0_i32);
        for row in 0..self.cells.rows {
            let Some(step) = steps.get_mut(row) else { break };
            let stays = *step & 4 << label != 0;
            let breaks = *step & BREAK != 0 && label == OBSTACLE && stays;
            let next = if stays { label } else { usize::from(*step & 3) };
            *step = label as u8;
            if let Some(parallax) = self.cells.parallax(column, row) {
                (count, sum) = (count + 1, sum + parallax);
            }
            if row + 1 < self.cells.rows && next == label && !breaks {
                continue;
            }
            let segment = Column { top, base: row as u8, cells: count, ..Column::EMPTY };
            let found = self.measured(column, segment, label, sum);
            if let Some(found) = found.filter(|f| f.parallax < bound && f.parallax > best.parallax) {
                best = found;
            }
            (label, top, count, sum) = (next, row as u8 + 1, 0, 0);
        }
        best
    }

    /// A segment with all cells of obstacles in its column that are of its surface: what is thinner than a
    /// window shows in parts, with what is behind it between them.
    fn whole(&self, column: usize, segment: Column, labels: &[u8]) -> Column {
        let mut whole = segment;
        if segment.kind != StixelKind::Obstacle {
            return whole;
        }
        for (row, &label) in (0..).zip(labels.iter().take(self.cells.rows)) {
            if usize::from(label) != OBSTACLE || (segment.top..=segment.base).contains(&row) {
                continue;
            }
            let parallax = self.cells.parallax(column, row.into());
            if parallax.is_some_and(|p| (p - segment.parallax).abs() <= self.same_surface) {
                (whole.top, whole.base) = (whole.top.min(row), whole.base.max(row));
                whole.cells += 1;
            }
        }
        whole
    }

    /// Whether a segment reaches down to the ground: within two rows below its base, its parallax is the
    /// ground's. What is far is near all of the ground that there is, and so is not asked.
    fn touches(&self, column: usize, segment: &Column) -> bool {
        let is_near = segment.parallax >= 2 * self.cells.farthest;
        let is_asked = segment.kind == StixelKind::Obstacle && is_near;
        let Some(ground) = self.ground.filter(|_| is_asked) else { return false };
        let beside = ground.beside_256ths(self.cells.right_16ths(column));
        let below = (usize::from(segment.base) + 2).min(self.cells.rows.saturating_sub(1));
        let row = self.intervals.get(below);
        row.is_some_and(|row| segment.parallax <= row.at(beside, self.cells.farthest).high)
    }

    /// Whether a segment stands on the ground and is two matching windows high.
    pub(super) fn stands(&self, column: usize, segment: &Column) -> bool {
        u32::from(segment.cells) * u32::from(self.config.cell_height) >= HIGH && self.touches(column, segment)
    }

    /// The first row in which the ground is seen before a speck that reaches down to it: the speck is neither
    /// believed to be there nor not to be. 0 for any other.
    pub(super) fn hidden(&self, column: usize, speck: &Column) -> u8 {
        if self.touches(column, speck) { speck.base + 1 } else { 0 }
    }

    /// Parallax and deviation of a segment: the mean of its cells, and the root of the answers' variance plus
    /// the cells'. A drop has the ground's parallax at its edge, which is in the segment's last row of cells
    /// or up to [`SPREAD`] rows below it.
    fn measured(&self, column: usize, segment: Column, label: usize, sum: i32) -> Option<Column> {
        if segment.cells < FEWEST_CELLS || !matches!(label, OBSTACLE | DROP) {
            return None;
        }
        let own = u64::from(self.config.sigma_steps);
        if label == DROP {
            let ground = self.ground?;
            let right = self.cells.right_16ths(column);
            // The edge is anywhere in these rows, told at their middle: a uniform distribution. So many
            // half-rows are half of so many rows.
            let edge = ground.parallax(self.cells.halves(segment.base.into()) + SPREAD, right);
            let rows = ((ground.slope * (self.cells.cell_height + SPREAD)) >> 16) as u64;
            let sigma = (own * own + rows * rows / 12).isqrt().min(255) as u8;
            return Some(Column { kind: StixelKind::Drop, parallax: edge, sigma, ..segment });
        }
        let count = i32::from(segment.cells);
        let parallax = (sum + count / 2).checked_div(count)?;
        let rows = usize::from(segment.top)..=usize::from(segment.base);
        let squares = rows.filter_map(|row| self.cells.parallax(column, row)).map(|p| {
            let off = i64::from(p - parallax);
            (off * off) as u64
        });
        let variance = squares.sum::<u64>().checked_div(count as u64)?;
        let sigma = (variance + own * own).isqrt().min(255) as u8;
        Some(Column { kind: StixelKind::Obstacle, parallax, sigma, ..segment })
    }

    /// Uppermost row of ground that is seen from the lowest row on, with gaps of at most two rows without an
    /// answer, or of one with an answer that is not close to the ground's.
    fn seen(&self, column: usize, beside: i32, labels: &[u8]) -> u8 {
        let (mut seen, mut gap) = (self.cells.rows as u8, 0);
        let rows = labels.iter().zip(self.intervals).enumerate().take(self.cells.rows);
        for (row, (&label, interval)) in rows.rev() {
            let is_ground = usize::from(label) == GROUND;
            gap += match self.cells.parallax(column, row) {
                Some(parallax) if is_ground && interval.is_close(parallax, beside) => {
                    (seen, gap) = (row as u8, 0);
                    continue;
                }
                // One that is off may be chance; two, or one beside a gap, are something that stands there.
                Some(_) if is_ground => MOST_GAP,
                Some(_) => break,
                None => 1,
            };
            if gap > MOST_GAP {
                break;
            }
        }
        seen
    }
}
