//! Where an image repeats itself along the row.

use super::{Method, Picture, fattening};
use stereopsis::matching::Config;
use stereopsis::units::{Disparity, PixelFlags};

/// Rows from one that is looked at to the next one.
const EVERY: usize = 5;

/// The pixels that are in or beside a block of four columns that repeats, as each row's answers see them.
pub(super) struct Repeats {
    width: usize,
    first: usize,
    near: Vec<bool>,
}

impl Repeats {
    /// Looks at each fifth row of the left picture; answers of row `y` are those of the line that many
    /// rows below which the method's windows reach.
    pub fn of(scheme: &Method, config: &Config, left: &Picture<'_>) -> Self {
        let (width, height) = (left.width, left.height);
        let blocks = width.div_ceil(4);
        let asked = config.checks.refuse_repeats && scheme.smooth_down;
        let rows: Vec<Vec<bool>> = (0..height)
            .step_by(EVERY)
            .map(|y| if asked { blocks_of(blocks, &patterns(config, left, y)) } else { vec![false; blocks] })
            .collect();
        let mut near = Vec::new();
        for y in 0..height {
            let last = (y + scheme.radius_y).min(height - 1) / EVERY;
            let three = &rows[last.saturating_sub(2)..=last];
            let twice = |block: usize| three.iter().filter(|row| row.get(block) == Some(&true)).count() >= 2;
            near.extend((0..width).map(|x| (x / 4).saturating_sub(1)..=x / 4 + 1).map(|mut b| b.any(twice)));
        }
        Self { width, first: config.min_disparity.into(), near }
    }

    /// Whether a pixel is in or beside a block that repeats.
    pub fn is_near(&self, pixel: usize) -> bool {
        self.near[pixel]
    }

    /// The answers and flags of row `y` without those near a block that repeats.
    pub fn refuse(
        &self,
        y: usize,
        mut answers: Vec<Disparity>,
        mut flags: Vec<PixelFlags>,
    ) -> (Vec<Disparity>, Vec<PixelFlags>) {
        for x in (self.first..self.width).filter(|x| self.is_near(y * self.width + x)) {
            (answers[x], flags[x]) = (Disparity::NONE, flags[x].union(PixelFlags::AMBIGUOUS));
        }
        (answers, flags)
    }
}

/// Which blocks have a pixel of one of the `patterns`, each its first and its last column.
fn blocks_of(blocks: usize, patterns: &[(usize, usize)]) -> Vec<bool> {
    (0..blocks)
        .map(|block| patterns.iter().any(|&(first, last)| (first / 4..=last / 4).contains(&block)))
        .collect()
}

/// The first and the last column of each run of row `y` that repeats itself.
fn patterns(config: &Config, left: &Picture<'_>, y: usize) -> Vec<(usize, usize)> {
    let line: Vec<i32> = (0..left.width).map(|x| left.at(x as isize, y as isize).into()).collect();
    let least = fattening::least_gradient(config);
    let most = usize::from(config.disparities) - 1;
    let mut found = Vec::new();
    for (rises, period, next) in even_rises(&rises(&line, least), most) {
        let goes_on = |x: usize| rises.iter().any(|&rise| rise <= x && x <= rise + period + 1);
        let last = rises[rises.len() - 1];
        let end = (last + period + 2).min(next).min(line.len());
        let repeats = |x: usize| {
            let before = line.get(x.wrapping_sub(period + 1)..).unwrap_or_default();
            let three = before.iter().take(3).copied();
            let range = three.clone().min().zip(three.max());
            let slack = least / 8 * 3;
            x > period
                && goes_on(x)
                && range.is_some_and(|(low, high)| (low - slack..=high + slack).contains(&line[x]))
        };
        let columns: Vec<usize> = (rises[0]..end).collect();
        for run in columns.chunk_by(|&a, &b| repeats(a) && repeats(b)) {
            if repeats(run[0]) && run.len() >= 24.max(period + period / 2) {
                found.push((run[0].saturating_sub(period), run[run.len() - 1]));
            }
        }
    }
    found
}

/// The columns where a line has risen by `least` since it last fell by as much.
fn rises(line: &[i32], least: i32) -> Vec<usize> {
    let (mut rises, mut since, mut is_low) = (Vec::new(), 0, true);
    for x in 0..line.len() {
        let passed = line[since..=x].iter();
        let turns = if is_low {
            line[x] - passed.min().expect("a pixel") >= least
        } else {
            passed.max().expect("a pixel") - line[x] >= least
        };
        if turns {
            if is_low {
                rises.push(x);
            }
            (since, is_low) = (x, !is_low);
        }
    }
    rises
}

/// Rises that follow one another as far apart as the first two of them are, give or take a pixel: without the
/// first of those, with that distance, and with the rise that they end before. A distance under 4 or over
/// `most` is none.
fn even_rises(rises: &[usize], most: usize) -> Vec<(Vec<usize>, usize, usize)> {
    let mut even: Vec<(Vec<usize>, usize, usize)> = Vec::new();
    for pair in rises.windows(2) {
        let apart = pair[1] - pair[0];
        match even.last_mut() {
            Some((rises, period, _)) if *period > 0 && apart.abs_diff(*period) <= 1 => rises.push(pair[1]),
            last => {
                if let Some((.., next)) = last {
                    *next = pair[1];
                }
                even.push((vec![pair[1]], if (4..=most).contains(&apart) { apart } else { 0 }, usize::MAX));
            }
        }
    }
    even.into_iter().filter(|(_, period, _)| *period > 0).collect()
}
